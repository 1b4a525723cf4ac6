//! The dialects of text tables: what separates the values of a row, and whether a comma is their decimal point.

use super::field::Text;
use crate::failure::one_line;
use csv::{ByteRecord, ReaderBuilder};
use std::io::{self, BufRead, Read};

/// What separates values, and how decimals are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dialect {
    separator: Separator,
    /// Whether `1,5` is one and a half.
    decimal_comma: bool,
}

/// What separates the values of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    /// One character.
    Byte(u8),
    /// Any number of blanks and tabs. Those at the ends of a row separate nothing.
    Blanks,
}

/// The kind of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A number.
    Number,
    /// A date and time, or a time of day.
    Time,
    /// Nothing.
    Empty,
    /// Any other text.
    Text,
}

impl Kind {
    pub(super) fn of(field: &[u8]) -> Self {
        let field = field.trim_ascii();
        if field.is_empty() {
            Self::Empty
        } else if fast_float2::parse::<f64, _>(field).is_ok() {
            Self::Number
        } else if Text(field).is_date_or_time() {
            Self::Time
        } else {
            Self::Text
        }
    }

    /// Whether a field of this kind is a value of a column of numbers or times.
    pub(super) fn is_value(self) -> bool {
        matches!(self, Self::Number | Self::Time)
    }
}

impl Dialect {
    /// Values that are separated by commas.
    pub(super) const COMMAS: Self = Self::of(Separator::Byte(b','), false);

    /// Values that are separated by blanks and tabs.
    pub(super) const BLANKS: Self = Self::of(Separator::Blanks, false);

    /// The dialects that are tried. Of several that suit a text equally well, the first one is taken.
    const ALL: [Self; 7] = [
        Self::COMMAS,
        Self::of(Separator::Byte(b';'), false),
        Self::of(Separator::Byte(b'\t'), false),
        Self::of(Separator::Blanks, false),
        Self::of(Separator::Byte(b';'), true),
        Self::of(Separator::Byte(b'\t'), true),
        Self::of(Separator::Blanks, true),
    ];

    const fn of(separator: Separator, decimal_comma: bool) -> Self {
        Self {
            separator,
            decimal_comma,
        }
    }

    /// The dialect in which these rows have the most numbers and the fewest other texts, and the usual number of
    /// their fields.
    pub(super) fn of_rows(rows: &[&[u8]]) -> (Self, usize) {
        let judged = Self::ALL.map(|dialect| {
            let records: Vec<ByteRecord> = rows.iter().map(|row| dialect.fields(row)).collect();
            let width = usual_width(&records);
            let fitting = records.iter().filter(|record| record.len() == width);
            let points = fitting.flatten().map(|field| match Kind::of(field) {
                Kind::Number | Kind::Time => 2,
                Kind::Empty => 0,
                Kind::Text => -1,
            });
            (dialect, width, points.sum::<i64>())
        });
        // A field between tabs may hold blanks, such as a date and a time, unless these stand between numbers.
        let has_tabs = rows_with_tabs(rows);
        let judged = judged.map(|(dialect, width, points)| {
            let is_split = has_tabs && dialect.separator == Separator::Blanks;
            (dialect, width, if is_split { i64::MIN } else { points })
        });
        let [first, others @ ..] = judged;
        let is_better =
            |one: &(Self, usize, i64), best: &(Self, usize, i64)| match best.2.max(one.2) {
                // There are no numbers, so that only the number of fields tells what separates them.
                ..=0 => one.0.separator != Separator::Blanks && one.1 > best.1,
                _ => one.2 > best.2,
            };
        let best = others.into_iter().fold(
            first,
            |best, one| {
                if is_better(&one, &best) { one } else { best }
            },
        );
        (best.0, best.1)
    }

    /// The byte that may separate values, where decimals are written with points.
    pub(super) fn separator_of_points(self) -> Option<u8> {
        let byte = match self.separator {
            Separator::Byte(byte) => byte,
            Separator::Blanks => b' ',
        };
        (!self.decimal_comma).then_some(byte)
    }

    /// The byte that separates the values in the text as [`Dialect::tidied`] passes it on.
    pub(super) fn delimiter(self) -> u8 {
        match self.separator {
            Separator::Byte(byte) => byte,
            Separator::Blanks => b'\t',
        }
    }

    /// The fields of a row, with decimal points.
    pub(super) fn fields(self, row: &[u8]) -> ByteRecord {
        let mut text = Vec::new();
        // Reading from memory does not fail.
        let _ = self
            .tidied(Box::new(io::Cursor::new(row.to_vec())))
            .read_to_end(&mut text);
        let mut record = ByteRecord::new();
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(self.delimiter())
            .from_reader(text.as_slice());
        let _ = reader.read_byte_record(&mut record);
        record
    }

