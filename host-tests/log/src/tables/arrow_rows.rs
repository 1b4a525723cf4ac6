//! Writes rows, in batches of Arrow's columns: all of them as text if they are few. Otherwise their numbers are written in binary, and
//! as text only what tells the columns from each other: the first rows, the last ones, and those at which something changes that
//! was the same in all of the first ones, because the rows of another sensor may begin there.

use super::wrong::Wrong;
use crate::{
    converted::Text,
    values::{Kind, Layout, NumberWriter},
};
use ::arrow::{
    array::{Array, ArrayRef, AsArray as _, RecordBatch, Scalar},
    compute::kernels::cmp::distinct,
    csv::{Writer, WriterBuilder},
    datatypes::{
        DataType, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, Time64NanosecondType,
        TimestampNanosecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
    },
    error::ArrowError,
};
use std::{collections::VecDeque, ops::Range};

/// The format of stamps, as dates with nanoseconds.
const STAMPS: &str = "%Y-%m-%dT%H:%M:%S%.9f";

/// The format of times of day, with nanoseconds.
const TIMES: &str = "%H:%M:%S%.9f";

/// The rows at the beginning and at the end that are written as text. The reader looks at fewer.
const FIRST: usize = 1 << 13;
const LAST: usize = 1 << 11;

/// What was written of a table: a note about it, and what the file of its numbers holds, if there is one.
pub(super) type Written = (Option<String>, Option<Layout>);

/// The rows of a table.
pub(super) struct Rows<'a> {
    text: Writer<&'a mut Text>,
    /// The numbers in binary, unless all is to be text.
    values: Option<Binary>,
    /// Where they are written.
    binary: Option<Text>,
    /// The number of rows so far.
    count: usize,
}

/// The numbers in binary, and the rows that are not yet text.
struct Binary {
    values: NumberWriter<Text>,
    /// The columns that the file holds.
    columns: Vec<usize>,
    /// The last batches, with the number of the first row of each.
    last: VecDeque<(usize, RecordBatch)>,
    /// The number of rows from the first one on that are text or need not be.
    written: usize,
    /// The first value of each column that is the same in all rows so far.
    constant: Vec<Option<ArrayRef>>,
}

impl<'a> Rows<'a> {
    /// Text and numbers to these files; the text begins with the names of the columns if they have any.
    pub(super) fn new(text: &'a mut Text, values: Option<Text>, has_names: bool) -> Self {
        let builder = WriterBuilder::new()
            .with_header(has_names)
            .with_timestamp_format(STAMPS.into())
            .with_time_format(TIMES.into());
        Self {
            text: builder.build(text),
            values: None,
            binary: values,
            count: 0,
        }
    }

    /// The number of rows so far.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn push(&mut self, batch: RecordBatch) -> Result<(), Wrong> {
        if let Some(out) = self.binary.take() {
            self.values = Some(Binary::new(&batch, out));
        }
        let first = self.count;
        self.count += batch.num_rows();
        let Some(binary) = &mut self.values else {
            return write(&mut self.text, &batch);
        };
        binary.push_values(&batch)?;
        let head = FIRST.saturating_sub(first).min(batch.num_rows());
        if head > 0 {
            write(&mut self.text, &batch.slice(0, head))?;
            binary.written = first + head;
        }
        let changes = binary.changes(first, &batch);
        binary.last.push_back((first, batch));
        for change in changes {
            binary.write(&mut self.text, change - 1..change + 1)?;
        }
        while binary
            .last
            .iter()
            .skip(1)
            .map(|(_, batch)| batch.num_rows())
            .sum::<usize>()
            > LAST
        {
            binary.last.pop_front();
        }
        Ok(())
    }

    /// Writes what is left, and returns what the file of numbers holds, unless all is text.
    pub(super) fn finish(mut self) -> Result<Option<Layout>, Wrong> {
        let Some(mut binary) = self.values else {
            return Ok(None);
        };
        binary.write(&mut self.text, self.count.saturating_sub(LAST)..self.count)?;
        Ok(match self.count > FIRST {
            true => Some(binary.values.finish()?),
            false => None,
        })
    }
}

fn write(text: &mut Writer<&mut Text>, batch: &RecordBatch) -> Result<(), Wrong> {
    text.write(batch).map_err(|error| match error {
        ArrowError::IoError(_, error) => Wrong::Io(error),
        error => Wrong::damaged(error),
    })
}

