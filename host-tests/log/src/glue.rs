//! Characters around the values of rows that have the same shape on all of them, such as the time and the arrow that a serial
//! monitor writes in front of every line, or the checksum behind it.

use super::{
    dialect::{Dialect, Kind},
    field::{Field as _, Text},
};
use crate::failure::quoted;
use std::collections::BTreeSet;

/// The characters that may stand directly in front of the first value.
const BEFORE: &[u8] = b" \t:=>[({|$";

/// The characters that may stand directly behind the last value.
const BEHIND: &[u8] = b"])};:|,!> ";

/// More different numbers than this are the values of a sensor, and fewer whole ones may number sensors. Chosen by hand.
const NUMBERED: usize = 8;

/// The name of a column of times in front of the values.
const TIME: &str = "time";

/// What stands in front of the values and what behind them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Glue {
    head: Option<Head>,
    tail: Option<Tail>,
    separator: u8,
    /// What stands in front of each value, as the names of columns do where a plotter reads the rows. Empty if nothing does.
    labels: Vec<Option<Vec<u8>>>,
}

#[derive(Clone, Debug, PartialEq)]
enum Head {
    /// The same characters on every row.
    Same(Vec<u8>),
    /// A time or a number, with the same characters in front of it and behind it.
    Stamp { before: Vec<u8>, behind: Vec<u8> },
}

#[derive(Clone, Debug, PartialEq)]
enum Tail {
    /// The same characters on every row.
    Same(Vec<u8>),
    /// An asterisk and hexadecimal digits.
    Checksum,
}

impl Glue {
    /// What is around the values of these rows, if it has the same shape on nearly all of them.
    pub(super) fn of_rows(rows: &[&[u8]], dialect: Dialect, width: usize) -> Option<Self> {
        let separator = dialect
            .separator_of_points()
            .filter(|_| width <= MOST_FIELDS)?;
        let mut glue = Self {
            head: None,
            tail: None,
            separator,
            labels: Vec::new(),
        };
        let fields = |rows: &[Vec<u8>]| -> Vec<Vec<Vec<u8>>> {
            let records = rows.iter().map(|row| dialect.fields(row));
            let records = records.filter(|record| record.len() <= MOST_FIELDS);
            let own = |record: csv::ByteRecord| -> Vec<Vec<u8>> {
                record.iter().map(|one| one.trim_ascii().to_vec()).collect()
            };
            records.map(own).collect()
        };
        let mut rows: Vec<Vec<u8>> = rows.iter().map(|row| row.to_vec()).collect();
        let mut records = fields(&rows);
        records.retain(|record| record.len() == width);
        if let Some(labels) = labels(&records, width) {
            glue.labels = labels;
            return Some(glue);
        }
        glue.head = head(&records);
        if glue.head.is_some() {
            rows = rows.iter().filter_map(|row| glue.cut(row)).collect();
            records = fields(&rows);
        }
        glue.tail = tail(&records);
        rows = rows.iter().filter_map(|row| glue.cut_tail(row)).collect();
        // A label in front of every value is not around the row.
        let mut others = fields(&rows)
            .into_iter()
            .flat_map(|record| record.into_iter().skip(1));
        let is_labelled = others.any(|field| split(&field).is_some());
        (!is_labelled && (glue.head.is_some() || glue.tail.is_some())).then_some(glue)
    }

    /// The labels of values that blanks separate. Without a number, no dialect tells them.
    pub(super) fn of_labels(rows: &[&[u8]]) -> Option<Self> {
        let dialect = Dialect::BLANKS;
        let width = dialect.fields(rows.last()?).len();
        if width > MOST_FIELDS {
            return None;
        }
        let records = rows.iter().map(|row| dialect.fields(row));
        let records = records.filter(|record| record.len() == width);
        let own = |record: csv::ByteRecord| record.iter().map(<[u8]>::to_vec).collect();
        let records: Vec<Vec<Vec<u8>>> = records.map(own).collect();
        Some(Self {
            head: None,
            tail: None,
            separator: dialect.separator_of_points()?,
            labels: labels(&records, width)?,
        })
    }

