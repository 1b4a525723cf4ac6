//! Tells the format of a log, and opens it.

use super::{foreign, part_names};
use crate::{
    failure::{Failure, Place},
    regular_file,
};
use flate2::bufread::MultiGzDecoder;
use indicatif::ProgressBar;
use std::{
    io::{BufRead, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

/// The size of the buffer that files are read with, in bytes.
const BUFFER: usize = 1 << 18;

/// A gzip stream may unpack to this many bytes, and to this many times its own size more. Text of noise
/// unpacks to a few times its size.
const MOST_UNPACKED: u64 = 1 << 24;
const MOST_TIMES_UNPACKED: u64 = 100;

/// The number of bytes that tell the format of a file.
const START: u64 = 512;

/// The format of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// A table of text.
    Text {
        /// Whether the text is compressed with gzip.
        gzip: bool,
    },
    /// A NumPy array.
    Npy,
    /// A bag of ROS 2, or of ROS 1 after conversion.
    Mcap,
    /// A bag of ROS 1.
    Ros1,
    /// A bag of ROS 2 up to Humble.
    Sqlite,
    /// A folder with the files of a bag of ROS 2.
    Folder,
    /// A folder with the parts of a record as text.
    Parts,
    /// A log of PX4.
    Ulog,
    /// A table of another program in binary.
    Table(TableKind),
}

/// The format of a table in binary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TableKind {
    Ardupilot,
    Arrow,
    Betaflight,
    Hdf5,
    Matlab,
    Parquet,
    Workbook,
}

impl TableKind {
    #[cfg(feature = "tables")]
    pub(super) const ALL: [Self; 7] = [
        Self::Ardupilot,
        Self::Arrow,
        Self::Betaflight,
        Self::Hdf5,
        Self::Matlab,
        Self::Parquet,
        Self::Workbook,
    ];

    /// Its name, by which programs know it.
    #[cfg(feature = "tables")]
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Ardupilot => "ardupilot",
            Self::Arrow => "arrow",
            Self::Betaflight => "betaflight",
            Self::Hdf5 => "hdf5",
            Self::Matlab => "matlab",
            Self::Parquet => "parquet",
            Self::Workbook => "workbook",
        }
    }
}

impl Format {
    /// The format of a file: the one that its first bytes tell, or else its extension, or else text.
    ///
    /// # Errors
    /// When the file is another one than a log, which the message names together with the command that converts it.
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        if path.is_dir() {
            let has_text = !part_names::files(path).is_empty();
            return Ok(if has_text { Self::Parts } else { Self::Folder });
        }
        let (file, _) = regular_file::open(path)?;
        let mut start = Vec::new();
        let read = file.take(START).read_to_end(&mut start);
        read.map_err(|error| Place::file(path).io(&error))?;
        let begins = |magic: &[u8]| start.starts_with(magic);
        let of_start = [
            (&b"\x1f\x8b"[..], Self::Text { gzip: true }),
            (b"\x93NUMPY", Self::Npy),
            (b"\x89MCAP", Self::Mcap),
            (b"#ROSBAG V", Self::Ros1),
            (b"SQLite format 3\0", Self::Sqlite),
            (b"ULog", Self::Ulog),
            (b"PAR1", Self::Table(TableKind::Parquet)),
            (b"ARROW1", Self::Table(TableKind::Arrow)),
            (b"\xff\xff\xff\xff", Self::Table(TableKind::Arrow)),
            (b"H Product:Blackbox", Self::Table(TableKind::Betaflight)),
            (b"\xa3\x95\x80", Self::Table(TableKind::Ardupilot)),
            (b"MATLAB 5.0", Self::Table(TableKind::Matlab)),
            // A file of MATLAB 7.3 has 512 bytes of its own before those of HDF5.
            (b"MATLAB 7.3", Self::Table(TableKind::Hdf5)),
            (b"\x89HDF\r\n\x1a\n", Self::Table(TableKind::Hdf5)),
        ];
        if let Some((_, format)) = of_start.into_iter().find(|(magic, _)| begins(magic)) {
            return Ok(format);
        }
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        // Workbooks are archives, or what programs called so before; only their names tell them from others.
        let books = [".xlsx", ".xlsm", ".xlsb", ".xls", ".ods"];
        if start.contains(&0) && books.iter().any(|extension| name.ends_with(extension)) {
            return Ok(Self::Table(TableKind::Workbook));
        }
        if let Some(failure) = foreign::refusal(path, &start) {
            return Err(failure);
        }
        let of_name = [
            (".gz", Self::Text { gzip: true }),
            (".npy", Self::Npy),
            (".mcap", Self::Mcap),
            (".bag", Self::Ros1),
            (".db3", Self::Sqlite),
            (".ulg", Self::Ulog),
            (".ulog", Self::Ulog),
            (".bbl", Self::Table(TableKind::Betaflight)),
            (".bfl", Self::Table(TableKind::Betaflight)),
        ];
        let of_name = of_name
            .into_iter()
            .find(|(extension, _)| name.ends_with(extension));
        match of_name {
            Some((_, format)) => Ok(format),
            None if start.contains(&0) => Err(foreign::failure(
                path,
                "not text, and no kind of log that is known",
                "export it as CSV with the program that recorded it",
            )),
            None => Ok(Self::Text { gzip: false }),
        }
    }

    /// Whether a file of this format can hold several sensors, each with its own topic.
    pub(super) const fn has_topics(self) -> bool {
        !matches!(self, Self::Text { .. } | Self::Npy | Self::Parts)
    }
}

