//! Named arrays as columns of a table: what MATLAB and HDF5 have in common.

use super::{
    arrow_rows::{Rows, Written},
    choice::{Candidate, choose},
    wrong::Wrong,
};
use crate::converted::Text;
use ::arrow::array::{ArrayRef, Float64Array, Int64Array, RecordBatch, UInt64Array};
use std::{collections::BTreeMap, ops::Range, sync::Arc};

/// More columns are refused by the reader of text, and would make the text long.
const MOST_COLUMNS: usize = 256;

/// The number of rows that are copied at once.
const BATCH: usize = 1 << 13;

/// Floats below are whole where they have no fraction; larger ones have none.
const WHOLE: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// The values of an array, in the order of the file.
pub(super) enum Values {
    Signed(Vec<i64>),
    Unsigned(Vec<u64>),
    /// Whole numbers, and NaN where there is none.
    Count(Vec<f64>),
    Float(Vec<f64>),
}

impl Values {
    /// Floats, which are counts if all of them are whole: MATLAB has no other numbers unless it is asked for them.
    pub(super) fn of_floats(values: Vec<f64>) -> Self {
        let mut numbers = values.iter().filter(|value| !value.is_nan()).peekable();
        let is_count = |value: &f64| value.fract() == 0.0 && value.abs() < WHOLE;
        match numbers.peek().is_some() && numbers.all(is_count) {
            true => Self::Count(values),
            false => Self::Float(values),
        }
    }

    /// Every `stride`th value from `first` on, as a column.
    fn column(&self, first: usize, stride: usize, rows: usize) -> ArrayRef {
        fn some<T: Copy>(values: &[T], first: usize, stride: usize, rows: usize) -> Vec<T> {
            let values = values.get(first..).unwrap_or_default();
            values.iter().step_by(stride).take(rows).copied().collect()
        }
        match self {
            Self::Signed(all) => Arc::new(Int64Array::from(some(all, first, stride, rows))),
            Self::Unsigned(all) => Arc::new(UInt64Array::from(some(all, first, stride, rows))),
            Self::Count(all) => {
                let values = some(all, first, stride, rows).into_iter();
                let values = values.map(|value| (!value.is_nan()).then_some(value as i64));
                Arc::new(values.collect::<Int64Array>())
            }
            Self::Float(all) => Arc::new(Float64Array::from(some(all, first, stride, rows))),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Signed(values) => values.len(),
            Self::Unsigned(values) => values.len(),
            Self::Count(values) | Self::Float(values) => values.len(),
        }
    }
}

/// An array of one or two dimensions. Its longer dimension is that of the samples.
pub(super) struct Array {
    /// Where it lies in the file: arrays of the same place and length form a table.
    pub(super) place: String,
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    /// How many values further the next sample of a column lies; the next column is one further, or all samples.
    pub(super) stride: usize,
    pub(super) values: Values,
}

impl Array {
    /// An array whose values change fastest along its first dimension, or along its last.
    pub(super) fn new(
        place: String,
        name: String,
        shape: &[usize],
        first_is_fastest: bool,
        values: Values,
    ) -> Option<Self> {
        let shape: Vec<usize> = shape
            .iter()
            .copied()
            .filter(|&length| length != 1)
            .collect();
        let (rows, columns, stride) = match shape[..] {
            [rows] => (rows, 1, 1),
            [first, second] => {
                let (fast, slow) = if first_is_fastest {
                    (first, second)
                } else {
                    (second, first)
                };
                if fast > slow {
                    (fast, slow, 1)
                } else {
                    (slow, fast, fast)
                }
            }
            _ => return None,
        };
        let is_whole = rows.checked_mul(columns) == Some(values.len());
        (is_whole && columns <= MOST_COLUMNS).then_some(Self {
            place,
            name,
            rows,
            columns,
            stride,
            values,
        })
    }

    fn at(&self, row: usize, column: usize) -> usize {
        let next = if self.stride == 1 { self.rows } else { 1 };
        row * self.stride + column * next
    }

    /// Some rows of all columns.
    fn columns(&self, rows: Range<usize>) -> impl Iterator<Item = ArrayRef> {
        (0..self.columns).map(move |column| {
            let first = self.at(rows.start, column);
            self.values.column(first, self.stride, rows.len())
        })
    }

    fn names(&self) -> impl Iterator<Item = String> {
        (0..self.columns).map(|column| match self.columns {
            1 => self.name.clone(),
            3 => format!("{}_{}", self.name, ["x", "y", "z"][column]),
            _ => format!("{}_{}", self.name, column + 1),
        })
    }
}

/// Writes the table of arrays that is asked for, or else the longest one.
pub(super) fn write(
    arrays: Vec<Array>,
    topic: Option<&str>,
    (text, values): (&mut Text, Option<Text>),
) -> Result<Written, Wrong> {
    let mut tables: BTreeMap<(String, usize), Vec<Array>> = BTreeMap::new();
    for array in arrays {
        let table = tables.entry((array.place.clone(), array.rows)).or_default();
        table.push(array);
    }
    let name = |place: &str, table: &[Array]| match (place, table) {
        (_, [only]) => only.name.clone(),
        ("", _) => "/".to_owned(),
        (place, _) => place.to_owned(),
    };
    let candidates: Vec<Candidate> = tables
        .iter()
        .filter(|((_, rows), _)| *rows > 1)
        .map(|((place, rows), table)| Candidate {
            name: name(place, table),
            rows: *rows as u64,
        })
        .collect();
    let (chosen, note) = choose(&candidates, topic, "table")?;
    let mut tables = tables.into_iter().filter(|((_, rows), _)| *rows > 1);
    let Some(((_, rows), table)) = tables.nth(chosen) else {
        return Ok((note, None));
    };
    // The columns of a lone matrix have no names of their own.
    let has_names = table.len() > 1 || matches!(table[0].columns, 1 | 3);
    let names: Vec<String> = table.iter().flat_map(Array::names).collect();
    let mut written = Rows::new(text, values, has_names);
    for first in (0..rows).step_by(BATCH) {
        let some = first..rows.min(first + BATCH);
        let columns = table.iter().flat_map(|array| array.columns(some.clone()));
        let columns = names.iter().zip(columns);
        written.push(RecordBatch::try_from_iter(columns).map_err(Wrong::damaged)?)?;
    }
    Ok((note, written.finish()?))
}
