//! Looks at rows far from the beginning of a text, where another sensor's rows may stand behind those of the first one.

use super::{Csv, number};
use crate::{
    columns::Look,
    failure::{Failure, Place, quoted},
    names,
    records::Records,
    regular_file::{self, RegularFile},
    source_marks,
};
use csv::ByteRecord;
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, SeekFrom};

/// The bytes at the end of a text that are looked at.
const END: u64 = 1 << 16;

/// The bytes of a probe in the middle of a text, in which a whole row stands.
const PROBE: u64 = 1 << 14;

/// Stamps begin anew within so many steps of the first one. Chosen by hand.
const ANEW: f64 = 16.0;

/// Larger numbers that change may be the seconds of a time.
const MOST_NUMBER: f64 = 1e8;

impl Csv {
    /// The last rows of a text that is not packed and has many rows.
    pub(super) fn last_records(&self) -> Vec<ByteRecord> {
        match self.file() {
            Some((_, length)) if length > self.start + 2 * END => {
                self.records_at(length - END, END)
            }
            _ => Vec::new(),
        }
    }

    fn file(&self) -> Option<(RegularFile, u64)> {
        (!self.gzip)
            .then(|| regular_file::open(&self.text).ok())
            .flatten()
    }

    /// The whole rows that begin in so many bytes behind an offset.
    fn records_at(&self, offset: u64, bytes: u64) -> Vec<ByteRecord> {
        let Some((mut file, _)) = self.file() else {
            return Vec::new();
        };
        if file.seek(SeekFrom::Start(offset)).is_err() {
            return Vec::new();
        }
        let mut text = BufReader::new(file.take(bytes));
        // The first line may be the end of one.
        let _ = text.read_until(b'\n', &mut Vec::new());
        let text = self.dialect.tidied(self.edit.of(Box::new(text)));
        let mut reader = Records::new(text, 0, self.dialect.delimiter());
        let mut records = Vec::new();
        while let Ok(true) = reader.read() {
            let row = reader.row();
            if row.len() == self.columns.looks.len() {
                // A clone would have room for the longest row so far.
                records.push(row.iter().collect());
            }
        }
        // The last line may be the beginning of one.
        records.pop();
        records
    }

    /// Checks that the rows of no second sensor follow those of the first one: no column of names or of numbers of sensors
    /// changes where the stamps go back.
    ///
    /// # Errors
    /// When one does.
    pub(super) fn check_far_sources(
        &self,
        first: &[ByteRecord],
        last: &[ByteRecord],
    ) -> Result<(), Failure> {
        let Some((_, length)) = self.file() else {
            return Ok(());
        };
        for column in 0..self.columns.looks.len() {
            let Some(mark) = self.only_mark(first, column) else {
                continue;
            };
            let is_other = |row: &ByteRecord| row[column].trim_ascii() != mark.as_slice();
            if !last
                .iter()
                .any(|row| is_other(row) && !row[column].trim_ascii().is_empty())
            {
                continue;
            }
            let Some((rows, at)) = self.change(column, &mark, length) else {
                continue;
            };
            let (before, behind) = (&rows[at - 1], &rows[at]);
            let goes_back = |time: usize| self.goes_back(time, first, [before, behind]);
            let mut times = (0..self.columns.looks.len()).filter(|time| self.is_time(*time, first));
            // Where no stamps go back, the values may tell.
            if !times.any(goes_back) && !source_marks::are_unlike(&rows[..at], &rows[at..]) {
                continue;
            }
            let called = self
                .columns
                .name(column)
                .map_or_else(|| (column + 1).to_string(), str::to_owned);
            let [one, other] = [&mark[..], behind[column].trim_ascii()].map(quoted);
            return Err(Place::file(&self.path).failure(
                format!("the rows are those of several sensors, by column {called}: {one}, and behind them {other}"),
                format!(
                    "keep those of one of them, such as with --rows {called}={}",
                    String::from_utf8_lossy(&mark)
                ),
            ));
        }
        Ok(())
    }

    /// Whether a time goes back between two rows, or begins anew at the stamp of the first row, as a counter may that wraps.
    fn goes_back(&self, time: usize, first: &[ByteRecord], rows: [&ByteRecord; 2]) -> bool {
        let [Some(before), Some(behind)] = rows.map(|row| number(row, time)) else {
            return false;
        };
        let stamps: Vec<f64> = first.iter().filter_map(|row| number(row, time)).collect();
        let steps = stamps.windows(2).map(|pair| pair[1] - pair[0]);
        let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
        steps.sort_unstable_by(f64::total_cmp);
        let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
        let is_anew = stamps
            .first()
            .is_some_and(|start| (behind - start).abs() < ANEW * usual);
        behind < before || is_anew
    }

    /// Whether a column is a time, which may begin anew among the first rows.
    fn is_time(&self, column: usize, first: &[ByteRecord]) -> bool {
        let rises = || {
            let numbers: Vec<f64> = first.iter().filter_map(|row| number(row, column)).collect();
            let rising = numbers.windows(2).filter(|pair| pair[1] >= pair[0]).count();
            10 * rising > 9 * first.len()
        };
        self.columns.looks[column] == Look::Rising
            || self.columns.name(column).is_some_and(names::is_time)
            || rises()
    }

    /// The mark that stands in a column of all of the first rows.
    fn only_mark(&self, first: &[ByteRecord], column: usize) -> Option<Vec<u8>> {
        let mark = first.first()?.get(column)?.trim_ascii().to_vec();
        let is_alike =
            |row: &ByteRecord| row.get(column).map(<[u8]>::trim_ascii) == Some(mark.as_slice());
        let is_mark = match self.columns.looks[column] {
            Look::Text => true,
            Look::Number => first
                .first()
                .and_then(|row| number(row, column))
                .is_some_and(|number| number.abs() < MOST_NUMBER),
            Look::Rising | Look::Date => false,
        };
        (is_mark && !mark.is_empty() && first.iter().all(is_alike)).then_some(mark)
    }

    /// Rows about the end of those with a mark in a column, if these stand one behind the other, and the place of the first without it.
    fn change(&self, column: usize, mark: &[u8], length: u64) -> Option<(Vec<ByteRecord>, usize)> {
        let (mut low, mut high) = (self.start, length);
        let is_of_mark = |row: &ByteRecord| row[column].trim_ascii() == mark;
        while high - low > PROBE / 2 {
            let middle = low + (high - low) / 2;
            match self.records_at(middle, PROBE).first() {
                Some(row) if is_of_mark(row) => low = middle,
                _ => high = middle,
            }
        }
        let from = low.saturating_sub(PROBE).max(self.start);
        let rows = self.records_at(from.saturating_sub(1), 3 * PROBE);
        let at = rows
            .windows(2)
            .position(|pair| is_of_mark(&pair[0]) && !is_of_mark(&pair[1]))?;
        Some((rows, at + 1))
    }
}
