//! Logs as text: values are separated by commas, semicolons or tabs, and each row is a sample.

use super::{
    columns::{AxisColumn, Columns, Look},
    field::{Field, Text},
    lines::Lines,
    metadata::Metadata,
    records::{LONGEST_ROW, Records},
    source::{self, Format},
    table::{Ended, Stop, Table, Visitor},
};
use crate::failure::{Failure, Place, quoted};
use csv::ByteRecord;
use indicatif::ProgressBar;
use std::{
    io::{self, BufRead, ErrorKind, Read},
    path::{Path, PathBuf},
};

/// A line of this many bytes or more above the first row is refused, because the file is then not a
/// log. Chosen by hand.
const LONGEST_LINE: u64 = 1 << 16;

/// A log with more columns is refused. It would take minutes to look at all of them.
const MOST_COLUMNS: usize = 256;

/// The number of rows that decide what the columns look like. Chosen by hand.
const LOOKS: usize = 100;

/// A log of text whose first rows are known.
pub(super) struct Csv {
    path: PathBuf,
    gzip: bool,
    delimiter: u8,
    metadata: Metadata,
    columns: Columns,
    /// The offset of the first byte after the header, or 0 without a header.
    data_start: u64,
    /// Whether the last row has a line end.
    is_whole: bool,
}

/// The comments above the first record, and the format of that record.
struct Preamble {
    delimiter: u8,
    metadata: Metadata,
    /// The comment line directly above the first record.
    last_comment: Option<String>,
}

impl Csv {
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let gzip = Format::of(path)? == Format::Csv { gzip: true };
        let preamble = read_preamble(path, gzip)?;
        let mut table = Self {
            path: path.to_owned(),
            gzip,
            delimiter: preamble.delimiter,
            metadata: preamble.metadata,
            columns: Columns {
                names: None,
                looks: Vec::new(),
                heads: Vec::new(),
            },
            data_start: 0,
            is_whole: gzip || source::ends_with_line(path)?,
        };

        let records = table.first_records()?;
        let Some((first, end)) = records.first() else {
            return Err(Place::file(path).failure("no rows", "record some samples"));
        };
        let kinds: Vec<Kind> = first.iter().map(Kind::of).collect();
        if let Some(text) = kinds.iter().position(|&kind| kind == Kind::Text) {
            if kinds.contains(&Kind::Number) {
                return Err(table.row_at(0).failure(
                    format!(
                        "the first row mixes numbers and text such as {}",
                        quoted(&first[text])
                    ),
                    "make it a header of names only, or correct it",
                ));
            }
            table.data_start = *end;
            table.columns.names = Some(names_of(first));
        } else if let Some(comment) = preamble.last_comment {
            table.columns.names = table.names_in_comment(&comment, first.len());
        }
        let rows = &records[usize::from(table.data_start > 0)..];
        table.columns.heads = (0..first.len()).map(|column| head(rows, column)).collect();
        let looks = table.columns.heads.iter().enumerate();
        table.columns.looks = looks
            .map(|(column, head)| look(rows, column, head))
            .collect();
        Ok(table)
    }

    /// The first records, each with the offset in the text at which it ends.
    fn first_records(&self) -> Result<Vec<(ByteRecord, u64)>, Failure> {
        let text = source::open_text(&self.path, self.gzip, &ProgressBar::hidden())?;
        let mut reader = Records::new(text, 0, self.delimiter);
        let mut records = Vec::new();
        while records.len() < LOOKS {
            if !reader.read().map_err(|error| self.failure(error))? {
                break;
            }
            let row = reader.row();
            let width = records
                .first()
                .map_or(row.len(), |(first, _): &(ByteRecord, u64)| first.len());
            if row.len() > MOST_COLUMNS {
                return Err(self.row_at(reader.row_offset()).failure(
                    format!("{} columns, more than {MOST_COLUMNS}", row.len()),
                    "check the separators, or keep only the columns of the sensor",
                ));
            }
            // A row of another width is refused when all rows are read.
            if row.len() != width {
                break;
            }
            records.push((row.clone(), reader.rest_offset()));
        }
        Ok(records)
    }

    /// The names in a comment such as `# time,gx,gy,gz`, if it stands directly above the first
    /// record and has as many fields as that record.
    fn names_in_comment(&self, comment: &str, width: usize) -> Option<Vec<String>> {
        let mut reader = Records::new(comment.as_bytes(), 0, self.delimiter);
        let names = reader.read().ok()?.then(|| reader.row())?;
        let all_text = names.iter().all(|field| Kind::of(field) == Kind::Text);
        (width > 1 && names.len() == width && all_text && !comment.contains('='))
            .then(|| names_of(names))
    }

    fn row_at(&self, byte: u64) -> Place {
        match source::row_at(&self.path, self.gzip, byte) {
            Ok(row) => Place::row(&self.path, row),
            Err(_) => Place::file(&self.path),
        }
    }

    /// The failure to read the row that begins at the given byte.
    fn failure(&self, (byte, error): (u64, io::Error)) -> Failure {
        let here = self.row_at(byte);
        if error.kind() == ErrorKind::FileTooLarge {
            return here.failure(
                format!("a row is longer than {} KiB", LONGEST_ROW / 1024),
                "look for a quote that is never closed",
            );
        }
        source::text_failure(here, self.gzip, &error)
    }

    /// Shows the fields of one row to a visitor. Returns true if the visitor wants no more.
    #[inline]
    fn visit_row<'a, V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        field: impl Fn(usize) -> &'a [u8],
        byte: impl Fn() -> u64,
    ) -> Result<bool, Failure> {
        for (axis, column) in axes.iter().enumerate() {
            match visitor.visit(axis, Text(field(column.column))) {
                Ok(()) => {}
                Err(Stop::NotCounts) => return Ok(true),
                Err(stop) => return Err(stop.failure(column, self.row_at(byte()))),
            }
        }
        Ok(false)
    }
}

