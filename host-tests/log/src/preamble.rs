//! Finds where the rows of a text begin, in which dialect they are written, and what stands above them: comments,
//! a preamble of other lines, the names of the columns, and their units.

use super::{
    dialect::{Dialect, Kind},
    glue::Glue,
    metadata::Metadata,
    source, unit_names,
};
use crate::failure::{Failure, Place, quoted};
use indicatif::ProgressBar;
use std::{
    io::{BufRead, Read},
    path::Path,
};

/// A line of this many bytes or more above the first row is refused, because the file is then not a
/// log. Chosen by hand.
const LONGEST_LINE: u64 = 1 << 16;

/// The lines and bytes below the comments in which the first row is looked for. The longest preamble that is known,
/// that of the Betaflight Blackbox Explorer, has some hundred lines. Chosen by hand.
const MOST_LINES: usize = 600;
const MOST_BYTES: usize = 1 << 18;

/// The number of rows that decide the dialect. Chosen by hand.
const JUDGES: usize = 32;

/// The most bytes of the preamble in which conventions are looked for.
const LONGEST_SAID: usize = 1 << 13;

/// The line that is kept of a log of ESP-IDF, whose times are milliseconds.
pub(super) const OF_ESP_IDF: &str = "times of esp-idf in ms";

/// What stands above the first row of a text.
pub(super) struct Preamble {
    pub(super) dialect: Dialect,
    /// The number of values in a row.
    pub(super) width: usize,
    pub(super) metadata: Metadata,
    pub(super) names: Option<Vec<String>>,
    /// The offset in the text of the first row.
    pub(super) start: u64,
    /// The comments and lines above the names, in lower case.
    pub(super) said: String,
    /// What is cut off the rows.
    pub(super) glue: Option<Glue>,
}

/// A line of the text, without its end.
struct Line {
    /// The number of the line, counted from 1.
    row: u64,
    offset: u64,
    bytes: Vec<u8>,
}

impl Line {
    /// Whether a quote is opened or closed in this line and not both.
    fn is_open(&self) -> bool {
        self.comment().is_none() && self.bytes.iter().filter(|&&byte| byte == b'"').count() % 2 == 1
    }

    fn comment(&self) -> Option<String> {
        let comment = self.bytes.strip_prefix(b"#")?;
        Some(String::from_utf8_lossy(comment).trim().to_owned())
    }
}

