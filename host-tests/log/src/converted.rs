//! The text that is made of a log in another format, in a temporary file.

use crate::failure::{Failure, Place};
#[cfg(feature = "tables")]
use crate::values::NumberFile;
use std::{
    fs::File,
    io::{self, BufWriter, ErrorKind, Write},
    path::{Path, PathBuf},
};
#[cfg(feature = "bags")]
use tempfile::NamedTempFile;
use tempfile::TempPath;

/// The text of a log may be this long, and this many times the size of its file longer. Packed columns of noise become
/// some ten times as long.
pub(super) const MOST_TEXT: u64 = 1 << 24;
pub(super) const MOST_TIMES: u64 = 100;

/// How a note begins on what is in a log and cannot be read. It explains a refusal of the rest.
pub(super) const LEFT_OUT: &str = "left out: ";

/// A text that is deleted when this is dropped.
pub(super) struct Converted {
    pub(super) text: TempPath,
    /// All numbers in binary, if the text is that of some rows alone.
    #[cfg(feature = "tables")]
    pub(super) numbers: Option<NumberFile>,
    pub(super) note: Option<String>,
}

impl Converted {
    /// The note on what is left out, without what it says of the rest.
    pub(super) fn left_out(&self) -> Option<&str> {
        let note = self.note.as_deref()?;
        note.find(LEFT_OUT).map(|place| &note[place..])
    }
}

/// A text of bounded length that is being written.
pub(super) struct Text {
    path: PathBuf,
    out: BufWriter<File>,
    left: u64,
}

impl Text {
    /// An empty text for a log, in a temporary file.
    #[cfg(feature = "bags")]
    pub(super) fn new(path: &Path, size: u64) -> Result<(Self, TempPath), Failure> {
        let file = NamedTempFile::new().map_err(|error| Place::file(path).io(&error))?;
        let (file, temporary) = file.into_parts();
        Ok((Self::to(path, size, file), temporary))
    }

    /// An empty text for a log of so many bytes, in a file.
    pub(super) fn to(path: &Path, size: u64, file: File) -> Self {
        Self {
            path: path.to_owned(),
            out: BufWriter::new(file),
            left: MOST_TEXT.saturating_add(size.saturating_mul(MOST_TIMES)),
        }
    }

    /// Writes the names of the columns.
    pub(super) fn names<T: AsRef<[u8]>>(
        &mut self,
        names: impl IntoIterator<Item = T>,
    ) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(&mut *self);
        writer.write_record(names)?;
        writer.flush()
    }

    /// The failure to write it.
    pub(super) fn failure(&self, error: &io::Error) -> Failure {
        let here = Place::file(&self.path);
        match error.kind() {
            ErrorKind::QuotaExceeded => here.failure(
                format!("its table is more than {MOST_TIMES} times as long as the file"),
                "check what it holds, and export it as CSV",
            ),
            _ => here.io(error),
        }
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        self.out.flush().map_err(|error| self.failure(&error))
    }
}

impl Write for Text {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.left.checked_sub(bytes.len() as u64);
        self.left = left.ok_or(ErrorKind::QuotaExceeded)?;
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
