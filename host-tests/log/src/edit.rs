//! Edits the lines of a text while it is read: cuts off what is around the values, and keeps the rows of one sensor.

use super::{
    dialect::Dialect,
    field::{Field as _, Text},
    glue::Glue,
    records::LONGEST_ROW,
};
use std::io::{self, BufRead, BufReader, Read};

/// What becomes of the lines.
#[derive(Clone, Debug, Default)]
pub(super) struct Edit {
    pub(super) glue: Option<Glue>,
    pub(super) kept: Option<Kept>,
}

/// The rows that have a value in a column.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    pub(super) column: usize,
    /// The value, or `None` for any.
    pub(super) value: Option<String>,
    pub(super) dialect: Dialect,
}

impl Kept {
    fn has(&self, line: &[u8]) -> bool {
        let is_plain = !line.contains(&b'"');
        let record;
        let field = match self.dialect.separator_of_points().filter(|_| is_plain) {
            Some(b' ') => {
                let words = line.split(u8::is_ascii_whitespace);
                words.filter(|word| !word.is_empty()).nth(self.column)
            }
            Some(separator) => line.split(|&byte| byte == separator).nth(self.column),
            None => {
                record = self.dialect.fields(line);
                record.get(self.column)
            }
        };
        let Some(field) = field.map(<[u8]>::trim_ascii) else {
            return false;
        };
        let Some(value) = &self.value else {
            return !field.trim_ascii().is_empty() && field != b"\"\"";
        };
        let number = |text: &[u8]| Text(text).number().ok();
        let wanted = value.trim().as_bytes();
        field == wanted || number(field).is_some_and(|one| number(wanted) == Some(one))
    }
}

impl Edit {
    /// The edited text. A line that is left out becomes an empty one, so that rows keep their numbers.
    pub(super) fn of(&self, text: Box<dyn BufRead>) -> Box<dyn BufRead> {
        if self.glue.is_none() && self.kept.is_none() {
            return text;
        }
        Box::new(BufReader::new(Edited {
            text,
            edit: self.clone(),
            ready: Vec::new(),
            given: 0,
        }))
    }

    /// The edited line, without its end.
    fn line(&self, line: &[u8]) -> Vec<u8> {
        if line.starts_with(b"#") {
            return line.to_vec();
        }
        let cut = self.glue.as_ref().and_then(|glue| glue.cut(line));
        let line = cut.unwrap_or_else(|| line.to_vec());
        match &self.kept {
            Some(kept) if !kept.has(&line) => Vec::new(),
            _ => line,
        }
    }
}

/// A text whose lines are edited.
struct Edited {
    text: Box<dyn BufRead>,
    edit: Edit,
    ready: Vec<u8>,
    given: usize,
}

impl Read for Edited {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.given == self.ready.len() {
            self.given = 0;
            self.ready.clear();
            let mut longest = self.text.by_ref().take(2 * LONGEST_ROW as u64);
            if longest.read_until(b'\n', &mut self.ready)? == 0 {
                return Ok(0);
            }
            // A tab at the end may stand for an empty value.
            let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r' | b' ');
            let end = self.ready.iter().rposition(|byte| !is_end(byte));
            let end = end.map_or(0, |last| last + 1);
            let line = self.edit.line(&self.ready[..end]);
            let is_whole = self.ready.ends_with(b"\n");
            self.ready = line;
            if is_whole {
                self.ready.push(b'\n');
            }
        }
        let rest = &self.ready[self.given..];
        let length = rest.len().min(buffer.len());
        buffer[..length].copy_from_slice(&rest[..length]);
        self.given += length;
        Ok(length)
    }
}