    /// The names of `width` columns in a line above the rows, which may separate them by other characters than the
    /// rows do. Returns `None` if the line has another number of names, or a number among them.
    pub(super) fn names(self, line: &[u8], width: usize) -> Option<Vec<String>> {
        let dialects = [self]
            .into_iter()
            .chain(Self::ALL)
            .filter(|one| !one.decimal_comma || *one == self);
        let texts =
            dialects.map(|dialect| texts_of(&Self::of(dialect.separator, false).fields(line)));
        let merged = texts.chain([merged_brackets(line), split_at_wide_blanks(line)]);
        merged.filter_map(|names| fitted(names, width)).next()
    }

    /// The text with one delimiter between the values of a row, and with decimal points.
    pub(super) fn tidied(self, text: Box<dyn BufRead>) -> Box<dyn Read> {
        if !self.decimal_comma && self.separator != Separator::Blanks {
            return Box::new(text);
        }
        Box::new(Tidied {
            text,
            blanks: self.separator == Separator::Blanks,
            decimal_comma: self.decimal_comma,
            place: Place::LineStart,
            ready: Vec::new(),
            given: 0,
        })
    }
}

/// Whether tabs separate the values of all rows: each has as many of them, and no blanks stand between numbers.
fn rows_with_tabs(rows: &[&[u8]]) -> bool {
    let count = |row: &[u8]| row.iter().filter(|&&byte| byte == b'\t').count();
    let tabs = rows.first().map_or(0, |row| count(row));
    let are_numbers = |field: &[u8]| {
        let mut words = field
            .split(|&byte| byte == b' ')
            .filter(|word| !word.is_empty());
        let is_number = |word: &[u8]| Kind::of(word) == Kind::Number;
        matches!((words.next(), words.next()), (Some(one), Some(other)) if is_number(one) && is_number(other))
    };
    let is_of_tabs =
        |row: &&[u8]| count(row) == tabs && !row.split(|&byte| byte == b'\t').any(are_numbers);
    tabs > 0 && rows.iter().all(is_of_tabs)
}

/// The number of fields that most records have. Of several, it is the largest one.
fn usual_width(records: &[ByteRecord]) -> usize {
    let count = |width: usize| {
        records
            .iter()
            .filter(|record| record.len() == width)
            .count()
    };
    let widths = records.iter().map(ByteRecord::len);
    widths
        .max_by_key(|&width| (count(width), width))
        .unwrap_or(0)
}

fn texts_of(record: &ByteRecord) -> Vec<String> {
    let text = |field: &[u8]| one_line(String::from_utf8_lossy(field).trim());
    record.iter().map(text).collect()
}

/// Words between blanks. A word in brackets belongs to the word before it.
fn merged_brackets(line: &[u8]) -> Vec<String> {
    let line = one_line(&String::from_utf8_lossy(line));
    let mut names: Vec<String> = Vec::new();
    let mut is_open = false;
    for word in line.split_whitespace() {
        match names.last_mut() {
            Some(last) if is_open || word.starts_with(['[', '(']) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => names.push(word.to_owned()),
        }
        let last = names.last().map_or("", String::as_str);
        is_open = last.matches(['[', '(']).count() > last.matches([']', ')']).count();
    }
    names
}

/// Names with single blanks in them, and at least two blanks between them.
fn split_at_wide_blanks(line: &[u8]) -> Vec<String> {
    let line = one_line(&String::from_utf8_lossy(line).replace('\t', "  "));
    let parts = line
        .split("  ")
        .map(str::trim)
        .filter(|part| !part.is_empty());
    parts.map(String::from).collect()
}

/// Names for `width` columns. The last column has no name if its rows end with a delimiter and the header does not.
fn fitted(mut names: Vec<String>, width: usize) -> Option<Vec<String>> {
    while names.len() > width && names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    if names.len() + 1 == width && width > 2 {
        names.push(String::new());
    }
    let is_name = |name: &String| !matches!(Kind::of(name.as_bytes()), Kind::Number);
    let some = names.iter().any(|name| !name.is_empty());
    (names.len() == width && some && names.iter().all(is_name)).then_some(names)
}

/// Where in a line the next byte stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    LineStart,
    /// In a comment, up to the end of the line.
    Comment,
    /// In a value.
    Value,
    /// In a value in quotes.
    Quoted,
    /// Behind a value, in blanks.
    Behind,
}

/// A text whose rows are brought into the form that the readers of rows expect. Comments keep their form, and every
/// line remains a line.
struct Tidied {
    text: Box<dyn BufRead>,
    blanks: bool,
    decimal_comma: bool,
    place: Place,
    ready: Vec<u8>,
    given: usize,
}

