//! Numbers of a table in binary, in a temporary file.
//!
//! The file is a sequence of blocks of [`RUN`] rows, of which the last one may be filled up. In a block, the columns lie one
//! behind the other: a byte for each row, which is 1 if its value is missing, and the values in the order of the machine's bytes.

use super::{
    columns::AxisColumn,
    field::{Flaw, Nanoseconds},
    runs::{Rows, Run, Values},
    table::{Ended, RUN, Visitor},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use std::{
    fs::File,
    io::{self, Read as _, Write},
};
use tempfile::TempPath;

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Kind {
    /// Integers of 32 bits.
    Int32,
    /// Integers of 64 bits.
    Int64,
    /// Unsigned integers of 64 bits.
    Uint64,
    /// Floats of 64 bits.
    Float,
    /// Dates and times, in nanoseconds of 64 bits.
    Date,
}

impl Kind {
    /// The bytes of a value.
    const fn size(self) -> usize {
        match self {
            Self::Int32 => 4,
            Self::Int64 | Self::Uint64 | Self::Float | Self::Date => 8,
        }
    }

    /// The bytes of a column in a block.
    const fn bytes(self) -> usize {
        RUN * (1 + self.size())
    }

    /// A run for a column.
    fn run(self) -> Run {
        Run::of(match self {
            Self::Int32 => Values::Int32(vec![0; RUN]),
            Self::Int64 => Values::Int64(vec![0; RUN]),
            Self::Uint64 => Values::Uint64(vec![0; RUN]),
            Self::Float => Values::Float(vec![0.0; RUN]),
            Self::Date => Values::Date(vec![Nanoseconds(0); RUN]),
        })
    }
}

/// What a file of numbers holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Layout {
    /// The number of rows.
    pub(super) rows: u64,
    /// What the values of each column are, or `None` for one that is not in the file.
    pub(super) columns: Vec<Option<Kind>>,
}

impl Layout {
    /// What the values of a column are, and where they lie in a block.
    fn place(&self, column: usize) -> Option<(Kind, usize)> {
        let before = self.columns.get(..column)?.iter().flatten();
        let offset = before.map(|kind| kind.bytes()).sum();
        self.columns.get(column)?.map(|kind| (kind, offset))
    }

    /// Whether the file holds all of these columns.
    #[cfg(feature = "tables")]
    pub(super) fn has(&self, columns: impl IntoIterator<Item = usize>) -> bool {
        let is_there = |column: usize| self.columns.get(column).is_some_and(Option::is_some);
        columns.into_iter().all(is_there)
    }
}

/// A file of numbers, which is deleted when this is dropped.
pub(super) struct NumberFile {
    pub(super) file: TempPath,
    pub(super) layout: Layout,
}

/// What a pass over a file of numbers says of its rows, which are counted from 0.
pub(super) trait Told {
    /// The place of a row in the log.
    fn place(&self, row: u64) -> Place;

    /// What says more than the flaw of the stamp of a row.
    fn of_stamp(&self, row: u64, flaw: &Flaw) -> Option<Failure>;
}

impl NumberFile {
    /// Shows the values of some columns to a visitor. `axes` are what messages call them.
    pub(super) fn pass<V: Visitor>(
        &self,
        (columns, axes): (&[usize], &[AxisColumn]),
        visitor: &mut V,
        told: &impl Told,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let fail = |error: io::Error| told.place(0).io(&error);
        let places = columns
            .iter()
            .filter_map(|&column| self.layout.place(column));
        let places: Vec<(Kind, usize)> = places.collect();
        let mut file = File::open(&self.file).map_err(fail)?;
        let block = self.layout.columns.iter().flatten();
        let mut bytes = vec![0; block.map(|kind| kind.bytes()).sum()];
        let mut runs: Vec<Run> = places.iter().map(|(kind, _)| kind.run()).collect();
        progress.set_length(self.layout.rows);
        let mut first = 0;
        while first < self.layout.rows {
            if progress.is_finished() {
                return Err(Failure::interrupted());
            }
            progress.set_position(first);
            file.read_exact(&mut bytes).map_err(fail)?;
            for (run, (kind, offset)) in runs.iter_mut().zip(&places) {
                read(run, &bytes[*offset..][..kind.bytes()]);
            }
            let shown = Rows {
                runs: &runs,
                rows: (self.layout.rows - first).min(RUN as u64) as usize,
                axes,
                place: |row| told.place(first + row as u64),
                of_stamp: |row, flaw: &Flaw| told.of_stamp(first + row as u64, flaw),
            };
            if !shown.show(visitor)? {
                return Ok(Ended::NotCounts);
            }
            first += RUN as u64;
        }
        Ok(Ended::AtTheLastRow)
    }
}

