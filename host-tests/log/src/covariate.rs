//! Covariates: columns of a log that the gyro's rate may depend on, such as a temperature.

use std::str::FromStr;

/// A column of the log, or its rate of change, written `temp_C` or `rate(temp_C)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CovariateChoice {
    /// The column's name in the header, or its number from 1.
    pub column: String,
    /// Whether the covariate is the rate of change of the column.
    pub rate: bool,
}

/// The covariates that are tried.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Covariates {
    /// The temperatures that the log has, by the names of its columns, and their rates of change.
    Found,
    /// These columns.
    Chosen(Vec<CovariateChoice>),
}

impl FromStr for CovariateChoice {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.trim();
        let inner = text.strip_prefix("rate(");
        let (column, rate) = match inner.and_then(|inner| inner.strip_suffix(')')) {
            Some(column) => (column.trim(), true),
            None => (text, false),
        };
        if column.is_empty() {
            return Err("write COLUMN or rate(COLUMN)");
        }
        Ok(Self {
            column: column.to_owned(),
            rate,
        })
    }
}

impl std::fmt::Display for CovariateChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.rate {
            write!(f, "rate({})", self.column)
        } else {
            f.write_str(&self.column)
        }
    }
}

/// The places of the covariates that may act together: a column and its rate of change.
pub(super) fn pairs(choices: &[CovariateChoice]) -> impl Iterator<Item = [usize; 2]> {
    let columns = choices
        .iter()
        .enumerate()
        .filter(|(_, choice)| !choice.rate);
    columns.filter_map(|(at, choice)| {
        let is_rate = |other: &CovariateChoice| other.rate && other.column == choice.column;
        Some([at, choices.iter().position(is_rate)?])
    })
}

/// Turns the counts of a column into those of its covariate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Derived {
    rate: bool,
    previous: Option<i32>,
}

impl Derived {
    pub(super) fn new(choice: &CovariateChoice) -> Self {
        Self {
            rate: choice.rate,
            previous: None,
        }
    }

    /// Tells that the next count does not follow the one before.
    pub(super) fn gap(&mut self) {
        self.previous = None;
    }

    pub(super) fn next(&mut self, count: i32) -> i32 {
        if !self.rate {
            return count;
        }
        let previous = self.previous.replace(count).unwrap_or(count);
        count.saturating_sub(previous)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_their_rates_are_distinguished() {
        let choice: CovariateChoice = " rate( temp_C )".parse().unwrap();
        assert_eq!(
            (choice.column.as_str(), choice.rate, choice.to_string()),
            ("temp_C", true, "rate(temp_C)".into())
        );
        assert!("rate()".parse::<CovariateChoice>().is_err());
        let mut derived = Derived::new(&choice);
        let rates = [5, 7, 4, 4].map(|count| derived.next(count));
        assert_eq!(rates, [0, 2, -3, 0]);
    }
}
