//! Reads rows with all rules for quotes. It takes over where [`Lines`](super::lines::Lines) stops.

use csv::{ByteRecord, ErrorKind, Reader, ReaderBuilder};
use std::{
    cell::Cell,
    io::{self, Read},
    rc::Rc,
};

/// The most bytes that may be read for one row, those in the reader's own buffer included. Without this
/// limit, a quote that is never closed would make one row of the rest of the file. Chosen by hand.
pub(super) const LONGEST_ROW: usize = 1 << 20;

/// Reads one row after the other. Empty lines are skipped, and a comment is a row that begins
/// with `#`.
pub(super) struct Records<R> {
    reader: Reader<Limited<R>>,
    /// The number of bytes that may still be read before the row ends.
    budget: Rc<Cell<usize>>,
    /// The offset in the whole text at which this text begins.
    offset: u64,
    record: ByteRecord,
}

impl<R: Read> Records<R> {
    /// Reads a text whose first byte has the given offset.
    pub(super) fn new(text: R, offset: u64, delimiter: u8) -> Self {
        let budget = Rc::new(Cell::new(LONGEST_ROW));
        let text = Limited {
            text,
            budget: budget.clone(),
        };
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
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

    /// Reads the next row. Returns false at the end. A row that is too long is the error
    /// [`FileTooLarge`](io::ErrorKind::FileTooLarge). An error comes with the offset of the first
    /// byte that has not been read.
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

    /// The current row.
    pub(super) const fn row(&self) -> &ByteRecord {
        &self.record
    }

    /// The offset in the text at which the search for the current row began.
    pub(super) fn row_offset(&self) -> u64 {
        self.offset + self.record.position().map_or(0, |position| position.byte())
    }

    /// The offset in the text of the first byte that has not been read.
    pub(super) fn rest_offset(&self) -> u64 {
        self.offset + self.reader.position().byte()
    }
}

/// A text that fails when its budget is used up.
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