/// Reads a column of a block.
fn read(run: &mut Run, bytes: &[u8]) {
    fn all<T, const SIZE: usize>(
        values: &mut [T],
        bytes: &[u8],
        convert: impl Fn([u8; SIZE]) -> T,
    ) {
        for (value, &bytes) in values.iter_mut().zip(bytes.as_chunks::<SIZE>().0) {
            *value = convert(bytes);
        }
    }
    let (missing, bytes) = bytes.split_at(RUN);
    run.missing.clear();
    if missing.iter().fold(0, |any, missing| any | missing) != 0 {
        run.missing
            .extend(missing.iter().map(|missing| *missing != 0));
    }
    match &mut run.values {
        Values::Int32(values) => all(values, bytes, i32::from_ne_bytes),
        Values::Int64(values) => all(values, bytes, i64::from_ne_bytes),
        Values::Uint64(values) => all(values, bytes, u64::from_ne_bytes),
        Values::Float(values) => all(values, bytes, f64::from_ne_bytes),
        Values::Date(values) => all(values, bytes, |bytes| {
            Nanoseconds(i64::from_ne_bytes(bytes))
        }),
    }
}

/// Writes a file of numbers.
pub(super) struct NumberWriter<W> {
    out: W,
    layout: Layout,
    columns: Vec<Column>,
    /// The number of rows in the present block.
    filled: usize,
}

/// The values of a column in the present block.
struct Column {
    kind: Kind,
    missing: Vec<u8>,
    bytes: Vec<u8>,
}

impl<W: Write> NumberWriter<W> {
    pub(super) fn new(columns: Vec<Option<Kind>>, out: W) -> Self {
        let column = |kind: &Kind| Column {
            kind: *kind,
            missing: Vec::with_capacity(RUN),
            bytes: Vec::with_capacity(RUN * kind.size()),
        };
        Self {
            out,
            columns: columns.iter().flatten().map(column).collect(),
            layout: Layout { rows: 0, columns },
            filled: 0,
        }
    }

    /// Adds rows. `append` adds the bytes of the values of some of them in one of the columns that the file holds, and whether each
    /// is missing.
    #[cfg(feature = "tables")]
    pub(super) fn push(
        &mut self,
        rows: usize,
        mut append: impl FnMut(usize, std::ops::Range<usize>, &mut Vec<u8>, &mut Vec<u8>),
    ) -> io::Result<()> {
        let mut row = 0;
        while row < rows {
            let some = row..rows.min(row + RUN - self.filled);
            for (place, column) in self.columns.iter_mut().enumerate() {
                append(place, some.clone(), &mut column.bytes, &mut column.missing);
            }
            row = some.end;
            self.end_rows(some.len())?;
        }
        Ok(())
    }

    /// Adds a value of the present row, in one of the columns that the file holds.
    #[inline]
    pub(super) fn put(&mut self, place: usize, value: [u8; 8]) {
        if let Some(column) = self.columns.get_mut(place) {
            column.bytes.extend(value);
        }
    }

    /// Ends rows that have a value in every column.
    #[inline]
    pub(super) fn end_rows(&mut self, rows: usize) -> io::Result<()> {
        self.layout.rows += rows as u64;
        self.filled += rows;
        match self.filled == RUN {
            true => self.flush(),
            false => Ok(()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        for column in &mut self.columns {
            column.missing.resize(RUN, 0);
            column.bytes.resize(RUN * column.kind.size(), 0);
            self.out.write_all(&column.missing)?;
            self.out.write_all(&column.bytes)?;
            column.missing.clear();
            column.bytes.clear();
        }
        self.filled = 0;
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<Layout> {
        if self.filled > 0 {
            self.flush()?;
        }
        self.out.flush()?;
        Ok(self.layout)
    }

    /// The bytes that are written so far.
    pub(super) fn length(&self) -> u64 {
        let row: usize = self
            .columns
            .iter()
            .map(|column| 1 + column.kind.size())
            .sum();
        self.layout.rows * row as u64
    }
}