/// Opens a file at its beginning. `progress` follows the bytes that are read.
pub(super) fn open(path: &Path, progress: &ProgressBar) -> Result<impl BufRead + use<>, Failure> {
    let file = open_unbuffered(path, progress)?;
    Ok(BufReader::with_capacity(BUFFER, file))
}

/// Opens a file at its beginning, for a reader that asks for large blocks, so that a buffer would only copy them once
/// more. `progress` follows the bytes that are read.
pub(super) fn open_unbuffered(
    path: &Path,
    progress: &ProgressBar,
) -> Result<impl Read + use<>, Failure> {
    let (file, length) = regular_file::open(path)?;
    progress.set_length(length);
    progress.set_position(0);
    Ok(Interruptible {
        file: progress.wrap_read(file),
        progress: progress.clone(),
    })
}

/// A file that fails once the bar that follows it has been ended, by a caller who wants no more of it.
struct Interruptible<R> {
    file: R,
    progress: ProgressBar,
}

impl<R: Read> Read for Interruptible<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        match self.progress.is_finished() {
            true => Err(std::io::Error::other("interrupted")),
            false => self.file.read(buffer),
        }
    }
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
    let (mut file, _) = regular_file::open(path)?;
    let mut last = [0];
    let read = file
        .seek(SeekFrom::End(-1))
        .and_then(|_| file.read_exact(&mut last));
    read.map_err(|error| Place::file(path).io(&error))?;
    Ok(last == *b"\n")
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

/// The number of lines that end before a byte of a text.
pub(super) fn lines_before(mut text: impl BufRead, byte: u64) -> u64 {
    let mut lines = 0;
    let mut before = text.by_ref().take(byte);
    while let Ok(chunk @ [_, ..]) = before.fill_buf() {
        lines += chunk.iter().filter(|&&byte| byte == b'\n').count() as u64;
        let length = chunk.len();
        before.consume(length);
    }
    lines
}

/// The row, counted from 1, of the first record or comment at or after a byte of the text. Empty rows are skipped.
/// If the text ends or breaks off before a record, this is the row where it does so.
pub(super) fn row_at(mut text: impl BufRead, byte: u64) -> u64 {
    let mut row = 1 + lines_before(&mut text, byte);
    while let Ok(Some(first)) = text.fill_buf().map(|chunk| chunk.first().copied()) {
        match first {
            b'\r' => text.consume(1),
            b'\n' => {
                text.consume(1);
                row += 1;
            }
            _ => break,
        }
    }
    row
}