impl Binary {
    fn new(batch: &RecordBatch, out: Text) -> Self {
        let kinds: Vec<Option<Kind>> = batch
            .columns()
            .iter()
            .map(|column| kind(column.data_type()))
            .collect();
        let columns = kinds.iter().enumerate().filter(|(_, kind)| kind.is_some());
        Self {
            columns: columns.map(|(column, _)| column).collect(),
            values: NumberWriter::new(kinds, out),
            last: VecDeque::new(),
            written: 0,
            constant: batch
                .columns()
                .iter()
                .map(|column| (!column.is_empty()).then(|| column.slice(0, 1)))
                .collect(),
        }
    }

    fn push_values(&mut self, batch: &RecordBatch) -> Result<(), Wrong> {
        let columns = &self.columns;
        let append =
            |place: usize, rows: Range<usize>, bytes: &mut Vec<u8>, missing: &mut Vec<u8>| {
                let column = batch.column(columns[place]).slice(rows.start, rows.len());
                append(&column, bytes);
                match column.nulls() {
                    Some(nulls) => missing.extend(nulls.iter().map(|valid| u8::from(!valid))),
                    None => missing.resize(missing.len() + rows.len(), 0),
                }
            };
        Ok(self.values.push(batch.num_rows(), append)?)
    }

    /// The rows behind the first ones at which a column changes that was the same in all rows before.
    fn changes(&mut self, first: usize, batch: &RecordBatch) -> Vec<usize> {
        let mut changes = Vec::new();
        for (constant, column) in self.constant.iter_mut().zip(batch.columns()) {
            let Some(value) = constant else { continue };
            if let Some(row) = first_other(value, column) {
                *constant = None;
                changes.extend((first + row >= FIRST).then_some(first + row));
            }
        }
        changes.sort_unstable();
        changes.dedup();
        changes
    }

    /// Writes rows as text that are none yet, in their order.
    fn write(&mut self, text: &mut Writer<&mut Text>, rows: Range<usize>) -> Result<(), Wrong> {
        let rows = rows.start.max(self.written)..rows.end;
        for (first, batch) in &self.last {
            let start = rows.start.max(*first);
            let end = rows.end.min(first + batch.num_rows());
            if start < end {
                write(text, &batch.slice(start - first, end - start))?;
            }
        }
        self.written = self.written.max(rows.end);
        Ok(())
    }
}

/// The first row whose value is not this one.
fn first_other(value: &ArrayRef, column: &ArrayRef) -> Option<usize> {
    let others = distinct(column, &Scalar::new(value)).ok()?;
    others.values().set_indices().next()
}

/// What the values of a column are in binary.
fn kind(column: &DataType) -> Option<Kind> {
    match column {
        DataType::Int8 | DataType::Int16 | DataType::Int32 | DataType::UInt8 | DataType::UInt16 => {
            Some(Kind::Int32)
        }
        DataType::UInt32 | DataType::Int64 => Some(Kind::Int64),
        DataType::UInt64 => Some(Kind::Uint64),
        DataType::Float64 => Some(Kind::Float),
        DataType::Timestamp(..) | DataType::Time64(_) => Some(Kind::Date),
        _ => None,
    }
}

/// Adds the values of a column.
fn append(column: &ArrayRef, bytes: &mut Vec<u8>) {
    macro_rules! values {
        ($type:ty as $written:ty) => {{
            let values = column.as_primitive::<$type>().values().iter();
            bytes.extend(values.flat_map(|&value| <$written>::from(value).to_ne_bytes()));
        }};
    }
    match column.data_type() {
        DataType::Int8 => values!(Int8Type as i32),
        DataType::Int16 => values!(Int16Type as i32),
        DataType::Int32 => values!(Int32Type as i32),
        DataType::UInt8 => values!(UInt8Type as i32),
        DataType::UInt16 => values!(UInt16Type as i32),
        DataType::UInt32 => values!(UInt32Type as i64),
        DataType::Int64 => values!(Int64Type as i64),
        DataType::UInt64 => values!(UInt64Type as u64),
        DataType::Float64 => values!(Float64Type as f64),
        DataType::Timestamp(..) => values!(TimestampNanosecondType as i64),
        DataType::Time64(_) => values!(Time64NanosecondType as i64),
        _ => {}
    }
}
