//! Reads logs that are NumPy arrays, whose rows are samples and whose columns are axes.

use super::{
    columns::{AxisColumn, Columns, Look},
    field::Field,
    metadata::Metadata,
    npy_block::Block,
    npy_header::{Header, sidecar},
    source,
    table::{Ended, Stop, Table, Visitor},
};
use crate::{
    failure::{Failure, Place},
    regular_file,
};
use indicatif::ProgressBar;
use std::{
    io::{ErrorKind, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

/// An array with more columns than this is refused, because its axes are probably its rows. Chosen by
/// hand.
const MOST_COLUMNS: u64 = 64;

/// The number of rows that decide what the columns look like. Chosen by hand.
const LOOKS: u64 = 100;

/// An array file whose header and first rows are known.
pub(super) struct Npy {
    path: PathBuf,
    header: Header,
    rows: u64,
    metadata: Metadata,
    columns: Columns,
}

impl Npy {
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let place = || Place::file(path);
        let mut reader = source::open_unbuffered(path, &ProgressBar::hidden())?;
        let header = read_header(path, &mut reader)?;
        let (rows, width) = match header.shape[..] {
            [rows] => (rows, 1),
            [rows, width @ 1..=MOST_COLUMNS] => (rows, width),
            [rows, width] => {
                return Err(place().failure(
                    format!("the array has {rows} rows and {width} columns"),
                    "save its transpose, because rows are samples",
                ));
            }
            _ => {
                return Err(place().failure(
                    format!("the array has {} dimensions", header.shape.len()),
                    "save an array of one or two dimensions, with samples as rows and axes as columns",
                ));
            }
        };
        if rows == 0 {
            return Err(place().failure("no rows", "record some samples"));
        }
        let bytes = rows
            .checked_mul(width)
            .and_then(|n| n.checked_mul(header.size as u64));
        if bytes.is_none_or(|bytes| bytes > i64::MAX as u64) {
            return Err(place().failure(
                format!("an array of {rows} rows is impossible"),
                "save it again",
            ));
        }
        let mut array = Self {
            path: path.to_owned(),
            header,
            rows,
            metadata: read_sidecar(&sidecar(path))?,
            columns: Columns {
                names: None,
                looks: Vec::new(),
                heads: Vec::new(),
                longer: Vec::new(),
                tags: Vec::new(),
                defined: Vec::new(),
                said: String::new(),
            },
        };
        array.columns.heads = array.heads(width)?;
        array.columns.looks = if width == 1 {
            vec![Look::Number]
        } else {
            let heads = array.columns.heads.iter();
            heads.map(|head| Look::of_numbers(head)).collect()
        };
        Ok(array)
    }

    /// The first numbers of each column, in either memory order.
    fn heads(&self, width: u64) -> Result<Vec<Vec<f64>>, Failure> {
        let fail = |error| self.failure(None, &error);
        let (mut file, _) = regular_file::open(&self.path)?;
        read_header(&self.path, &mut file)?;
        let start = file.stream_position().map_err(fail)?;
        let mut heads = Vec::new();
        for column in 0..width {
            let mut numbers = Vec::new();
            for row in 0..self.rows.min(LOOKS) {
                let index = if self.header.fortran_order {
                    column * self.rows + row
                } else {
                    row * width + column
                };
                let mut element = [0; 8];
                let element = &mut element[..self.header.size];
                // If the file is too short, the pass over it fails as well and reports the row.
                let offset = start.saturating_add(index * self.header.size as u64);
                if file.seek(SeekFrom::Start(offset)).is_err() || file.read_exact(element).is_err()
                {
                    break;
                }
                numbers.extend(self.number(element));
            }
            heads.push(numbers);
        }
        Ok(heads)
    }

    fn number(&self, element: &[u8]) -> Option<f64> {
        let mut number = None;
        let block = Block {
            bytes: element,
            columns: 1,
            row: 0,
            first: 0,
        };
        let column = AxisColumn {
            column: 0,
            axis: String::new(),
        };
        block
            .show(&self.header, &[column], &mut Keep(&mut number), &self.path)
            .ok()?;
        number
    }

    fn failure(&self, row: Option<u64>, error: &std::io::Error) -> Failure {
        let place = match row {
            Some(row) => Place::row(&self.path, row + 1),
            None => Place::file(&self.path),
        };
        if error.kind() == ErrorKind::UnexpectedEof {
            let what = format!(
                "the file ends before the {} rows that the header declares",
                self.rows
            );
            return place.failure(what, "copy or save it again");
        }
        place.io(error)
    }
}

impl Table for Npy {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn columns(&self) -> &Columns {
        &self.columns
    }

    fn notes(&self) -> Vec<String> {
        let file = self.metadata.told_in().and_then(Path::file_name);
        let note = |name: &std::ffi::OsStr| {
            format!(
                "rate, unit and scale as {} tells them",
                name.to_string_lossy()
            )
        };
        file.map(note).into_iter().collect()
    }

    fn by_rows(&self) -> bool {
        !self.header.fortran_order
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let mut reader = source::open_unbuffered(&self.path, progress)?;
        read_header(&self.path, &mut reader)?;
        let width = self.columns.looks.len();
        // A run is a row, or one element of a column in the other memory order.
        let (columns, runs) = if self.header.fortran_order {
            (1, self.rows * width as u64)
        } else {
            (width, self.rows)
        };
        let run_bytes = columns * self.header.size;
        let mut bytes = vec![0; (BLOCK / run_bytes).max(1) * run_bytes];
        let mut run = 0;
        while run < runs {
            let (row, first) = if self.header.fortran_order {
                (run % self.rows, (run / self.rows) as usize)
            } else {
                (run, 0)
            };
            // A block ends with its column.
            let wanted = (self.rows - row).min((bytes.len() / run_bytes) as u64) as usize;
            let (filled, ended) = fill(&mut reader, &mut bytes[..wanted * run_bytes]);
            let whole = filled / run_bytes;
            let block = Block {
                bytes: &bytes[..whole * run_bytes],
                columns,
                row,
                first,
            };
            if !block.show(&self.header, axes, visitor, &self.path)? {
                return Ok(Ended::NotCounts);
            }
            run += whole as u64;
            if let Some(error) = ended {
                return Err(self.failure(Some(row + whole as u64), &error));
            }
        }
        match reader.read(&mut [0]) {
            Ok(0) => Ok(Ended::AtTheLastRow),
            Ok(_) => Err(Place::file(&self.path).failure(
                format!(
                    "more data follow the {} rows that the header declares",
                    self.rows
                ),
                "save it again, one array a file",
            )),
            Err(error) => Err(self.failure(Some(self.rows), &error)),
        }
    }
}

/// The longest file beside an array that is read, in bytes. Chosen by hand.
const LONGEST_SIDECAR: u64 = 1 << 14;

/// The comments in the file beside an array, if there is one.
fn read_sidecar(path: &Path) -> Result<Metadata, Failure> {
    let mut metadata = Metadata::of_file(path);
    if !path.is_file() {
        return Ok(metadata);
    }
    let (file, _) = regular_file::open(path)?;
    let mut bytes = Vec::new();
    let read = file.take(LONGEST_SIDECAR).read_to_end(&mut bytes);
    read.map_err(|error| Place::file(path).io(&error))?;
    for (row, line) in (1..).zip(String::from_utf8_lossy(&bytes).lines()) {
        if let Some(comment) = line.strip_prefix('#') {
            metadata.read_comment(row, comment);
        }
    }
    Ok(metadata)
}

fn read_header(path: &Path, reader: &mut impl Read) -> Result<Header, Failure> {
    let place = || Place::file(path);
    match Header::read(reader) {
        Ok(Ok(header)) => Ok(header),
        Ok(Err(what)) => Err(place().failure(
            what,
            "save plain numbers with numpy.save, such as a.astype('f8')",
        )),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
            Err(place().failure("the file ends within its header", "copy or save it again"))
        }
        Err(error) => Err(place().io(&error)),
    }
}

/// The size of the blocks that are read at once, in bytes. Chosen by hand.
const BLOCK: usize = 1 << 16;

/// Fills a buffer as far as the reader has bytes. Returns the number of bytes, and why it is not the whole buffer.
fn fill(reader: &mut impl Read, buffer: &mut [u8]) -> (usize, Option<std::io::Error>) {
    let mut filled = 0;
    while filled < buffer.len() {
        match reader.read(&mut buffer[filled..]) {
            Ok(0) => return (filled, Some(ErrorKind::UnexpectedEof.into())),
            Ok(read) => filled += read,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return (filled, Some(error)),
        }
    }
    (filled, None)
}

/// A visitor that keeps the number that it is shown.
struct Keep<'a>(&'a mut Option<f64>);

impl Visitor for Keep<'_> {
    /// A run of a single number would only take room for many.
    const BY_ROWS: bool = true;

    type Followed = ();

    fn visit<F: Field>(&mut self, _axis: usize, value: F) -> Result<(), Stop> {
        *self.0 = value.number().ok();
        Ok(())
    }
}
