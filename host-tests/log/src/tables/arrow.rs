//! Parquet and Arrow files, by the crates of the Arrow project.

use super::{arrow_rows::Rows, wrong::Wrong};
use crate::{converted::Text, source::TableKind as Kind, values::Layout};
use ::arrow::{
    array::RecordBatch,
    compute::cast,
    datatypes::{DataType, TimeUnit},
    error::ArrowError,
    ipc::reader::{FileReader, StreamReader},
};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::{
    fs::File,
    io::{BufReader, Read as _, Seek as _},
    path::Path,
};

/// Rewrites the columns of numbers and stamps; those of a structure are named `STRUCTURE.FIELD`.
pub(super) fn convert(
    path: &Path,
    kind: Kind,
    topic: Option<&str>,
    (text, values): (&mut Text, Option<Text>),
) -> Result<Option<Layout>, Wrong> {
    if topic.is_some() {
        return Err(Wrong::unfit(
            "this kind of log has no topics",
            "omit --topic",
        ));
    }
    let mut file = File::open(path)?;
    let mut start = [0; 6];
    file.read_exact(&mut start)?;
    file.rewind()?;
    let batches: Box<dyn Iterator<Item = Result<RecordBatch, ArrowError>>> = match kind {
        Kind::Parquet => {
            let reader = ParquetRecordBatchReaderBuilder::try_new(file);
            Box::new(
                reader
                    .and_then(|reader| reader.build())
                    .map_err(Wrong::damaged)?,
            )
        }
        _ if start == *b"ARROW1" => {
            Box::new(FileReader::try_new(BufReader::new(file), None).map_err(Wrong::damaged)?)
        }
        _ => Box::new(StreamReader::try_new(BufReader::new(file), None).map_err(Wrong::damaged)?),
    };
    let mut rows = Rows::new(text, values, true);
    for batch in batches {
        let batch = columns(&batch.map_err(Wrong::damaged)?).map_err(Wrong::damaged)?;
        if batch.num_columns() == 0 {
            return Err(Wrong::unfit(
                "no column of numbers",
                "keep each axis in a column of its own, and write the table again",
            ));
        }
        rows.push(batch)?;
    }
    match rows.count() {
        0 => Err(Wrong::unfit("no rows", "record some samples")),
        _ => rows.finish(),
    }
}

/// The columns that a text has room for, with stamps and times of day in nanoseconds and without time zones.
fn columns(batch: &RecordBatch) -> Result<RecordBatch, ArrowError> {
    let batch = batch.normalize(".", None)?;
    let schema = batch.schema();
    let mut kept = Vec::new();
    for (field, column) in schema.fields().iter().zip(batch.columns()) {
        let mut name = field.name().clone();
        // A dictionary and runs are ways of storing values, which are columns as any others.
        let column = match field.data_type() {
            DataType::Dictionary(_, values) => &cast(column, values)?,
            DataType::RunEndEncoded(_, values) => &cast(column, values.data_type())?,
            _ => column,
        };
        match column.data_type() {
            DataType::Timestamp(_, _) => {
                kept.push((
                    name,
                    cast(column, &DataType::Timestamp(TimeUnit::Nanosecond, None))?,
                ));
            }
            DataType::Time32(_) | DataType::Time64(_) => {
                kept.push((name, cast(column, &DataType::Time64(TimeUnit::Nanosecond))?));
            }
            DataType::Duration(unit) => {
                if !name.contains('[') {
                    name += match unit {
                        TimeUnit::Second => " [s]",
                        TimeUnit::Millisecond => " [ms]",
                        TimeUnit::Microsecond => " [us]",
                        TimeUnit::Nanosecond => " [ns]",
                    };
                }
                kept.push((name, cast(column, &DataType::Int64)?));
            }
            // The shortest text of a short float reads back as another long one.
            DataType::Float16 | DataType::Float32 => {
                kept.push((name, cast(column, &DataType::Float64)?));
            }
            DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => {
                kept.push((name, column.clone()));
            }
            kind if kind.is_numeric() => kept.push((name, column.clone())),
            _ => {}
        }
    }
    if kept.is_empty() {
        return Ok(RecordBatch::new_empty(
            ::arrow::datatypes::Schema::empty().into(),
        ));
    }
    RecordBatch::try_from_iter_with_nullable(
        kept.into_iter().map(|(name, array)| (name, array, true)),
    )
}
