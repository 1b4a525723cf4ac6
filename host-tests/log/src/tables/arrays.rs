//! Named arrays as columns of a table: what MATLAB and HDF5 have in common.

use super::{
    choice::{Candidate, choose},
    wrong::Wrong,
};
use crate::converted::Text;
use std::{collections::BTreeMap, io::Write as _};

/// More columns are refused by the reader of text, and would make the text long.
const MOST_COLUMNS: usize = 256;

/// The values of an array, in the order of the file.
pub(super) enum Values {
    Signed(Vec<i64>),
    Unsigned(Vec<u64>),
    Float(Vec<f64>),
}

impl Values {
    fn write(&self, at: usize, text: &mut Text) -> std::io::Result<()> {
        match self {
            Self::Signed(values) => write!(text, "{}", values[at]),
            Self::Unsigned(values) => write!(text, "{}", values[at]),
            Self::Float(values) => write!(text, "{}", values[at]),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Signed(values) => values.len(),
            Self::Unsigned(values) => values.len(),
            Self::Float(values) => values.len(),
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
    text: &mut Text,
) -> Result<Option<String>, Wrong> {
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
        return Ok(note);
    };
    // The columns of a lone matrix have no names of their own.
    let has_names = table.len() > 1 || matches!(table[0].columns, 1 | 3);
    if has_names {
        let names: Vec<String> = table.iter().flat_map(Array::names).collect();
        text.names(&names)?;
    }
    for row in 0..rows {
        let mut separator = "";
        for array in &table {
            for column in 0..array.columns {
                text.write_all(separator.as_bytes())?;
                separator = ",";
                array.values.write(array.at(row, column), text)?;
            }
        }
        text.write_all(b"\n")?;
    }
    Ok(note)
}