impl Preamble {
    /// Reads the beginning of a text; messages name the file `path`, of which the text may have been made.
    pub(super) fn read(path: &Path, text: &Path, gzip: bool) -> Result<Self, Failure> {
        let mut metadata = Metadata::default();
        let mut said = String::new();
        let (comment, mut lines) = sample(path, text, gzip, &mut metadata, &mut said)?;
        // Offsets are those of the text as it is.
        let end = lines
            .last()
            .map_or(0, |line| line.offset + line.bytes.len() as u64 + 1);
        let glue = cut(&mut lines);
        if glue.as_ref().is_some_and(Glue::is_of_esp_idf) {
            keep(&mut said, OF_ESP_IDF);
        }
        let rows: Vec<&Line> = lines
            .iter()
            .filter(|line| line.comment().is_none())
            .collect();
        let (dialect, width, first) = first_row(path, &rows)?;
        // Lines above the first row, and the comment directly above it or above its header.
        let first_offset = rows.get(first).map_or(u64::MAX, |line| line.offset);
        let above: Vec<&Line> = lines
            .iter()
            .filter(|line| line.offset < first_offset)
            .collect();
        let said_above = comment.clone();
        let mut last_comment = comment.filter(|_| first == 0);
        for line in &above {
            last_comment = line.comment();
            if let Some(comment) = &last_comment {
                metadata.read_comment(line.row, comment);
            }
        }
        let mut preamble: Vec<&Line> = rows[..first].to_vec();
        let mut names = None;
        if let Some(last) = preamble.last()
            && let Some(found) = dialect.names(&last.bytes, width)
        {
            preamble.pop();
            names = Some(found);
            // The names may stand in a comment.
            let of_comment = || said_above.as_deref().map(str::as_bytes);
            let above = preamble.last().map(|line| &*line.bytes);
            let above = above.or_else(of_comment);
            let above = above.and_then(|line| dialect.names(line, width));
            if let (Some(units), Some(above)) = (&names, above)
                && unit_names::are_units(units)
            {
                preamble.pop();
                names = Some(
                    above
                        .iter()
                        .zip(units)
                        .map(|(name, unit)| unit_names::with_unit(name, unit))
                        .collect(),
                );
            }
        } else if let Some(comment) = last_comment.filter(|comment| !comment.contains('='))
            && width > 1
        {
            let found = dialect.names(comment.as_bytes(), width);
            let is_name = |name: &String| Kind::of(name.as_bytes()) == Kind::Text;
            // A separator may stand behind the last name.
            names = found.filter(|names| match names.as_slice() {
                [names @ .., last] if last.is_empty() => names.iter().all(is_name),
                names => names.iter().all(is_name),
            });
        }
        names = names.or_else(|| glue.as_ref()?.labels());
        let has_names = names.is_some();
        for line in preamble {
            let record = dialect.fields(&line.bytes);
            let is_short = width <= 2
                && !record
                    .get(0)
                    .is_some_and(|key| key.trim_ascii().ends_with(b":"));
            let kinds: Vec<Kind> = record.iter().map(Kind::of).collect();
            let text = kinds.iter().position(|&kind| kind == Kind::Text);
            match text {
                None if kinds.contains(&Kind::Number) => {
                    return Err(Place::row(path, line.row).failure(
                        format!("{} where the rows below have {width}", values(kinds.len())),
                        "correct the row or remove it",
                    ));
                }
                Some(text)
                    if kinds.len() == width
                        && kinds.contains(&Kind::Number)
                        // Settings stand above the names.
                        && !(has_names && text == 0)
                        && (width > 2 || is_short) =>
                {
                    return Err(Place::row(path, line.row).failure(
                        format!(
                            "the first row mixes numbers and text such as {}",
                            quoted(&record[text])
                        ),
                        "make it a header of names only, or correct it",
                    ));
                }
                _ => {}
            }
            let text = String::from_utf8_lossy(&line.bytes);
            metadata.read_line(line.row, &text);
            keep(&mut said, &text);
        }
        Ok(Self {
            dialect,
            width,
            metadata,
            names,
            start: rows.get(first).map_or(end, |line| line.offset),
            said,
            glue,
        })
    }
}

/// Cuts off what is around the values of the rows, if it has the same shape on the last ones.
fn cut(lines: &mut [Line]) -> Option<Glue> {
    let rows = || lines.iter().filter(|line| line.comment().is_none());
    let judges: Vec<&[u8]> = rows().rev().take(JUDGES).map(|line| &*line.bytes).collect();
    let (dialect, width) = Dialect::of_rows(&judges);
    let glue = Glue::of_rows(&judges, dialect, width).or_else(|| Glue::of_labels(&judges))?;
    for line in lines.iter_mut().filter(|line| line.comment().is_none()) {
        if let Some(bytes) = glue.cut(&line.bytes) {
            line.bytes = bytes;
        }
    }
    Some(glue)
}

pub(super) fn values(count: usize) -> String {
    match count {
        1 => "1 value".into(),
        count => format!("{count} values"),
    }
}

/// A line without its end. A tab at its end may stand for an empty value.
fn without_end(mut line: &[u8]) -> &[u8] {
    while let [rest @ .., b'\n' | b'\r'] = line {
        line = rest;
    }
    line
}

fn keep(said: &mut String, text: &str) {
    if said.len() + text.len() < LONGEST_SAID {
        said.push_str(&text.to_lowercase());
        said.push('\n');
    }
}

