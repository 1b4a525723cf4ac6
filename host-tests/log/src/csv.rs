//! Logs as text, in which each row is a sample.

mod far;

use super::{
    columns::{AxisColumn, Columns, Look},
    dialect::Dialect,
    edit::{Edit, Kept},
    field::{Field, Flaw, Stamp, Text},
    filled::Filled,
    glue::Glue,
    lines::{Cut, Lines},
    metadata::Metadata,
    preamble::{Preamble, values},
    records::{LONGEST_ROW, Records},
    source, source_marks,
    table::{Ended, Stop, Table, Visitor, after_stop},
};
use crate::failure::{Failure, Place, quoted};
use crate::{Options, RowChoice};
use csv::ByteRecord;
use indicatif::ProgressBar;
use std::{
    cell::Cell,
    io::{self, BufReader, ErrorKind, Read},
    path::{Path, PathBuf},
};

/// A log with more columns is refused. It would take minutes to look at all of them.
const MOST_COLUMNS: usize = 256;

/// The number of rows that decide what the columns look like. Chosen by hand.
const LOOKS: usize = 100;

/// The number of rows in which the marks of several sensors are looked for. Blocks of rows of one sensor, as a FIFO gives
/// them, are shorter than a quarter of them. Chosen by hand.
const MARKED: usize = 1024;

/// The bytes of the rows that are looked at, of which a long row has many.
const MOST_BYTES: usize = 1 << 20;

/// A log of text whose first rows are known.
pub(super) struct Csv {
    /// The file that messages name.
    path: PathBuf,
    /// The file with the text.
    text: PathBuf,
    gzip: bool,
    dialect: Dialect,
    edit: Edit,
    metadata: Metadata,
    columns: Columns,
    /// The offset in the text of the first row.
    start: u64,
    /// Whether the last row has a line end.
    is_whole: bool,
    /// The number of comments among the rows that tell of lost samples, and the number of these samples.
    lost: Cell<(u64, u64)>,
}

impl Csv {
    pub(super) fn open(path: &Path, gzip: bool, options: &Options) -> Result<Self, Failure> {
        Self::open_as(path, path, gzip, options)
    }

    /// Opens a text that was made of another file, which messages name.
    pub(super) fn open_as(
        path: &Path,
        text: &Path,
        gzip: bool,
        options: &Options,
    ) -> Result<Self, Failure> {
        let preamble = Preamble::read(path, text, gzip)?;
        let mut table = Self {
            path: path.to_owned(),
            text: text.to_owned(),
            gzip,
            dialect: preamble.dialect,
            edit: Edit {
                glue: preamble.glue,
                kept: None,
            },
            metadata: preamble.metadata,
            columns: Columns {
                names: preamble.names,
                looks: Vec::new(),
                heads: Vec::new(),
                longer: Vec::new(),
                tags: Vec::new(),
                defined: Vec::new(),
                said: said(path, &preamble.said),
            },
            start: preamble.start,
            is_whole: gzip || source::ends_with_line(text)?,
            lost: Cell::new((0, 0)),
        };
        if preamble.width > MOST_COLUMNS {
            return Err(table.row_at(table.start).failure(
                format!("{} columns, more than {MOST_COLUMNS}", preamble.width),
                "check the separators, or keep only the columns of the sensor",
            ));
        }
        if !table.look(preamble.width)? {
            return Err(Place::file(path).failure("no rows", "record some samples"));
        }
        match &options.rows {
            Some(choice) => table.keep_rows(choice, preamble.width)?,
            None => table.keep_rows_of_axes(options, preamble.width)?,
        }
        if options.rows.is_none() && options.rate_hz.is_none() {
            table.check_turns()?;
        }
        Ok(table)
    }

