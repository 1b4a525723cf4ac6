//! Opens a log by its extension.

use crate::{
    failure::{Failure, Place},
    regular_file,
};
use flate2::bufread::MultiGzDecoder;
use indicatif::ProgressBar;
use std::{
    fs::File,
    io::{BufRead, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

/// The size of the buffer that files are read with, in bytes.
const BUFFER: usize = 1 << 18;

/// A gzip stream may unpack to this many bytes, and to this many times its own size more. Text of noise
/// unpacks to a few times its size.
const MOST_UNPACKED: u64 = 1 << 24;
const MOST_TIMES_UNPACKED: u64 = 100;

/// The format of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// A table of text.
    Csv {
        /// Whether the text is compressed with gzip.
        gzip: bool,
    },
    /// A NumPy array.
    Npy,
    /// A bag of ROS 2, or of ROS 1 after conversion.
    Mcap,
    /// A log of PX4.
    Ulog,
}

impl Format {
    /// The format that a file's extension selects.
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        if name.ends_with(".csv") {
            Ok(Self::Csv { gzip: false })
        } else if name.ends_with(".csv.gz") {
            Ok(Self::Csv { gzip: true })
        } else if name.ends_with(".npy") {
            Ok(Self::Npy)
        } else if name.ends_with(".mcap") {
            Ok(Self::Mcap)
        } else if name.ends_with(".ulg") || name.ends_with(".ulog") {
            Ok(Self::Ulog)
        } else {
            Err(Place::file(path).failure(
                "the file's extension is not that of a log",
                "give a .csv, .csv.gz, .npy, .mcap or .ulg file",
            ))
        }
    }
}

impl Format {
    /// Whether a file of this format can hold several sensors, each with its own topic.
    pub(super) const fn has_topics(self) -> bool {
        matches!(self, Self::Mcap | Self::Ulog)
    }
}

/// Opens a file at its beginning. `progress` follows the bytes that are read.
pub(super) fn open(path: &Path, progress: &ProgressBar) -> Result<impl BufRead + use<>, Failure> {
    let (file, length) = regular_file::open(path)?;
    progress.set_length(length);
    progress.set_position(0);
    Ok(BufReader::with_capacity(BUFFER, progress.wrap_read(file)))
}

/// Opens the text of a file at its beginning, unpacked and without a byte order mark.
pub(super) fn open_text(
    path: &Path,
    gzip: bool,
    progress: &ProgressBar,
) -> Result<Box<dyn BufRead>, Failure> {
    let file = open(path, progress)?;
    let mut text: Box<dyn BufRead> = if gzip {
        let (_, packed) = regular_file::open(path)?;
        let most = MOST_UNPACKED.saturating_add(packed.saturating_mul(MOST_TIMES_UNPACKED));
        let unpacked = Bounded {
            text: MultiGzDecoder::new(file),
            left: most,
        };
        Box::new(BufReader::with_capacity(BUFFER, unpacked))
    } else {
        Box::new(file)
    };
    let mark = b"\xEF\xBB\xBF";
    let start = text
        .fill_buf()
        .map_err(|error| text_failure(Place::file(path), gzip, &error))?;
    if start.starts_with(mark) {
        text.consume(mark.len());
    }
    Ok(text)
}

/// Whether the last line of a file has a line end.
pub(super) fn ends_with_line(path: &Path) -> Result<bool, Failure> {
    let last = || {
        let mut file = File::open(path)?;
        let mut last = [0];
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
        Ok(last == *b"\n")
    };
    last().map_err(|error| Place::file(path).io(&error))
}

/// A text that fails when more than a number of bytes are read from it.
struct Bounded<R> {
    text: R,
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.text.read(buffer)?;
        self.left = self
            .left
            .checked_sub(read as u64)
            .ok_or(std::io::ErrorKind::QuotaExceeded)?;
        Ok(read)
    }
}

/// The failure to read text.
pub(super) fn text_failure(place: Place, gzip: bool, error: &std::io::Error) -> Failure {
    use std::io::ErrorKind::{InvalidData, InvalidInput, QuotaExceeded, UnexpectedEof};
    match error.kind() {
        QuotaExceeded => place.failure(
            format!("the gzip stream unpacks to more than {MOST_TIMES_UNPACKED} times its size"),
            "check what it holds, and unpack it first",
        ),
        UnexpectedEof if gzip => place.failure(
            "the gzip stream ends in the middle",
            "copy or record the file again",
        ),
        InvalidData | InvalidInput if gzip => place.failure(
            format!("not a gzip stream: {error}"),
            "copy or pack the file again",
        ),
        _ => place.io(error),
    }
}

/// The row, counted from 1, of the first record at or after a byte of the text. Rows that are empty
/// or comments are skipped. If the text ends or breaks off before a record, this is the row where
/// it does so.
pub(super) fn row_at(path: &Path, gzip: bool, byte: u64) -> Result<u64, Failure> {
    let mut text = open_text(path, gzip, &ProgressBar::hidden())?;
    let mut row = 1;
    let mut before = text.by_ref().take(byte);
    while let Ok(chunk @ [_, ..]) = before.fill_buf() {
        row += chunk.iter().filter(|&&byte| byte == b'\n').count() as u64;
        let length = chunk.len();
        before.consume(length);
    }
    while let Ok(Some(first)) = text.fill_buf().map(|chunk| chunk.first().copied()) {
        match first {
            b'#' if text.skip_until(b'\n').is_ok() => row += 1,
            b'\r' => text.consume(1),
            b'\n' => {
                text.consume(1);
                row += 1;
            }
            _ => break,
        }
    }
    Ok(row)
}
