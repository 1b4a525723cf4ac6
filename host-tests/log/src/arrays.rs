//! Reads arrays in the memory of another program, whose columns are axes, without copying them as a whole.

use super::{
    Covariates, Log, Options,
    columns::{AxisColumn, Columns, Look},
    field::Flaw,
    metadata::Metadata,
    reading::{Watched, read_table},
    runs::{Rows, Run, Values},
    table::{Ended, RUN, Table, Visitor},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use std::path::{Path, PathBuf};

/// The number of rows that decide what the columns look like. It is that of array files.
const LOOKS: usize = 100;

/// Copies the elements of a column from a row on, as many as there is room for.
pub type Fill<'a, T> = Box<dyn Fn(usize, &mut [T]) + Send + Sync + 'a>;

/// The numbers of a column. A type with fewer bits is copied as one with more.
pub enum Numbers<'a> {
    /// Integers of 32 bits or fewer, except `u32`.
    Int32(Fill<'a, i32>),
    /// Integers of 64 bits, and `u32`.
    Int64(Fill<'a, i64>),
    /// Unsigned integers of 64 bits.
    Uint64(Fill<'a, u64>),
    /// Floats. A value that is missing is not a number.
    Float(Fill<'a, f64>),
}

/// A column and its name; an empty name is none.
pub struct Column<'a> {
    /// The name.
    pub name: String,
    /// The numbers.
    pub numbers: Numbers<'a>,
}

/// Columns of equal length.
pub struct Arrays<'a> {
    path: PathBuf,
    rows: usize,
    columns: Vec<Column<'a>>,
    metadata: Metadata,
    seen: Columns,
}

impl<'a> Arrays<'a> {
    /// Columns with so many rows. `name` stands for the file in messages.
    ///
    /// # Errors
    /// When there is no row or no column.
    pub fn new(name: &Path, rows: usize, columns: Vec<Column<'a>>) -> Result<Self, Failure> {
        if rows == 0 || columns.is_empty() {
            let what = if rows == 0 { "no rows" } else { "no columns" };
            return Err(Place::file(name).failure(what, "record some samples"));
        }
        let names = columns.iter().map(|column| column.name.clone());
        let has_names = columns.iter().any(|column| !column.name.is_empty());
        let heads: Vec<Vec<f64>> = columns
            .iter()
            .map(|column| head(&column.numbers, rows))
            .collect();
        let looks = match heads.len() {
            // The only column is an axis even if it rises.
            1 => vec![Look::Number],
            _ => heads.iter().map(|head| Look::of_numbers(head)).collect(),
        };
        Ok(Self {
            seen: Columns {
                names: has_names.then(|| names.collect()),
                looks,
                heads,
                longer: Vec::new(),
                tags: Vec::new(),
                defined: Vec::new(),
                said: String::new(),
            },
            path: name.to_owned(),
            rows,
            columns,
            metadata: Metadata::default(),
        })
    }

    /// The number of columns.
    pub fn width(&self) -> usize {
        self.columns.len()
    }

    /// The name of a column, or its number.
    pub fn name(&self, column: usize) -> String {
        self.seen.called(column)
    }

    /// The name that stands for the file in messages.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Reads the columns together with the evidence beside each curve. `progress` follows the rows, and ends the reading when
/// it is ended itself.
///
/// # Errors
/// The errors are those of [`read_with_evidence`](super::read_with_evidence).
pub fn read_arrays(
    arrays: &Arrays<'_>,
    options: &Options,
    covariates: &Covariates,
    progress: &ProgressBar,
) -> Result<Log, Failure> {
    let watch = Watched {
        covariates,
        moments: true,
        spectrogram: false,
        first_sample: None,
    };
    if options.topic.is_some() {
        return Err(Place::file(&arrays.path).failure("arrays have no topics", "omit --topic"));
    }
    let (log, _) = read_table(arrays, &arrays.path, options, (None, Some(watch)), progress)?;
    Ok(log)
}

/// The first values of a column that are numbers.
fn head(numbers: &Numbers<'_>, rows: usize) -> Vec<f64> {
    let mut run = run_of(numbers);
    read(&mut run, numbers, 0, rows.min(LOOKS));
    (0..rows.min(LOOKS))
        .filter_map(|row| run.number(row))
        .collect()
}

/// A run for a column of these numbers.
fn run_of(numbers: &Numbers<'_>) -> Run {
    Run::of(match numbers {
        Numbers::Int32(_) => Values::Int32(vec![0; RUN]),
        Numbers::Int64(_) => Values::Int64(vec![0; RUN]),
        Numbers::Uint64(_) => Values::Uint64(vec![0; RUN]),
        Numbers::Float(_) => Values::Float(vec![0.0; RUN]),
    })
}

/// Reads some rows of the column that a run was made for.
fn read(run: &mut Run, numbers: &Numbers<'_>, first: usize, rows: usize) {
    match (&mut run.values, numbers) {
        (Values::Int32(run), Numbers::Int32(copy)) => copy(first, &mut run[..rows]),
        (Values::Int64(run), Numbers::Int64(copy)) => copy(first, &mut run[..rows]),
        (Values::Uint64(run), Numbers::Uint64(copy)) => copy(first, &mut run[..rows]),
        (Values::Float(run), Numbers::Float(copy)) => copy(first, &mut run[..rows]),
        _ => {}
    }
}

impl Table for Arrays<'_> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn columns(&self) -> &Columns {
        &self.seen
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let numbers = |axis: &AxisColumn| &self.columns[axis.column].numbers;
        let mut runs: Vec<Run> = axes.iter().map(|axis| run_of(numbers(axis))).collect();
        progress.set_length(self.rows as u64);
        for first in (0..self.rows).step_by(RUN) {
            if progress.is_finished() {
                return Err(Failure::interrupted());
            }
            progress.set_position(first as u64);
            let rows = RUN.min(self.rows - first);
            for (run, axis) in runs.iter_mut().zip(axes) {
                read(run, numbers(axis), first, rows);
            }
            let shown = Rows {
                runs: &runs,
                rows,
                axes,
                place: |row| Place::row(&self.path, (first + row) as u64 + 1),
                of_stamp: |_, _: &Flaw| None,
            };
            if !shown.show(visitor)? {
                return Ok(Ended::NotCounts);
            }
        }
        Ok(Ended::AtTheLastRow)
    }
}