    /// Looks at the columns of the first rows. Returns whether there are any.
    fn look(&mut self, width: usize) -> Result<bool, Failure> {
        let rows = self.first_records()?;
        let first = &rows[..rows.len().min(LOOKS)];
        let columns = (0..width).map(|column| look(first, column));
        (self.columns.looks, self.columns.heads) = columns.unzip();
        let numbers: Vec<Vec<Option<f64>>> = (0..width)
            .map(|column| rows.iter().map(|row| number(row, column)).collect())
            .collect();
        let looks = self.columns.looks.iter().enumerate();
        let tags = looks.map(|(column, look)| match look {
            Look::Text => tags(&rows, column),
            Look::Number if source_marks::are_marks(&rows, &numbers, column) => tags(&rows, column),
            _ => Vec::new(),
        });
        self.columns.tags = tags.collect();
        let looks = self.columns.looks.iter().enumerate();
        let longer = looks.map(|(column, look_of)| match look_of {
            Look::Text => Vec::new(),
            _ => look(&rows, column).1,
        });
        self.columns.longer = longer.collect();
        Ok(!rows.is_empty())
    }

    /// Leaves out all rows but those with a value in a column.
    fn keep_rows(&mut self, choice: &RowChoice, width: usize) -> Result<(), Failure> {
        self.edit.kept = Some(Kept {
            column: self.columns.find(&self.path, &choice.column)?,
            value: Some(choice.value.clone()),
            dialect: self.dialect,
        });
        if self.look(width)? {
            return Ok(());
        }
        let (column, value) = [&choice.column, &choice.value]
            .map(|text| quoted(text.as_bytes()))
            .into();
        Err(Place::file(&self.path).failure(
            format!("no row has {value} in column {column}"),
            "give another --rows COLUMN=VALUE",
        ))
    }

    /// Leaves out the rows of other sensors, in which the axes have no value.
    fn keep_rows_of_axes(&mut self, options: &Options, width: usize) -> Result<(), Failure> {
        let mut rows = self.first_records()?;
        let last = self.last_records();
        self.check_far_sources(&rows, &last)?;
        rows.extend(last);
        let filled = Filled::of_rows(&rows, width);
        let Some(column) = filled.column_of_axes(&self.columns, &self.path, options)? else {
            return Ok(());
        };
        self.edit.kept = Some(Kept {
            column,
            value: None,
            dialect: self.dialect,
        });
        self.look(width).map(|_| ())
    }

    /// Checks that the rows do not take turns between sensors that no column tells apart.
    fn check_turns(&self) -> Result<(), Failure> {
        let rows = self.first_records()?;
        let column = |column: usize| rows.iter().map(|row| number(row, column)).collect();
        let numbers: Vec<Vec<Option<f64>>> = (0..self.columns.looks.len()).map(column).collect();
        let turns = source_marks::turns(&numbers);
        let Some(turns) = turns.or_else(|| source_marks::turns_of_decimals(&rows)) else {
            return Ok(());
        };
        // A column that tells the sensors apart says more.
        self.columns.check_sources(&self.path)?;
        Err(Place::file(&self.path).failure(
            format!("every {} row is unlike those beside it, as rows of several sensors are", ["second", "third"][turns - 2]),
            "write the rows of one sensor to a file of their own, or give --rate if it is one sensor",
        ))
    }

    /// Whether rows are left out, or something is cut off them.
    #[cfg(feature = "tables")]
    pub(super) fn is_edited(&self) -> bool {
        self.edit.glue.is_some() || self.edit.kept.is_some()
    }

    /// A row and its place. Rows are counted from 0, without comments and blank lines.
    fn row_and_place(&self, row: u64) -> Option<(ByteRecord, Place)> {
        let text = self.rows(&ProgressBar::hidden()).ok()?;
        let mut reader = Records::new(text, self.start, self.dialect.delimiter());
        let mut above = 0;
        while reader.read().ok()? {
            let fields = reader.row();
            let is_comment = fields.get(0).is_some_and(|field| field.starts_with(b"#"));
            if is_comment || is_blank(fields) {
                continue;
            }
            if above == row {
                return Some((fields.clone(), self.row_at(reader.row_offset())));
            }
            above += 1;
        }
        None
    }

    /// The place of a row.
    pub(super) fn place_of(&self, row: u64) -> Place {
        let place = self.row_and_place(row).map(|(_, place)| place);
        place.unwrap_or_else(|| Place::file(&self.path))
    }

    /// The failure of the stamp of a row, if the row is that of another sensor.
    pub(super) fn of_other_sensor(&self, row: u64, flaw: &Flaw) -> Option<Failure> {
        let (fields, place) = self.row_and_place(row)?;
        let field = |column: usize| fields.get(column).unwrap_or_default();
        self.columns.of_other_sensor(&field, flaw, || place)
    }