impl Table for Csv {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn columns(&self) -> &Columns {
        &self.columns
    }

    fn notes(&self) -> Vec<String> {
        let note = "the last row has no line end: it may be cut off";
        (!self.is_whole).then(|| note.into()).into_iter().collect()
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let width = self.columns.looks.len();
        let mut text = source::open_text(&self.path, self.gzip, progress)?;
        io::copy(&mut text.by_ref().take(self.data_start), &mut io::sink())
            .map_err(|error| self.failure((0, error)))?;

        let mut lines = Lines::new(text, self.data_start, self.delimiter, width);
        while lines
            .cut()
            .map_err(|error| self.failure((lines.rest_offset(), error)))?
        {
            let field = |column| lines.field(column);
            if self.visit_row(axes, visitor, field, || lines.row_offset())? {
                return Ok(Ended::NotCounts);
            }
        }

        let start = lines.rest_offset();
        let mut records = Records::new(lines.into_rest(), start, self.delimiter);
        while records.read().map_err(|error| self.failure(error))? {
            let row = records.row();
            if row.len() != width {
                return Err(self.row_at(records.row_offset()).failure(
                    format!("{} where the first row has {width}", values(row.len())),
                    "correct the row or cut the record there",
                ));
            }
            let byte = || records.row_offset();
            if self.visit_row(axes, visitor, |column| &row[column], byte)? {
                return Ok(Ended::NotCounts);
            }
        }
        Ok(Ended::AtTheLastRow)
    }
}

/// Reads the comments down to the first record.
fn read_preamble(path: &Path, gzip: bool) -> Result<Preamble, Failure> {
    let mut text = source::open_text(path, gzip, &ProgressBar::hidden())?;
    let mut metadata = Metadata::default();
    let mut last_comment = None;
    let mut line = Vec::new();
    for row in 1.. {
        line.clear();
        let read = text
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut line);
        let length =
            read.map_err(|error| source::text_failure(Place::row(path, row), gzip, &error))?;
        if length == 0 {
            let what = if row == 1 {
                "the file is empty"
            } else {
                "no rows"
            };
            return Err(Place::file(path).failure(what, "record some samples"));
        }
        if length as u64 == LONGEST_LINE {
            return Err(Place::row(path, row).failure(
                format!("a line has {} KiB or more", LONGEST_LINE / 1024),
                "check that the file is text",
            ));
        }
        if let Some(comment) = line.strip_prefix(b"#") {
            let comment = String::from_utf8_lossy(comment).trim().to_owned();
            metadata.read_comment(row, &comment);
            last_comment = Some(comment);
        } else if !line.trim_ascii().is_empty() {
            break;
        }
    }
    let delimiter = [b';', b'\t']
        .into_iter()
        .find(|delimiter| line.contains(delimiter))
        .unwrap_or(b',');
    Ok(Preamble {
        delimiter,
        metadata,
        last_comment,
    })
}

/// The kind of a field of the first row.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    Empty,
    Text,
}

impl Kind {
    fn of(field: &[u8]) -> Self {
        let field = field.trim_ascii();
        if field.is_empty() {
            Self::Empty
        } else if fast_float2::parse::<f64, _>(field).is_ok() {
            Self::Number
        } else {
            Self::Text
        }
    }
}

fn names_of(record: &ByteRecord) -> Vec<String> {
    record
        .iter()
        .map(|name| {
            let name = String::from_utf8_lossy(name);
            name.trim().replace(char::is_control, " ")
        })
        .collect()
}

fn number(row: &ByteRecord, column: usize) -> Option<f64> {
    Text(row.get(column)?).number().ok()
}

fn head(rows: &[(ByteRecord, u64)], column: usize) -> Vec<f64> {
    let numbers = rows.iter().filter_map(|(row, _)| number(row, column));
    numbers.collect()
}

fn look(rows: &[(ByteRecord, u64)], column: usize, head: &[f64]) -> Look {
    match rows.first() {
        Some((row, _)) if number(row, column).is_none() => Look::Text,
        _ => Look::of_numbers(head),
    }
}

fn values(count: usize) -> String {
    if count == 1 {
        "1 value".into()
    } else {
        format!("{count} values")
    }
}