    /// The values of a row, or `None` if it has another shape. A time in front of what is no number becomes the name of its
    /// column, because the names of columns follow.
    pub(super) fn cut(&self, row: &[u8]) -> Option<Vec<u8>> {
        if !self.labels.is_empty() {
            return self.cut_labels(row);
        }
        let row = self.cut_tail(row)?;
        let row = row.trim_ascii_start();
        match &self.head {
            None => Some(row.to_vec()),
            Some(Head::Same(head)) => row.strip_prefix(head.as_slice()).map(<[u8]>::to_vec),
            Some(Head::Stamp { before, behind }) => {
                let row = row.strip_prefix(before.as_slice())?;
                let end = row.windows(behind.len()).position(|part| part == behind)?;
                let (stamp, rest) = (&row[..end], &row[end + behind.len()..]);
                if !Kind::of(stamp).is_value() {
                    return None;
                }
                let is_number = rest.trim_ascii_start().first().is_some_and(begins_number);
                let stamp = if is_number { stamp } else { TIME.as_bytes() };
                Some([stamp, &[self.separator], rest].concat())
            }
        }
    }

    /// The values of a row behind their labels.
    fn cut_labels(&self, row: &[u8]) -> Option<Vec<u8>> {
        let is_blank = self.separator == b' ';
        let is_separator = |byte: &u8| match is_blank {
            true => byte.is_ascii_whitespace(),
            false => *byte == self.separator,
        };
        let fields = row.split(is_separator).map(<[u8]>::trim_ascii);
        let mut fields = fields.filter(|field| !is_blank || !field.is_empty());
        let mut values = Vec::new();
        for label in &self.labels {
            let field = fields.next()?;
            let value = match label {
                Some(label) => field.strip_prefix(label.trim_ascii())?.trim_ascii(),
                None => field,
            };
            values.push(value);
        }
        let is_whole = fields.next().is_none();
        is_whole.then(|| values.join(&self.separator))
    }

    /// The names that the labels are.
    pub(super) fn labels(&self) -> Option<Vec<String>> {
        let name = |label: &Option<Vec<u8>>| {
            let text = String::from_utf8_lossy(label.as_deref().unwrap_or_default());
            text.trim_end_matches([':', '=', ' ', '\t']).to_owned()
        };
        (!self.labels.is_empty()).then(|| self.labels.iter().map(name).collect())
    }

    fn cut_tail(&self, row: &[u8]) -> Option<Vec<u8>> {
        let row = row.trim_ascii_end();
        let cut = match &self.tail {
            None => Some(row),
            Some(Tail::Same(tail)) => Some(row.strip_suffix(tail.as_slice()).unwrap_or(row)),
            Some(Tail::Checksum) => row
                .iter()
                .rposition(|&byte| byte == b'*')
                .map_or(Some(row), |star| {
                    is_checksum(&row[star..]).then(|| &row[..star])
                }),
        };
        cut.map(<[u8]>::to_vec)
    }

    /// Whether the time in front of the values is that of a log line of ESP-IDF, which is in milliseconds.
    pub(super) fn is_of_esp_idf(&self) -> bool {
        let levels = [b"E (", b"W (", b"I (", b"D (", b"V ("];
        let is_level = |before: &Vec<u8>| levels.iter().any(|level| before.ends_with(*level));
        matches!(&self.head, Some(Head::Stamp { before, .. }) if is_level(before))
    }

    /// What was cut off, in words.
    pub(super) fn said(&self) -> String {
        if let Some(label) = self.labels.iter().flatten().next() {
            let label = quoted(label.trim_ascii());
            return format!(
                "labels such as {label} before the values are the names of the columns"
            );
        }
        let head = self.head.as_ref().map(|head| match head {
            Head::Same(text) => format!("{} before its values", quoted(text)),
            Head::Stamp { before, behind } if before.is_empty() => {
                format!("{} behind the time before its values", quoted(behind))
            }
            Head::Stamp { before, behind } => format!(
                "{} and {} around the time before its values",
                quoted(before),
                quoted(behind)
            ),
        });
        let tail = self.tail.as_ref().map(|tail| match tail {
            Tail::Same(text) => format!("{} behind them", quoted(text)),
            Tail::Checksum => "a checksum behind them".into(),
        });
        let parts: Vec<String> = head.into_iter().chain(tail).collect();
        format!("cut off each row: {}", parts.join(", "))
    }
}

