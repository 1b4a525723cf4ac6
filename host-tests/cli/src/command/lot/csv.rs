//! The table of a lot as CSV.

use super::table::{Column, Values};
use crate::command::output::cell::cell;
use std::io::{self, Write};

/// Writes a table. What is not known is an empty field.
pub(super) fn write(columns: &[Column<'_>], output: &mut impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record(columns.iter().map(|column| cell(&column.name)))?;
    let rows = columns.first().map_or(0, |column| column.values.count());
    let mut field = String::new();
    for row in 0..rows {
        for column in columns {
            field.clear();
            column.values.write(row, &mut field);
            writer.write_field(&field)?;
        }
        // This ends the record.
        writer.write_record(None::<&[u8]>)?;
    }
    writer.flush()
}

impl Values<'_> {
    fn count(&self) -> usize {
        match self {
            Self::Text(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Count(values) => values.len(),
        }
    }

    fn write(&self, row: usize, field: &mut String) {
        match self {
            Self::Text(values) => field.push_str(&cell(values[row].as_deref().unwrap_or(""))),
            Self::Number(values) => {
                if let Some(value) = values[row] {
                    field.push_str(ryu::Buffer::new().format(value));
                }
            }
            Self::Count(values) => field.push_str(&values[row].to_string()),
        }
    }
}
