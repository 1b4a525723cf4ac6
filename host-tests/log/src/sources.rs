//! Rows of several sensors in one table, and values with other characters around them.

use super::{
    columns::{Columns, Look},
    field::{Field as _, Flaw, Text},
    names,
};
use crate::failure::{Failure, Place, quoted};
use std::path::Path;

/// The most sensors whose rows are recognised in one table. More values are those of a quantity. Chosen by hand.
const MOST: usize = 32;

/// The same for marks that may be numbers, or for which the rows need not change often. Chosen by hand.
const MOST_NUMBERS: usize = 8;

/// The most marks that a message shows.
const MOST_SHOWN: usize = 8;

/// A larger number that stands in the first rows may be the seconds of a time. Chosen by hand.
const MOST_NUMBER: f64 = 1e8;

/// Rows change from one sensor to another at least so often among the first ones. A label of what is done changes less often.
/// Chosen by hand.
const CHANGES: usize = 4;

fn is_word(mark: &str) -> bool {
    mark.starts_with(char::is_alphabetic)
}

impl Columns {
    /// Checks that the rows are those of one sensor: no column of names or of numbers of sensors changes to and fro.
    ///
    /// # Errors
    /// When the first rows are those of several sensors.
    pub(super) fn check_sources(&self, path: &Path) -> Result<(), Failure> {
        for column in 0..self.looks.len() {
            let rows = self.marks(column);
            let mut marks = rows.clone();
            marks.sort_unstable();
            marks.dedup();
            let changes = rows.windows(2).filter(|pair| pair[0] != pair[1]).count();
            // Many marks come again and again, unlike the values of a quantity.
            let is_again = marks.len() <= MOST_NUMBERS || changes >= CHANGES * marks.len();
            let is_mixed = (2..=MOST).contains(&marks.len())
                && changes >= CHANGES
                && is_again
                && (marks.len() <= MOST_NUMBERS || marks.iter().all(|mark| is_word(mark)))
                && 2 * marks.len() <= rows.len();
            if !is_mixed {
                continue;
            }
            let mut shown: Vec<String> = marks.iter().map(|mark| quoted(mark.as_bytes())).collect();
            if shown.len() > MOST_SHOWN {
                shown.truncate(MOST_SHOWN);
                shown.push("…".into());
            }
            let called = match self.name(column) {
                Some(name) => format!("column {name}"),
                None => self.called(column),
            };
            return Err(Place::file(path).failure(
                format!(
                    "the rows are those of {} sensors, by {called}: {}",
                    marks.len(),
                    shown.join(", ")
                ),
                format!(
                    "keep those of one of them, such as with --rows {}={}",
                    self.name(column)
                        .map_or_else(|| (column + 1).to_string(), str::to_owned),
                    marks[0]
                ),
            ));
        }
        Ok(())
    }

    /// The marks of a column that may tell sensors apart, of each of the first rows.
    fn marks(&self, column: usize) -> Vec<String> {
        if let Some(tags) = self.tags.get(column).filter(|tags| !tags.is_empty()) {
            return tags.clone();
        }
        let numbers = &self.heads[column];
        let is_whole = numbers.iter().all(|number| number.fract() == 0.0);
        match self.looks[column] {
            Look::Number if is_whole && self.name(column).is_some_and(names::is_source) => {
                numbers.iter().map(f64::to_string).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The failure of stamps at a row that is of another sensor than the first rows: a column of names or of numbers of sensors
    /// has another value there. `None` if no column has.
    pub(super) fn of_other_sensor<'a>(
        &self,
        field: &impl Fn(usize) -> &'a [u8],
        flaw: &Flaw,
        place: impl FnOnce() -> Place,
    ) -> Option<Failure> {
        let first = |column: usize| -> Option<String> {
            let head = self.heads.get(column)?;
            match self.looks[column] {
                Look::Text => {
                    let first = self.tags.get(column)?.first().cloned();
                    first.filter(|first| !first.is_empty())
                }
                Look::Number
                    if head
                        .iter()
                        .all(|one| *one == head[0] && one.abs() < MOST_NUMBER) =>
                {
                    Some(head.first()?.to_string())
                }
                _ => None,
            }
        };
        let is_other = |first: &str, text: &[u8]| {
            let number = Text(text).number().ok();
            first.as_bytes() != text && number.is_none_or(|number| first.parse() != Ok(number))
        };
        let mut columns = (0..self.looks.len()).filter_map(|column| Some((column, first(column)?)));
        let (column, first) =
            columns.find(|(column, first)| is_other(first, field(*column).trim_ascii()))?;
        let called = match self.name(column) {
            Some(name) => name.to_owned(),
            None => (column + 1).to_string(),
        };
        let other = quoted(field(column).trim_ascii());
        Some(place().failure(
            format!(
                "{}, where column {called} changes from {} to {other}",
                flaw.what,
                quoted(first.as_bytes())
            ),
            format!("keep the rows of one sensor, such as with --rows {called}={first}"),
        ))
    }

    /// Checks that no column of numbers has brackets or the like around its values, by which it would be lost.
    ///
    /// # Errors
    /// When the first values of a column are such numbers.
    pub(super) fn check_glued(&self, path: &Path) -> Result<(), Failure> {
        for (column, tags) in self.tags.iter().enumerate() {
            let is_glued = |tag: &String| {
                let bare = tag.trim_matches(|one| "[](){};".contains(one));
                bare.len() < tag.len() && bare.trim().parse::<f64>().is_ok()
            };
            if let Some(first) = tags.first()
                && tags.iter().all(is_glued)
            {
                return Err(Place::file(path).failure(
                    format!(
                        "the values of {} have other characters around them, such as {}",
                        self.called(column),
                        quoted(first.as_bytes())
                    ),
                    "remove them, such as with `tr -d '[](){};'`",
                ));
            }
        }
        Ok(())
    }
}
