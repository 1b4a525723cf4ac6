//! Tables of Arrow as columns of the host library.

use allanite_log::{Column, Fill, Numbers};
use arrow::{
    array::{Array, ArrayRef, ArrowPrimitiveType, AsArray, PrimitiveArray, RecordBatch},
    datatypes::{
        DataType, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, Schema,
        TimeUnit, TimestampMicrosecondType, TimestampMillisecondType, TimestampNanosecondType,
        TimestampSecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
    },
    ffi_stream::RecordBatchStreamReader,
};
use arrow_pyarrow::FromPyArrow;
use pyo3::prelude::*;

/// The record batches that an object exports through `__arrow_c_stream__`.
pub(crate) struct Batches {
    schema: std::sync::Arc<Schema>,
    batches: Vec<RecordBatch>,
}

impl Batches {
    /// Takes all batches. Their buffers stay those of the producer.
    pub(crate) fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let reader = RecordBatchStreamReader::from_pyarrow_bound(object)?;
        let schema = arrow::array::RecordBatchReader::schema(&reader);
        let batches = reader.collect::<Result<Vec<_>, _>>();
        let wrong = |error: arrow::error::ArrowError| {
            pyo3::exceptions::PyValueError::new_err(error.to_string())
        };
        Ok(Self {
            schema,
            batches: batches.map_err(wrong)?,
        })
    }

    pub(crate) fn rows(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// The columns of numbers and of time stamps. Others are no axes, and are left out.
    pub(crate) fn columns(&self) -> Vec<Column<'static>> {
        let fields = self.schema.fields().iter().enumerate();
        let column = |(at, field): (usize, &std::sync::Arc<arrow::datatypes::Field>)| {
            let chunks = self.batches.iter().map(|batch| batch.column(at).clone());
            let chunks: Vec<ArrayRef> = chunks.collect();
            let numbers = numbers(field.data_type(), &chunks)?;
            // The readers of logs know the unit of stamps by the name of their column.
            let name = match field.data_type() {
                DataType::Timestamp(..) => format!("{} [ns]", field.name()),
                _ => field.name().clone(),
            };
            Some(Column { name, numbers })
        };
        fields.filter_map(column).collect()
    }
}

fn numbers(kind: &DataType, chunks: &[ArrayRef]) -> Option<Numbers<'static>> {
    /// Integers are exact unless a value is missing, which only a float can say.
    macro_rules! integers {
        ($type:ty, $numbers:ident($wide:ty), $float:expr) => {
            match chunks.iter().all(|chunk| chunk.null_count() == 0) {
                true => Numbers::$numbers(copy::<$type, $wide>(chunks, |value| {
                    value.map_or(0, <$wide>::from)
                })),
                false => Numbers::Float(copy::<$type, f64>(chunks, |value| {
                    value.map_or(f64::NAN, $float)
                })),
            }
        };
    }
    macro_rules! stamps {
        ($type:ty, $nanoseconds:expr) => {
            Numbers::Int64(copy::<$type, i64>(chunks, |value| {
                value.unwrap_or(0).saturating_mul($nanoseconds)
            }))
        };
    }
    let or_nothing = |value: Option<f64>| value.unwrap_or(f64::NAN);
    Some(match kind {
        DataType::Int8 => integers!(Int8Type, Int32(i32), f64::from),
        DataType::Int16 => integers!(Int16Type, Int32(i32), f64::from),
        DataType::Int32 => integers!(Int32Type, Int32(i32), f64::from),
        DataType::Int64 => integers!(Int64Type, Int64(i64), |value| value as f64),
        DataType::UInt8 => integers!(UInt8Type, Int32(i32), f64::from),
        DataType::UInt16 => integers!(UInt16Type, Int32(i32), f64::from),
        DataType::UInt32 => integers!(UInt32Type, Int64(i64), f64::from),
        DataType::UInt64 => integers!(UInt64Type, Uint64(u64), |value| value as f64),
        DataType::Float32 => Numbers::Float(copy::<Float32Type, f64>(chunks, move |value| {
            or_nothing(value.map(f64::from))
        })),
        DataType::Float64 => Numbers::Float(copy::<Float64Type, f64>(chunks, or_nothing)),
        DataType::Timestamp(TimeUnit::Second, _) => stamps!(TimestampSecondType, 1_000_000_000),
        DataType::Timestamp(TimeUnit::Millisecond, _) => {
            stamps!(TimestampMillisecondType, 1_000_000)
        }
        DataType::Timestamp(TimeUnit::Microsecond, _) => stamps!(TimestampMicrosecondType, 1_000),
        DataType::Timestamp(TimeUnit::Nanosecond, _) => stamps!(TimestampNanosecondType, 1),
        _ => return None,
    })
}

/// Copies a run of a column that lies in chunks.
fn copy<T, U>(
    chunks: &[ArrayRef],
    convert: impl Fn(Option<T::Native>) -> U + Send + Sync + 'static,
) -> Fill<'static, U>
where
    T: ArrowPrimitiveType,
{
    let mut start = 0;
    let chunks: Vec<(usize, PrimitiveArray<T>)> = chunks
        .iter()
        .map(|chunk| {
            let from = start;
            start += chunk.len();
            (from, chunk.as_primitive::<T>().clone())
        })
        .collect();
    Box::new(move |first, to| {
        let at = chunks.partition_point(|(start, chunk)| start + chunk.len() <= first);
        let mut to = to.iter_mut();
        for (start, chunk) in chunks.iter().skip(at) {
            let skipped = first.saturating_sub(*start).min(chunk.len());
            let rows = chunk.len() - skipped;
            if chunk.null_count() == 0 {
                let values = chunk.values().iter().skip(skipped);
                for (to, value) in to.by_ref().take(rows).zip(values) {
                    *to = convert(Some(*value));
                }
            } else {
                for (to, value) in to.by_ref().take(rows).zip(chunk.iter().skip(skipped)) {
                    *to = convert(value);
                }
            }
            if to.len() == 0 {
                break;
            }
        }
    })
}