    /// The text from the first row on, with one delimiter between values.
    fn rows(&self, progress: &ProgressBar) -> Result<Box<dyn Read>, Failure> {
        let mut text = source::open_text(&self.text, self.gzip, progress)?;
        io::copy(&mut text.by_ref().take(self.start), &mut io::sink())
            .map_err(|error| self.failure((0, error)))?;
        Ok(self.dialect.tidied(self.edit.of(text)))
    }

    /// The first rows.
    fn first_records(&self) -> Result<Vec<ByteRecord>, Failure> {
        let text = self.rows(&ProgressBar::hidden())?;
        let mut reader = Records::new(text, self.start, self.dialect.delimiter());
        let mut records: Vec<ByteRecord> = Vec::new();
        let mut bytes = 0;
        while records.len() < MARKED && bytes < MOST_BYTES {
            if !reader.read().map_err(|error| self.failure(error))? {
                break;
            }
            let row = reader.row();
            if row.get(0).is_some_and(|field| field.starts_with(b"#")) || is_blank(row) {
                continue;
            }
            // A row of another width is refused when all rows are read.
            if records
                .first()
                .is_some_and(|first| row.len() != first.len())
            {
                break;
            }
            bytes += row.as_slice().len();
            // A clone would have room for the longest row so far.
            records.push(row.iter().collect());
        }
        Ok(records)
    }

    /// The row that begins at a byte of the text that [`Csv::rows`] returns.
    fn row_at(&self, byte: u64) -> Place {
        match self.row(byte) {
            Ok(row) => Place::row(&self.path, row),
            Err(_) => Place::file(&self.path),
        }
    }

    fn row(&self, byte: u64) -> Result<u64, Failure> {
        let raw = source::open_text(&self.text, self.gzip, &ProgressBar::hidden())?;
        let above = source::lines_before(raw, self.start.min(byte));
        let rows = BufReader::new(self.rows(&ProgressBar::hidden())?);
        Ok(above + source::row_at(rows, byte.saturating_sub(self.start)))
    }

    /// Handles a comment among the rows: it tells of lost samples, or else it must be the last line.
    fn comment<V: Visitor>(
        &self,
        comment: &[u8],
        byte: u64,
        visitor: &mut V,
    ) -> Result<Option<Pending>, Failure> {
        let Some(lost) = lost_samples(comment) else {
            return Ok(Some(Pending {
                comment: comment.to_vec(),
                byte,
            }));
        };
        if lost > 0 {
            let (gaps, samples) = self.lost.get();
            self.lost.set((gaps + 1, samples.saturating_add(lost)));
            visitor.gap(lost);
        }
        Ok(None)
    }

