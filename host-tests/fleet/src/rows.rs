//! The rows of a batch of the engine, as its columns lie in memory.

use crate::{
    arguments::{Argument, counts},
    axis::Axis,
    failure::refused,
};
use datafusion::{
    arrow::{
        array::{
            Array, ArrayRef, AsArray, BinaryArray, Int32Array, Int64Array, ListArray,
            PrimitiveArray,
        },
        datatypes::{DataType, Float64Type, Int32Type, Int64Type},
    },
    error::{DataFusionError, Result},
};

/// What a row of the input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Rows {
    /// The number of a first sample, and a list of counts.
    Batches,
    /// The number of a sample, and its count.
    Samples,
    /// A state.
    States,
}

impl Rows {
    /// The columns of a row.
    pub(crate) fn columns(self) -> Vec<Argument> {
        let (first, second) = match self {
            Self::Batches => (("start", DataType::Int64), ("counts", counts())),
            Self::Samples => (("number", DataType::Int64), ("count", DataType::Int32)),
            Self::States => return vec![("state", DataType::Binary)],
        };
        let of_sensor = ["rate", "scale"].map(|name| (name, DataType::Float64));
        [vec![first, second], of_sensor.to_vec()].concat()
    }
}

/// The columns of a batch, of the types that [`Rows`] has.
pub(crate) enum Columns<'a> {
    /// See [`Rows::Batches`].
    Batches(Numbered<'a>, &'a ListArray),
    /// See [`Rows::Samples`].
    Samples(Numbered<'a>, &'a Int32Array),
    /// See [`Rows::States`].
    States(&'a BinaryArray),
}

/// The columns of a row that is not a state.
pub(crate) struct Numbered<'a> {
    number: &'a Int64Array,
    rate: &'a PrimitiveArray<Float64Type>,
    scale: &'a PrimitiveArray<Float64Type>,
}

impl<'a> Columns<'a> {
    /// # Errors
    /// When the engine gives other columns than it was asked for.
    pub(crate) fn of(rows: Rows, columns: &'a [ArrayRef]) -> Result<Self> {
        let other = || DataFusionError::Internal("columns of another type".to_owned());
        if let (Rows::States, [state]) = (rows, columns) {
            return Ok(Self::States(state.as_binary_opt().ok_or_else(other)?));
        }
        let [number, second, rate, scale] = columns else {
            return Err(other());
        };
        let numbered = Numbered {
            number: number.as_primitive_opt::<Int64Type>().ok_or_else(other)?,
            rate: rate.as_primitive_opt().ok_or_else(other)?,
            scale: scale.as_primitive_opt().ok_or_else(other)?,
        };
        Ok(match rows {
            Rows::Batches => Self::Batches(numbered, second.as_list_opt().ok_or_else(other)?),
            _ => Self::Samples(
                numbered,
                second.as_primitive_opt::<Int32Type>().ok_or_else(other)?,
            ),
        })
    }

    /// Adds a row to the state of its axis.
    pub(crate) fn add(&self, row: usize, axis: &mut Option<Axis>) -> Result<()> {
        match self {
            Self::Batches(numbered, counts) => {
                if counts.is_valid(row) {
                    let (first, axis) = numbered.of(row, axis)?;
                    let counts = counts.value(row);
                    push(axis, first, counts.as_primitive::<Int32Type>())?;
                }
            }
            Self::Samples(numbered, counts) => {
                if counts.is_valid(row) {
                    let (number, axis) = numbered.of(row, axis)?;
                    axis.push(number, &[counts.value(row)])?;
                }
            }
            Self::States(states) => {
                if states.is_valid(row) {
                    let other = Axis::from_bytes(states.value(row))?;
                    match axis {
                        Some(axis) => axis.merge(other)?,
                        None => *axis = Some(other),
                    }
                }
            }
        }
        Ok(())
    }
}

impl Numbered<'_> {
    /// The number of a row, and its axis, which begins with the first row.
    fn of<'s>(&self, row: usize, axis: &'s mut Option<Axis>) -> Result<(u64, &'s mut Axis)> {
        if self.number.is_null(row) || self.rate.is_null(row) || self.scale.is_null(row) {
            return Err(refused(
                "a row has no number, rate or scale",
                "leave such rows out",
            ));
        }
        let (rate, scale) = (self.rate.value(row), self.scale.value(row));
        let number = self.number.value(row);
        let first = u64::try_from(number).map_err(|_| {
            refused(
                format_args!("sample {number} has a negative number"),
                "count the samples of a record from its first one on",
            )
        })?;
        let axis = match axis {
            Some(axis) => {
                axis.is_of(rate, scale)?;
                axis
            }
            None => axis.insert(Axis::new(rate, scale)?),
        };
        Ok((first, axis))
    }
}

/// Adds counts. A missing one is a lost sample.
fn push(axis: &mut Axis, first: u64, counts: &Int32Array) -> Result<()> {
    if counts.null_count() == 0 {
        return axis.push(first, counts.values());
    }
    let present = counts.iter().zip(first..);
    let present = present.filter_map(|(count, number)| Some((number, count?)));
    let (numbers, counts): (Vec<u64>, Vec<i32>) = present.unzip();
    axis.push_numbered(&numbers, &counts)
}
