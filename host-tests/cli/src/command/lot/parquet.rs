//! The table of a lot as Parquet.

use super::table::{Column, Values};
use ::arrow::{
    array::{ArrayRef, Float64Array, StringArray, UInt64Array},
    datatypes::{DataType, Field, Schema},
    error::ArrowError,
    record_batch::RecordBatch,
};
use ::parquet::{
    arrow::ArrowWriter,
    basic::{Compression, ZstdLevel},
    errors::ParquetError,
    file::properties::WriterProperties,
};
use std::{
    io::{self, Write},
    sync::Arc,
};

/// Writes a table. What is not known is null.
pub(super) fn write(columns: Vec<Column<'_>>, output: impl Write + Send) -> io::Result<()> {
    write_batch(&batch(columns).map_err(io::Error::other)?, output).map_err(io::Error::other)
}

fn batch(columns: Vec<Column<'_>>) -> Result<RecordBatch, ArrowError> {
    let (mut fields, mut arrays) = (Vec::new(), Vec::<ArrayRef>::new());
    for Column { name, values } in columns {
        let (kind, array): (DataType, ArrayRef) = match values {
            Values::Text(values) => (
                DataType::Utf8,
                Arc::new(values.iter().map(Option::as_deref).collect::<StringArray>()),
            ),
            Values::Number(values) => (DataType::Float64, Arc::new(Float64Array::from(values))),
            Values::Count(values) => (DataType::UInt64, Arc::new(UInt64Array::from(values))),
        };
        let is_counted = kind == DataType::UInt64;
        fields.push(Field::new(name, kind, !is_counted));
        arrays.push(array);
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays)
}

fn write_batch(batch: &RecordBatch, output: impl Write + Send) -> Result<(), ParquetError> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .build();
    let mut writer = ArrowWriter::try_new(output, batch.schema(), Some(properties))?;
    writer.write(batch)?;
    writer.close().map(|_| ())
}