    /// The failure of a comment that is followed by rows.
    fn unclear(&self, pending: &Pending) -> Failure {
        self.row_at(pending.byte).failure(
            format!(
                "a comment among the rows: {}",
                quoted(pending.comment.trim_ascii())
            ),
            "remove it, or write `# lost N samples` if samples are missing there",
        )
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
            if let Err(stop) = visitor.visit(axis, Text(field(column.column))) {
                let place = || self.row_at(byte());
                if let Stop::Clock(flaw) = &stop
                    && let Some(failure) = self.columns.of_other_sensor(&field, flaw, place)
                {
                    return Err(failure);
                }
                return after_stop(visitor, (axis, &stop), axes, place).map(|goes_on| !goes_on);
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
        let mut notes: Vec<String> = (!self.is_whole).then(|| note.into()).into_iter().collect();
        notes.extend(self.edit.glue.iter().map(Glue::said));
        if let Some(Kept {
            column,
            value: None,
            ..
        }) = self.edit.kept
        {
            let called = self.columns.called(column);
            notes.push(format!(
                "rows without a value of {called} are those of another sensor: left out"
            ));
        }
        let (gaps, samples) = self.lost.get();
        if gaps > 0 {
            let comments = if gaps == 1 {
                "a comment tells".into()
            } else {
                format!("{gaps} comments tell")
            };
            notes.push(format!(
                "{comments} of {samples} lost samples: no difference spans them"
            ));
        }
        notes
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let width = self.columns.looks.len();
        let delimiter = self.dialect.delimiter();
        self.lost.set((0, 0));
        let mut pending = None;
        let text = self.rows(progress)?;
        let mut lines = Lines::new(text, self.start, delimiter, width);
        loop {
            let cut = lines
                .cut()
                .map_err(|error| self.failure((lines.rest_offset(), error)))?;
            let byte = lines.row_offset();
            match (cut, &pending) {
                (Cut::Rest, _) => break,
                (Cut::Row, Some(pending)) => return Err(self.unclear(pending)),
                (Cut::Comment, _) => {
                    let found = self.comment(lines.line(), byte, visitor)?;
                    pending = pending.or(found);
                }
                (Cut::Row, None) => {
                    let field = |column| lines.field(column);
                    if self.visit_row(axes, visitor, field, || byte)? {
                        return Ok(Ended::NotCounts);
                    }
                }
            }
        }

        let start = lines.rest_offset();
        let mut records = Records::new(lines.into_rest(), start, delimiter);
        while records.read().map_err(|error| self.failure(error))? {
            let row = records.row();
            let byte = || records.row_offset();
            if row.get(0).is_some_and(|field| field.starts_with(b"#")) {
                let comment: Vec<&[u8]> = row.iter().collect();
                let found = self.comment(&comment.join(&b','), byte(), visitor)?;
                pending = pending.or(found);
                continue;
            }
            if is_blank(row) {
                continue;
            }
            if let Some(pending) = &pending {
                return Err(self.unclear(pending));
            }
            if row.len() != width {
                visitor.lose_row(None, || {
                    self.row_at(byte()).failure(
                        format!("{} where the first row has {width}", values(row.len())),
                        "correct the row or cut the record there",
                    )
                })?;
                continue;
            }
            if self.visit_row(axes, visitor, |column| &row[column], byte)? {
                return Ok(Ended::NotCounts);
            }
        }
        Ok(Ended::AtTheLastRow)
    }
}

/// The file's name and what stands above the rows, in lower case.
fn said(path: &Path, preamble: &str) -> String {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    format!("{name}\n{preamble}")
}

/// Whether a row is a line of blanks alone.
fn is_blank(row: &ByteRecord) -> bool {
    row.len() == 1 && row[0].trim_ascii().is_empty()
}

/// A comment among the rows that tells of no lost samples, and its place.
struct Pending {
    comment: Vec<u8>,
    byte: u64,
}

/// The number of samples that a comment such as `# lost 500 samples` says are missing.
fn lost_samples(comment: &[u8]) -> Option<u64> {
    let text = String::from_utf8_lossy(comment).to_lowercase();
    let words = [
        "lost", "lose", "missing", "missed", "dropped", "skipped", "gap",
    ];
    let mut numbers = text
        .split(|c: char| !c.is_alphanumeric() && c != '.')
        .filter_map(|word| word.parse().ok());
    let number = numbers.next();
    // Another number may be a time, so that it is not clear how many samples are lost.
    let is_clear = numbers.next().is_none() && words.iter().any(|word| text.contains(word));
    number.filter(|_| is_clear)
}

/// The texts of a column.
fn tags(rows: &[ByteRecord], column: usize) -> Vec<String> {
    let fields = rows.iter().filter_map(|row| row.get(column));
    let text = |field: &[u8]| String::from_utf8_lossy(field.trim_ascii()).into_owned();
    fields.map(text).collect()
}

fn number(row: &ByteRecord, column: usize) -> Option<f64> {
    Text(row.get(column)?).number().ok()
}

/// What a column of these rows looks like, and its first values. Those of dates and times are nanoseconds since the
/// first one.
fn look(rows: &[ByteRecord], column: usize) -> (Look, Vec<f64>) {
    let head: Vec<f64> = rows.iter().filter_map(|row| number(row, column)).collect();
    let is_number = rows
        .first()
        .is_some_and(|row| number(row, column).is_some());
    if is_number {
        return (Look::of_numbers(&head), head);
    }
    let dates = rows
        .iter()
        .filter_map(|row| Text(row.get(column)?).date_or_time());
    let dates: Vec<Stamp> = dates.collect();
    match dates.first() {
        Some(&first) if 2 * dates.len() > rows.len() => (
            Look::Date,
            dates.iter().map(|date| date.since(first)).collect(),
        ),
        _ => (Look::Text, head),
    }
}
