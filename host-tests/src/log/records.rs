//! Rows by all rules of quoting: what [`Lines`](super::lines::Lines) leaves.

use csv::{ByteRecord, ErrorKind, Reader, ReaderBuilder};
use std::{
    cell::Cell,
    io::{self, Read},
    rc::Rc,
};

/// Bytes that may be read for one row, the reader's own buffer included. A quote that is never
/// closed would make one row of all the rest.
pub(super) const LONGEST_ROW: usize = 1 << 20;

/// Reads one row after the other. Empty lines and comments are passed over.
pub(super) struct Records<R> {
    reader: Reader<Limited<R>>,
    /// What may still be read until the row ends.
    budget: Rc<Cell<usize>>,
    /// Where in the whole text this one begins.
    offset: u64,
    record: ByteRecord,
}

impl<R: Read> Records<R> {
    /// Text whose first byte has the given offset.
    pub(super) fn new(text: R, offset: u64, delimiter: u8) -> Self {
        let budget = Rc::new(Cell::new(LONGEST_ROW));
        let text = Limited {
            text,
            budget: budget.clone(),
        };
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .delimiter(delimiter)
            .buffer_capacity(1 << 16)
            .from_reader(text);
        Self {
            reader,
            budget,
            offset,
            record: ByteRecord::new(),
        }
    }

    /// Reads the next row; false at the end. A row that is too long is
    /// [`FileTooLarge`](io::ErrorKind::FileTooLarge). Failures come with the offset of what has not
    /// been read.
    pub(super) fn read(&mut self) -> Result<bool, (u64, io::Error)> {
        let rest = self.rest_offset();
        self.budget.set(LONGEST_ROW);
        self.reader
            .read_byte_record(&mut self.record)
            .map_err(|error| {
                let error = match error.into_kind() {
                    ErrorKind::Io(error) => error,
                    kind => io::Error::other(format!("{kind:?}")),
                };
                (rest, error)
            })
    }

    /// The row.
    pub(super) const fn row(&self) -> &ByteRecord {
        &self.record
    }

    /// Where in the text begins what the row was looked for in.
    pub(super) fn row_offset(&self) -> u64 {
        self.offset + self.record.position().map_or(0, |position| position.byte())
    }

    /// Where in the text begins what has not been read.
    pub(super) fn rest_offset(&self) -> u64 {
        self.offset + self.reader.position().byte()
    }
}

/// Text that fails when its budget is used up.
struct Limited<R> {
    text: R,
    budget: Rc<Cell<usize>>,
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let budget = self.budget.get();
        if budget == 0 {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let length = buffer.len().min(budget);
        let read = self.text.read(&mut buffer[..length])?;
        self.budget.set(budget - read);
        Ok(read)
    }
}
