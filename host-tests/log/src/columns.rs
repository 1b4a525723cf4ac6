//! Finds the columns of a log that are the sensor's axes.

use super::{ColumnChoice, CovariateChoice, names, wrap::BITS};
use crate::{
    failure::{Failure, Place, did_you_mean, quoted},
    unit::Sensor,
};
use std::path::Path;

/// The most temperatures that are tried without being asked for. Every one of them raises the threshold of all. Chosen
/// by hand: one of the sensor and one of its surroundings.
const MOST_TEMPERATURES: usize = 2;

/// An axis and the column that holds it, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AxisColumn {
    pub(super) axis: String,
    pub(super) column: usize,
}

/// What the header and the first rows of a log show about its columns.
#[derive(Debug)]
pub(super) struct Columns {
    /// The names in the header, if there is one.
    pub(super) names: Option<Vec<String>>,
    /// What the first values of each column look like.
    pub(super) looks: Vec<Look>,
    /// The first values of each column that are numbers.
    pub(super) heads: Vec<Vec<f64>>,
    /// More of the first values of each column of numbers or dates, where the log is a text.
    pub(super) longer: Vec<Vec<f64>>,
    /// The first values of each column of text, if they are known, and of each column of numbers that mark sensors.
    pub(super) tags: Vec<Vec<String>>,
    /// The columns that are axes by the definition of the log's format, and their sensors. If there are any, names
    /// are not searched for axes.
    pub(super) defined: Vec<(usize, Sensor)>,
    /// The file's name and what stands above the rows, in lower case. It may tell which program wrote them.
    pub(super) said: String,
}

/// What a column's first values look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// Numbers.
    Number,
    /// Numbers that rise from every row to the next: a time or an index.
    Rising,
    /// Dates and times, or times of day.
    Date,
    /// Something else.
    Text,
}

impl Look {
    /// The look of a column whose first values are these numbers.
    pub(super) fn of_numbers(numbers: &[f64]) -> Self {
        // Nine values of white noise rise throughout with a probability of 1 in 9!.
        let rises = || numbers.is_sorted_by(|a, b| a < b) || rises_but_for_an_overflow(numbers);
        if numbers.len() > 8 && rises() {
            Self::Rising
        } else {
            Self::Number
        }
    }
}

/// Whether numbers rise throughout but for one fall, from just below the largest count of a timer to just above zero.
fn rises_but_for_an_overflow(numbers: &[f64]) -> bool {
    let mut falls = (1..numbers.len()).filter(|&at| numbers[at] <= numbers[at - 1]);
    let (Some(at), None) = (falls.next(), falls.next()) else {
        return false;
    };
    let (before, behind) = numbers.split_at(at);
    let ([first, .., last], [zero, .., end]) = (before, behind) else {
        return false;
    };
    let step = (last - first + end - zero) / (numbers.len() - 2) as f64;
    let is_near = |distance: f64| (0.0..4.0 * step).contains(&distance);
    let mut largest = BITS.into_iter().map(|bits| 2f64.powi(bits));
    is_near(*zero) && largest.any(|largest| is_near(largest - last))
}

impl Columns {
    /// The columns that the user asks for, in the order of the request.
    pub(super) fn chosen(
        &self,
        path: &Path,
        choices: &[ColumnChoice],
    ) -> Result<Vec<AxisColumn>, Failure> {
        let mut axes: Vec<AxisColumn> = Vec::new();
        let parts = |choice: &ColumnChoice| self.parts(choice);
        for choice in choices.iter().flat_map(parts) {
            let column = self.find(path, &choice.column)?;
            let axis = match &choice.axis {
                Some(axis) => axis.clone(),
                None => self.name(column).map_or_else(
                    || format!("c{}", column + 1),
                    |name| names::bare(name).into(),
                ),
            };
            if let Some(twice) = axes.iter().find(|a| a.column == column || a.axis == axis) {
                return Err(Failure::option(
                    format!(
                        "--columns names {} twice",
                        quoted(
                            if twice.axis == axis {
                                &axis
                            } else {
                                &choice.column
                            }
                            .as_bytes()
                        )
                    ),
                    "name every axis and every column once",
                ));
            }
            axes.push(AxisColumn { axis, column });
        }
        Ok(axes)
    }

