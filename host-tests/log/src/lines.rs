//! Cuts rows without quotes, which are nearly all rows of a log, at delimiters and line ends.

use std::{
    io::{self, Cursor, Read},
    ops::Range,
};

/// The size of the buffer, in bytes. A longer line is left to [`Records`](super::records::Records).
const BUFFER: usize = 1 << 17;

/// The number of bytes that are examined at once.
const WORD: usize = size_of::<u64>();

/// A word in which every byte is one.
const ONES: u64 = u64::MAX / 255;

/// What was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    Row,
    Comment,
    /// Nothing: the general rules have to go on, as they do at the end.
    Rest,
}

/// Cuts text into rows with a known number of fields. It stops at the first row that needs the
/// rules for quotes, and hands over what is left. Empty lines are skipped.
pub(super) struct Lines<R> {
    text: R,
    delimiter: u8,
    /// The bytes that end a field or that only the general rules can handle, each repeated in all
    /// eight bytes of a word.
    special: [u64; 4],
    /// The buffer has one word more than is ever read into it, so that a word can be loaded at
    /// every byte.
    buffer: Box<[u8]>,
    /// The offset in the text at which the buffer begins.
    offset: u64,
    /// The part of the buffer that has been read and not been cut.
    uncut: Range<usize>,
    /// The end of the last whole line in the buffer.
    whole: usize,
    /// The beginning of the current row in the buffer.
    row: usize,
    fields: Box<[Range<usize>]>,
}

impl<R: Read> Lines<R> {
    /// Cuts a text whose first byte has the given offset.
    pub(super) fn new(text: R, offset: u64, delimiter: u8, width: usize) -> Self {
        Self {
            text,
            delimiter,
            special: [delimiter, b'\n', b'\r', b'"'].map(|byte| u64::from(byte) * ONES),
            buffer: vec![0; BUFFER + WORD].into(),
            offset,
            uncut: 0..0,
            whole: 0,
            row: 0,
            fields: vec![0..0; width].into(),
        }
    }

    /// Cuts the next row or comment.
    pub(super) fn cut(&mut self) -> io::Result<Cut> {
        loop {
            if self.uncut.start == self.whole && !self.refill()? {
                return Ok(Cut::Rest);
            }
            let row = self.uncut.start;
            if self.buffer[row] == b'#' {
                // A whole line follows, so its end is in the buffer.
                let rest = &self.buffer[row..self.whole];
                let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(0);
                self.row = row;
                self.uncut.start += length + 1;
                return Ok(Cut::Comment);
            }
            match self.cut_fields(row) {
                Some((0, end)) => self.uncut.start = end,
                Some((fields, end)) if fields == self.fields.len() => {
                    self.row = row;
                    self.uncut.start = end;
                    return Ok(Cut::Row);
                }
                _ => return Ok(Cut::Rest),
            }
        }
    }

    /// The number of fields in the line, 0 if it is empty, and the position of the next line.
    /// Returns `None` for a line with quotes or with more fields than expected.
    #[inline]
    fn cut_fields(&mut self, row: usize) -> Option<(usize, usize)> {
        let mut start = row;
        let mut i = row;
        let mut count = 0;
        loop {
            i = self.special_from(i)?;
            let byte = self.buffer[i];
            if byte == self.delimiter {
                *self.fields.get_mut(count)? = start..i;
                count += 1;
                i += 1;
                start = i;
                continue;
            }
            let end = match byte {
                b'\n' => i + 1,
                b'\r' if self.buffer[i + 1] == b'\n' => i + 2,
                _ => return None,
            };
            if count == 0 && start == i {
                return Some((0, end));
            }
            *self.fields.get_mut(count)? = start..i;
            return Some((count + 1, end));
        }
    }

    /// The first special byte at or after `i`. Eight bytes are examined at a time.
    #[inline(always)]
    fn special_from(&self, mut i: usize) -> Option<usize> {
        loop {
            let word = u64::from_le_bytes(*self.buffer.get(i..)?.first_chunk::<WORD>()?);
            let mut found = 0;
            for special in self.special {
                // The lowest bit that is set marks the first byte that is equal. A borrow can set
                // other bits, but only above that one.
                let differs = word ^ special;
                found |= differs.wrapping_sub(ONES) & !differs & (ONES << 7);
            }
            if found != 0 {
                return Some(i + found.trailing_zeros() as usize / 8);
            }
            i += WORD;
        }
    }