/// What stands in front of each value, if that is the same on nearly all rows, and different for each value.
fn labels(records: &[Vec<Vec<u8>>], width: usize) -> Option<Vec<Option<Vec<u8>>>> {
    let of_column = |column: usize| {
        let fields = records.iter().filter_map(|record| record.get(column));
        let labels = fields.map(|field| split(field).map(|(label, _)| label.to_vec()));
        let labels: Vec<Option<Vec<u8>>> = labels.collect();
        let last = labels.last()?;
        let alike = labels.iter().filter(|label| *label == last).count();
        are_nearly_all(alike, records.len()).then(|| last.clone())
    };
    let labels: Vec<Option<Vec<u8>>> = (0..width).map(of_column).collect::<Option<_>>()?;
    let different: BTreeSet<&Vec<u8>> = labels.iter().flatten().collect();
    let number = labels.iter().flatten().count();
    let is_named = |label: &&Vec<u8>| label.iter().any(u8::is_ascii_alphabetic);
    let are_labels = number > 1 && different.len() == number && different.iter().all(is_named);
    are_labels.then_some(labels)
}

fn begins_number(byte: &u8) -> bool {
    byte.is_ascii_digit() || b"+-.".contains(byte)
}

fn is_checksum(text: &[u8]) -> bool {
    matches!(text, [b'*', digits @ ..]
        if (1..=8).contains(&digits.len()) && digits.iter().all(u8::is_ascii_hexdigit))
}

/// Whether a text is an opening bracket, or several.
fn are_brackets(text: &[u8]) -> bool {
    let text = text.trim_ascii();
    !text.is_empty() && text.iter().all(|byte| b"[({<".contains(byte))
}

/// Rows of more fields are refused anyway.
const MOST_FIELDS: usize = 256;

/// The longest field that is looked at: each place of it may begin a number.
const LONGEST: usize = 256;

/// What stands in front of the number at the end of a field, and the number, if the field is not that number.
fn split(field: &[u8]) -> Option<(&[u8], f64)> {
    if field.len() > LONGEST || Kind::of(field) != Kind::Text {
        return None;
    }
    let starts = (1..field.len()).filter(|&start| begins_number(&field[start]));
    // A time in brackets.
    let times = starts
        .clone()
        .filter(|&start| are_brackets(&field[..start]));
    if let Some(start) = times
        .into_iter()
        .find(|&start| Kind::of(&field[start..]) == Kind::Time)
    {
        return Some((&field[..start], f64::NAN));
    }
    let mut numbers = starts.filter_map(|start| {
        let number = Text(&field[start..]).number().ok()?;
        Some((&field[..start], number))
    });
    let (head, number) = numbers.next()?;
    head.last()
        .is_some_and(|last| BEFORE.contains(last))
        .then_some((head, number))
}

/// Whether so many of the rows are nearly all.
fn are_nearly_all(count: usize, rows: usize) -> bool {
    count > 1 && 10 * count >= 9 * rows
}

/// What stands in front of the first values.
fn head(records: &[Vec<Vec<u8>>]) -> Option<Head> {
    let first = records.iter().filter_map(|record| split(record.first()?));
    let (heads, numbers): (Vec<&[u8]>, Vec<f64>) = first.unzip();
    let different: BTreeSet<u64> = numbers.iter().map(|number| number.to_bits()).collect();
    let are_values = different.len() > NUMBERED
        || numbers.iter().any(|one| one.fract() != 0.0)
        || heads.iter().all(|head| are_brackets(head));
    if !are_values {
        return None;
    }
    let last = *heads.last()?;
    let same = heads.iter().filter(|head| **head == last).count();
    if are_nearly_all(same, records.len()) {
        return Some(Head::Same(last.to_vec()));
    }
    let shape = around(last)?;
    let alike = heads.iter().filter(|head| around(head) == Some(shape));
    are_nearly_all(alike.count(), records.len()).then(|| Head::Stamp {
        before: shape.0.to_vec(),
        behind: shape.1.to_vec(),
    })
}

/// What stands before and behind the time or the number in a head.
fn around(head: &[u8]) -> Option<(&[u8], &[u8])> {
    let start = head.iter().position(u8::is_ascii_digit)?;
    let ends = (start + 1..head.len()).rev();
    let mut ends =
        ends.filter(|&end| head[end - 1].is_ascii_digit() && !head[end].is_ascii_digit());
    let end = ends.find(|&end| Kind::of(&head[start..end]).is_value())?;
    Some((&head[..start], &head[end..]))
}