impl Tidied {
    fn push(&mut self, byte: u8) {
        if byte == b'\n' || byte == b'\r' {
            self.place = Place::LineStart;
            self.ready.push(byte);
            return;
        }
        let is_blank = self.blanks && (byte == b' ' || byte == b'\t');
        match self.place {
            Place::LineStart if byte == b'#' => self.place = Place::Comment,
            Place::LineStart if is_blank => return,
            Place::Value if is_blank => {
                self.place = Place::Behind;
                return;
            }
            Place::Behind if is_blank => return,
            Place::LineStart | Place::Behind => {
                if self.place == Place::Behind {
                    self.ready.push(b'\t');
                }
                self.place = if byte == b'"' {
                    Place::Quoted
                } else {
                    Place::Value
                };
            }
            Place::Quoted if byte == b'"' => self.place = Place::Value,
            _ => {}
        }
        let is_comma = byte == b',' && self.decimal_comma && self.place != Place::Comment;
        self.ready.push(if is_comma { b'.' } else { byte });
    }
}

impl Read for Tidied {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.given == self.ready.len() {
            self.ready.clear();
            self.given = 0;
            let chunk = self.text.fill_buf()?.to_vec();
            if chunk.is_empty() {
                return Ok(0);
            }
            chunk.iter().for_each(|&byte| self.push(byte));
            self.text.consume(chunk.len());
        }
        let rest = &self.ready[self.given..];
        let length = rest.len().min(buffer.len());
        buffer[..length].copy_from_slice(&rest[..length]);
        self.given += length;
        Ok(length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tidied(dialect: Dialect, text: &str) -> String {
        let mut tidy = String::new();
        let mut reader = dialect.tidied(Box::new(io::Cursor::new(text.as_bytes().to_vec())));
        reader.read_to_string(&mut tidy).unwrap();
        tidy
    }

    #[test]
    fn the_dialect_with_the_most_numbers_is_found() {
        for (row, width) in [
            ("1,2.5,3", 3),
            ("1, 2.5,  3", 3),
            ("1;2,5;3", 3),
            ("1;2.5;3", 3),
            ("1\t2,5\t3", 3),
            ("  1   2.5 3  ", 3),
            ("1 2,5 3,5", 3),
            ("2024-05-01T12:00:00.005Z,0.1,0.2", 3),
            ("2024-05-01 12:00:00.005;0,1;0,2", 3),
            ("12:00:00.005 0.1 0.2", 3),
            ("03/02/2026 07:48:12.000\t0.1\t0.2", 3),
            ("1 2\t3 4", 4),
            ("1.5", 1),
            ("1,2", 2),
            ("1,2,", 3),
        ] {
            let (dialect, found) = Dialect::of_rows(&[row.as_bytes(); 3]);
            assert_eq!(found, width, "{row}: {dialect:?}");
            let fields = dialect.fields(row.as_bytes());
            let kinds = fields.iter().map(Kind::of);
            assert!(
                kinds.clone().all(|kind| kind != Kind::Text),
                "{row}: {fields:?}"
            );
        }
    }

    #[test]
    fn a_date_that_is_not_known_does_not_shift_the_columns() {
        let row = "Mon Mar 2 07:48:12 2026\t0.1\t0.2\t0.3";
        let (dialect, width) = Dialect::of_rows(&[row.as_bytes(); 3]);
        assert_eq!((width, dialect.separator), (4, Separator::Byte(b'\t')));
    }

    #[test]
    fn rows_are_tidied_and_comments_are_not() {
        let blanks = Dialect::of(Separator::Blanks, true);
        assert_eq!(
            tidied(blanks, "  1,5 \t 2  \r\n# lost 5, or 6\n\n3 \"a b\" 4"),
            "1.5\t2\r\n# lost 5, or 6\n\n3\t\"a b\"\t4"
        );
        let semicolons = Dialect::of(Separator::Byte(b';'), true);
        assert_eq!(tidied(semicolons, "1,5;2\n"), "1.5;2\n");
    }

    #[test]
    fn names_are_found_whatever_separates_them() {
        let blanks = Dialect::of(Separator::Blanks, false);
        for line in ["t gx gy", "t,gx,gy", "t\tgx\tgy", "  t   gx  gy "] {
            assert_eq!(blanks.names(line.as_bytes(), 3).unwrap(), ["t", "gx", "gy"]);
        }
        let names = blanks.names(b"Time (s)  Gyro_X [deg/s] Gyro_Y [deg / s]", 3);
        assert_eq!(
            names.unwrap(),
            ["Time (s)", "Gyro_X [deg/s]", "Gyro_Y [deg / s]"]
        );
        assert_eq!(
            Dialect::COMMAS.names(b"a,b,c,", 3).unwrap(),
            ["a", "b", "c"]
        );
        assert_eq!(
            Dialect::COMMAS.names(b"a,b,c", 4).unwrap(),
            ["a", "b", "c", ""]
        );
        assert_eq!(Dialect::COMMAS.names(b"a,7,c", 3), None);
    }
}