    /// Moves the bytes that are left to the front and reads until there is a whole line. Returns
    /// false if there is no further whole line.
    fn refill(&mut self) -> io::Result<bool> {
        self.buffer.copy_within(self.uncut.clone(), 0);
        self.offset += self.uncut.start as u64;
        self.uncut = 0..self.uncut.len();
        self.whole = 0;
        while self.uncut.end < BUFFER {
            let read = match self.text.read(&mut self.buffer[self.uncut.end..BUFFER]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read?,
            };
            if read == 0 {
                return Ok(false);
            }
            let news = self.uncut.end..self.uncut.end + read;
            self.uncut.end = news.end;
            if let Some(last) = self.buffer[news.clone()]
                .iter()
                .rposition(|&byte| byte == b'\n')
            {
                self.whole = news.start + last + 1;
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The current row or comment as a whole, with its end.
    pub(super) fn line(&self) -> &[u8] {
        &self.buffer[self.row..self.uncut.start]
    }

    /// The field of the current row with this index.
    #[inline]
    pub(super) fn field(&self, column: usize) -> &[u8] {
        &self.buffer[self.fields[column].clone()]
    }

    /// The offset in the text at which the current row begins.
    pub(super) fn row_offset(&self) -> u64 {
        self.offset + self.row as u64
    }

    /// The offset in the text of the first byte that has not been cut.
    pub(super) fn rest_offset(&self) -> u64 {
        self.offset + self.uncut.start as u64
    }

    /// The text that has not been cut.
    pub(super) fn into_rest(self) -> impl Read {
        Cursor::new(self.buffer[self.uncut.clone()].to_vec()).chain(self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows that are cut, and the text that is left.
    fn cut(text: &str) -> (Vec<Vec<String>>, String) {
        let mut lines = Lines::new(text.as_bytes(), 0, b',', 2);
        let mut rows = Vec::new();
        loop {
            match lines.cut().unwrap() {
                Cut::Row => {}
                Cut::Comment => continue,
                Cut::Rest => break,
            }
            let field = |column| String::from_utf8_lossy(lines.field(column)).into_owned();
            rows.push(vec![field(0), field(1)]);
            assert_eq!(
                text.as_bytes()[lines.row_offset() as usize],
                lines.field(0)[0]
            );
        }
        let mut rest = String::new();
        assert!(text.len() as u64 >= lines.rest_offset());
        lines.into_rest().read_to_string(&mut rest).unwrap();
        (rows, rest)
    }

    #[test]
    fn plain_rows_are_cut_whatever_their_line_ends() {
        let (rows, rest) = cut("1,2\r\n# 3,4\n\n\r\n5,6\n7,8");
        assert_eq!(rows, [["1", "2"], ["5", "6"]]);
        assert_eq!(
            rest, "7,8",
            "a line without an end is left to the general rules"
        );
    }

    #[test]
    fn rows_that_are_not_plain_are_left_whole() {
        for odd in ["\"1\",2\n3,4\n", "1\n3,4\n", "1,2,3\n3,4\n", "1,2\r3,4\n"] {
            assert_eq!(cut(&format!("8,9\n{odd}")).1, odd);
        }
    }

    #[test]
    fn rows_are_whole_across_refills() {
        let text: String = (0..50_000).map(|i| format!("{i},{}\n", 2 * i)).collect();
        let (rows, rest) = cut(&text);
        assert!(
            rows.iter()
                .enumerate()
                .all(|(i, row)| row[0] == i.to_string())
        );
        assert_eq!((rows.len(), rest.as_str()), (50_000, ""));
    }

    #[test]
    fn line_longer_than_the_buffer_is_left_whole() {
        let odd = "1".repeat(BUFFER + 5) + ",2\n";
        assert_eq!(
            cut(&format!("8,9\n{odd}")),
            (vec![vec!["8".into(), "9".into()]], odd)
        );
    }
}