    /// The elements of the array that a choice names, as `gyro_rad` names `gyro_rad[0]` to `gyro_rad[2]`, or otherwise
    /// the choice itself.
    fn parts(&self, choice: &ColumnChoice) -> Vec<ColumnChoice> {
        let names = self.names.iter().flatten().map(|name| names::bare(name));
        let is_part = |name: &&str| {
            let rest = name.strip_prefix(choice.column.as_str());
            rest.is_some_and(|rest| matches!(rest, "[0]" | "[1]" | "[2]" | ".x" | ".y" | ".z"))
        };
        let parts: Vec<&str> = names.clone().filter(is_part).collect();
        let is_column = names.clone().any(|name| name == choice.column);
        if is_column || choice.axis.is_some() || parts.is_empty() {
            return vec![choice.clone()];
        }
        let part = |part: &&str| ColumnChoice {
            axis: None,
            column: (*part).to_owned(),
        };
        parts.iter().map(part).collect()
    }

    /// The columns of the covariates. None of them may be an axis.
    pub(super) fn covariates(
        &self,
        path: &Path,
        choices: &[CovariateChoice],
        axes: &[AxisColumn],
    ) -> Result<Vec<AxisColumn>, Failure> {
        let one = |(i, choice): (usize, &CovariateChoice)| {
            let column = self.find(path, &choice.column)?;
            let fail = |what: &str, remedy: &str| {
                let name = quoted(choice.to_string().as_bytes());
                Err(Failure::option(
                    format!("--covariates {name} {what}"),
                    remedy,
                ))
            };
            if axes.iter().any(|axis| axis.column == column) {
                return fail(
                    "is an axis",
                    "name a column that is not an axis, or give --columns",
                );
            }
            if choices[..i].contains(choice) {
                return fail("is named twice", "name every covariate once");
            }
            Ok(AxisColumn {
                axis: choice.to_string(),
                column,
            })
        };
        choices.iter().enumerate().map(one).collect()
    }

    /// The temperatures by the names of their columns, and their rates of change, as covariates. Axes are not among
    /// them.
    pub(super) fn temperatures(&self, axes: &[AxisColumn]) -> Vec<(CovariateChoice, AxisColumn)> {
        let is_temperature = |&column: &usize| {
            self.looks[column] != Look::Text
                && axes.iter().all(|axis| axis.column != column)
                && self.name(column).is_some_and(names::is_temperature)
        };
        let mut found: Vec<(CovariateChoice, AxisColumn)> = Vec::new();
        for column in (0..self.looks.len()).filter(is_temperature) {
            let name = self.name(column).unwrap_or_default();
            let is_twice = found.iter().any(|(choice, _)| choice.column == name);
            if is_twice || found.len() >= 2 * MOST_TEMPERATURES {
                continue;
            }
            found.extend([false, true].map(|rate| {
                let choice = CovariateChoice {
                    column: name.to_owned(),
                    rate,
                };
                let axis = choice.to_string();
                (choice, AxisColumn { axis, column })
            }));
        }
        found
    }

    /// The name of a column in messages.
    pub(super) fn called(&self, column: usize) -> String {
        match self.name(column) {
            Some(name) => name.to_owned(),
            None => format!("column {}", column + 1),
        }
    }

    pub(super) fn name(&self, column: usize) -> Option<&str> {
        self.names
            .as_ref()
            .map(|names| names[column].as_str())
            .filter(|name| !name.is_empty())
    }

    pub(super) fn list(&self, columns: &[usize]) -> String {
        let one = |&column: &usize| self.called(column);
        columns.iter().map(one).collect::<Vec<_>>().join(", ")
    }

    /// The column with this name, with or without its unit, or else with this number, counted from
    /// 1.
    pub(super) fn find(&self, path: &Path, wanted: &str) -> Result<usize, Failure> {
        let count = self.looks.len();
        let named_by = |name: fn(&str) -> &str| -> Vec<usize> {
            (0..count)
                .filter(|&column| self.name(column).map(name) == Some(wanted))
                .collect()
        };
        let mut named = named_by(|name| name);
        if named.is_empty() {
            named = named_by(names::bare);
        }
        match (named.as_slice(), wanted.parse::<usize>()) {
            (&[column], _) => return Ok(column),
            ([], Ok(number)) if (1..=count).contains(&number) => return Ok(number - 1),
            _ => {}
        }
        let what = if named.len() > 1 {
            format!(
                "{} columns are named {}",
                named.len(),
                quoted(wanted.as_bytes())
            )
        } else {
            format!("there is no column {}", quoted(wanted.as_bytes()))
        };
        let remedy = match &self.names {
            Some(names) => {
                let hint = did_you_mean(wanted, names.iter().map(String::as_str));
                format!(
                    "{hint}choose by name from {} or by number",
                    names.join(", ")
                )
            }
            None => format!("there is no header: choose by number from 1 to {count}"),
        };
        Err(Place::file(path).failure(what, remedy))
    }
}