/// The last comment above the first line that is none, and the lines from there on as far as they are looked at.
/// Empty lines are left out.
fn sample(
    path: &Path,
    text: &Path,
    gzip: bool,
    metadata: &mut Metadata,
    said: &mut String,
) -> Result<(Option<String>, Vec<Line>), Failure> {
    let mut text = source::open_text(text, gzip, &ProgressBar::hidden())?;
    let mut lines: Vec<Line> = Vec::new();
    let mut last_comment = None;
    let (mut offset, mut bytes) = (0, 0);
    let mut buffer = Vec::new();
    for row in 1.. {
        buffer.clear();
        let read = text
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut buffer);
        let length =
            read.map_err(|error| source::text_failure(Place::row(path, row), gzip, &error));
        let length = match length {
            // The rows report what is wrong further down.
            Err(_) if !lines.is_empty() => break,
            length => length?,
        };
        if length == 0 {
            let what = if row == 1 {
                "the file is empty"
            } else {
                "no rows"
            };
            if lines.is_empty() {
                return Err(Place::file(path).failure(what, "record some samples"));
            }
            break;
        }
        if length as u64 == LONGEST_LINE {
            if lines.is_empty() {
                return Err(Place::row(path, row).failure(
                    format!("a line has {} KiB or more", LONGEST_LINE / 1024),
                    "check that the file is text",
                ));
            }
            break;
        }
        // Very old files end their lines with a carriage return alone.
        for part in buffer.split_inclusive(|&byte| byte == b'\r') {
            let line = Line {
                row,
                offset,
                bytes: without_end(part).to_vec(),
            };
            offset += part.len() as u64;
            if line.bytes.trim_ascii().is_empty() {
                continue;
            }
            match line.comment() {
                Some(comment) if lines.is_empty() => {
                    metadata.read_comment(row, &comment);
                    metadata.read_line(row, &comment);
                    keep(said, &comment);
                    last_comment = Some(comment);
                }
                _ => match lines.last_mut() {
                    // A value in quotes may contain the end of a line.
                    Some(last) if last.is_open() && line.is_open() => {
                        last.bytes.push(b'\n');
                        last.bytes.extend(line.bytes);
                    }
                    _ => lines.push(line),
                },
            }
        }
        bytes += length;
        if lines.is_empty() {
            bytes = 0;
        }
        if lines.len() >= MOST_LINES || bytes > MOST_BYTES {
            break;
        }
    }
    Ok((last_comment, lines))
}

/// The dialect, the number of values in a row, and the place of the first row among these lines.
///
/// The last lines decide the dialect and which columns hold numbers. The first row is the first one with that many
/// values that has numbers in at least half of these columns, or numbers and empty fields alone, as a row of another sensor has.
fn first_row(path: &Path, rows: &[&Line]) -> Result<(Dialect, usize, usize), Failure> {
    let judges: Vec<&[u8]> = rows
        .iter()
        .rev()
        .take(JUDGES)
        .map(|line| line.bytes.as_slice())
        .collect();
    let (dialect, width) = Dialect::of_rows(&judges);
    let records = judges.iter().map(|row| dialect.fields(row));
    let records: Vec<_> = records.filter(|record| record.len() == width).collect();
    let is_value = |record: &csv::ByteRecord, column: usize| {
        record
            .get(column)
            .is_some_and(|field| Kind::of(field).is_value())
    };
    let is_numeric = |column: &usize| {
        let with = records
            .iter()
            .filter(|record| is_value(record, *column))
            .count();
        2 * with >= records.len()
    };
    let numeric: Vec<usize> = (0..width).filter(is_numeric).collect();
    let is_row = |line: &&Line| {
        let record = dialect.fields(&line.bytes);
        let with = numeric
            .iter()
            .filter(|&&column| is_value(&record, column))
            .count();
        let has_no_text = || record.iter().all(|field| Kind::of(field) != Kind::Text);
        record.len() == width && with > 0 && (2 * with >= numeric.len() || has_no_text())
    };
    if let Some(first) = rows.iter().position(is_row) {
        return Ok((dialect, width, first));
    }
    // No row has numbers. The first line is taken for names, so that the message can tell them.
    match rows {
        [] => Err(Place::file(path).failure("no rows", "record some samples")),
        [only] if Kind::of(&only.bytes) != Kind::Text => Ok((dialect, width, 0)),
        _ => Ok((dialect, width, 1)),
    }
}
