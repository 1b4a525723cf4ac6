//! Reads arrays in the memory of another program, whose columns are axes, without copying them as a whole.

use super::{
    Covariates, Log, Options,
    columns::{AxisColumn, Columns, Look},
    field::Field,
    metadata::Metadata,
    reading::{Watched, read_table},
    table::{Ended, RUN, Stop, Table, Visitor, after_stop},
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
    let mut run = Run::of(numbers);
    run.read(numbers, 0, rows.min(LOOKS));
    (0..rows.min(LOOKS))
        .filter_map(|row| run.number(row))
        .collect()
}

/// Some rows of a column.
enum Run {
    Int32(Vec<i32>),
    Int64(Vec<i64>),
    Uint64(Vec<u64>),
    Float(Vec<f64>),
}

/// Does the same with the values of any type.
macro_rules! with_values {
    ($run:expr, $values:ident => $work:expr) => {
        match $run {
            Run::Int32($values) => $work,
            Run::Int64($values) => $work,
            Run::Uint64($values) => $work,
            Run::Float($values) => $work,
        }
    };
}

impl Run {
    fn of(numbers: &Numbers<'_>) -> Self {
        match numbers {
            Numbers::Int32(_) => Self::Int32(vec![0; RUN]),
            Numbers::Int64(_) => Self::Int64(vec![0; RUN]),
            Numbers::Uint64(_) => Self::Uint64(vec![0; RUN]),
            Numbers::Float(_) => Self::Float(vec![0.0; RUN]),
        }
    }

    /// Reads some rows of the column that this run was made for.
    fn read(&mut self, numbers: &Numbers<'_>, first: usize, rows: usize) {
        match (self, numbers) {
            (Self::Int32(run), Numbers::Int32(copy)) => copy(first, &mut run[..rows]),
            (Self::Int64(run), Numbers::Int64(copy)) => copy(first, &mut run[..rows]),
            (Self::Uint64(run), Numbers::Uint64(copy)) => copy(first, &mut run[..rows]),
            (Self::Float(run), Numbers::Float(copy)) => copy(first, &mut run[..rows]),
            _ => {}
        }
    }

    fn number(&self, row: usize) -> Option<f64> {
        with_values!(self, values => values[row].number().ok())
    }

    /// Whether all of the first rows are numbers. Integers are.
    fn are_numbers(&self, rows: usize) -> bool {
        match self {
            // Without an early end, the loop is spread over vectors.
            Self::Float(values) => {
                let values = values[..rows].iter();
                values.fold(true, |all, value| all & value.is_finite())
            }
            _ => true,
        }
    }

    fn visit<V: Visitor>(&self, axis: usize, row: usize, visitor: &mut V) -> Result<(), Stop> {
        with_values!(self, values => visitor.visit(axis, values[row]))
    }

    fn visit_run<V: Visitor>(
        &self,
        axis: usize,
        rows: usize,
        visitor: &mut V,
    ) -> Result<(), (usize, Stop)> {
        with_values!(self, values => visitor.visit_run(axis, &values[..rows]))
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
        let mut runs: Vec<Run> = axes.iter().map(|axis| Run::of(numbers(axis))).collect();
        progress.set_length(self.rows as u64);
        for first in (0..self.rows).step_by(RUN) {
            if progress.is_finished() {
                return Err(Failure::interrupted());
            }
            progress.set_position(first as u64);
            let rows = RUN.min(self.rows - first);
            for (run, axis) in runs.iter_mut().zip(axes) {
                run.read(numbers(axis), first, rows);
            }
            let place = |row: usize| Place::row(&self.path, (first + row) as u64 + 1);
            // A row whose values are not all numbers has to be seen as a row.
            if V::BY_ROWS || !runs.iter().all(|run| run.are_numbers(rows)) {
                for row in 0..rows {
                    for (i, run) in runs.iter().enumerate() {
                        let Err(stop) = run.visit(i, row, visitor) else {
                            continue;
                        };
                        if !after_stop(visitor, (i, &stop), axes, || place(row))? {
                            return Ok(Ended::NotCounts);
                        }
                        break;
                    }
                }
                continue;
            }
            for (i, run) in runs.iter().enumerate() {
                if let Err((row, stop)) = run.visit_run(i, rows, visitor) {
                    after_stop(visitor, (i, &stop), axes, || place(row))?;
                    return Ok(Ended::NotCounts);
                }
            }
        }
        Ok(Ended::AtTheLastRow)
    }
}