/// What stands behind the last values.
fn tail(records: &[Vec<Vec<u8>>]) -> Option<Tail> {
    let rest = |record: &Vec<Vec<u8>>| {
        let field = record.last()?;
        if Kind::of(field) != Kind::Text {
            return None;
        }
        let mut ends = (1..field.len()).rev();
        let end = ends.find(|&end| Text(&field[..end]).number().is_ok())?;
        Some(field[end..].trim_ascii_start().to_vec())
    };
    let rests: Vec<Vec<u8>> = records.iter().filter_map(rest).collect();
    let last = rests.last()?;
    let is_punctuation = last.iter().all(|byte| BEHIND.contains(byte));
    let same = rests.iter().filter(|rest| *rest == last).count();
    if is_punctuation && are_nearly_all(same, records.len()) {
        return Some(Tail::Same(last.clone()));
    }
    let checksums = rests.iter().filter(|rest| is_checksum(rest)).count();
    are_nearly_all(checksums, records.len()).then_some(Tail::Checksum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(pattern: &str) -> Option<(Vec<String>, String)> {
        glued(pattern).map(|(rows, glue)| (rows, glue.said()))
    }

    /// The values of three rows in which `X` stands for a number and `T` for a time, and what is cut off.
    fn glued(pattern: &str) -> Option<(Vec<String>, Glue)> {
        let row = |i: usize| {
            let number = ["-0.25", "1.5", "0.125"][i];
            let time = ["12:30:00.000", "12:30:00.010", "12:30:00.020"][i];
            let check = ["4A", "07", "b2"][i];
            let row = pattern.replace('X', number).replace('T', time);
            row.replace("hh", check)
                .replace("ms", &(312 + 10 * i).to_string())
        };
        let rows: Vec<String> = (0..3).map(row).collect();
        let rows: Vec<&[u8]> = rows.iter().map(|row| row.as_bytes()).collect();
        let (dialect, width) = Dialect::of_rows(&rows);
        let glue = Glue::of_rows(&rows, dialect, width).or_else(|| Glue::of_labels(&rows))?;
        let text = |row: &&[u8]| String::from_utf8(glue.cut(row).unwrap()).unwrap();
        Some((rows.iter().map(text).collect(), glue))
    }

    #[test]
    fn characters_of_one_shape_around_the_values_are_cut_off() {
        for (pattern, first, said) in [
            (
                "T -> X,2,3",
                "12:30:00.000,-0.25,2,3",
                "\" -> \" behind the time before its values",
            ),
            (
                "[T] X,2,3",
                "12:30:00.000,-0.25,2,3",
                "\"[\" and \"] \" around the time before its values",
            ),
            (
                "I (ms) MPU6050: X, 2, 3",
                "312,-0.25, 2, 3",
                "\"I (\" and \") MPU6050: \" around the time before its values",
            ),
            ("gyro1: X,2,3", "-0.25,2,3", "\"gyro1: \" before its values"),
            ("2,3,X;", "2,3,-0.25", "\";\" behind them"),
            ("2,3,X*hh", "2,3,-0.25", "a checksum behind them"),
            (
                "(2405,X,2)",
                "2405,-0.25,2",
                "\"(\" before its values, \")\" behind them",
            ),
            (
                "[T,X,2]",
                "12:30:00.000,-0.25,2",
                "\"[\" before its values, \"]\" behind them",
            ),
            (
                "[X, 2, 3.5]",
                "-0.25, 2, 3.5",
                "\"[\" before its values, \"]\" behind them",
            ),
        ] {
            let (rows, words) = cut(pattern).unwrap_or_else(|| panic!("{pattern}"));
            assert_eq!(
                (rows[0].as_str(), words),
                (first, format!("cut off each row: {said}")),
                "{pattern}"
            );
        }
    }

    /// The serial plotter of Arduino reads rows of labels and values.
    #[test]
    fn labels_of_values_are_the_names_of_columns() {
        for (pattern, first, names) in [
            ("x:X,y:X,z:X", "-0.25,-0.25,-0.25", "x,y,z"),
            ("t=ms gx=X gy=X", "312 -0.25 -0.25", "t,gx,gy"),
            ("ms,gx: X, gy: X", "312,-0.25,-0.25", ",gx,gy"),
        ] {
            let (rows, found) = glued(pattern).unwrap_or_else(|| panic!("{pattern}"));
            let said = found.said();
            assert_eq!(rows[0], first, "{pattern}");
            assert!(said.starts_with("labels such as "), "{said}");
            let labels = found.labels().unwrap();
            assert_eq!(labels.join(","), names, "{pattern}");
        }
    }

    #[test]
    fn rows_of_plain_values_and_numbers_of_sensors_are_left_alone() {
        for pattern in [
            "X,2,3",
            "T,X,2",
            "$IMU,X,2",
            "sensor 1,X,2",
            "X,2,3dps",
            "X 2 3",
        ] {
            assert_eq!(cut(pattern), None, "{pattern}");
        }
    }
}
