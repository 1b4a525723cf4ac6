//! Which column of a log is its time, and in which unit.

use super::{
    AxisColumn, Options,
    clock::Pace,
    columns::{Columns, Look},
    names::{self, TimeUnit},
};
use crate::failure::{Failure, Place, quoted};
use std::path::Path;

/// A column of time stamps.
#[derive(Clone, Debug)]
pub(super) struct TimeColumn {
    pub(super) column: AxisColumn,
    pub(super) pace: Pace,
    pub(super) unit: TimeUnit,
}

impl Columns {
    /// The column that the options name; without, the first that by its name is a time and
    /// advances in the first rows, or the only one without a name that rises by more than one.
    pub(super) fn time(
        &self,
        path: &Path,
        options: &Options,
    ) -> Result<Option<TimeColumn>, Failure> {
        let count = self.looks.len();
        if let Some(wanted) = &options.time {
            let column = self.find(path, wanted)?;
            return self.time_in(column, options).map(Some).ok_or_else(|| {
                Place::file(path).failure(
                    format!(
                        "column {} holds no time stamps that advance",
                        quoted(wanted.as_bytes())
                    ),
                    "name another with --time, or give --rate",
                )
            });
        }
        let named = |column: &usize| self.name(*column).is_some_and(names::is_time);
        let mut by_name: Vec<usize> = (0..count).filter(named).collect();
        // Of a message's many times, that at which the sensor was sampled.
        let is_sensors = |column: &usize| {
            let name = self.name(*column).unwrap_or_default();
            name.contains("header.stamp") || name.contains("timestamp_sample")
        };
        by_name.sort_by_key(|column| !is_sensors(column));
        let found = by_name
            .into_iter()
            .find_map(|column| self.time_in(column, options));
        Ok(found.or_else(|| {
            let unnamed = |column: &usize| {
                self.name(*column).is_none()
                    && self.looks[*column] == Look::Rising
                    && !is_index(&self.heads[*column])
            };
            let mut unnamed = (0..count).filter(unnamed);
            let column = unnamed.next().filter(|_| unnamed.next().is_none())?;
            self.time_in(column, options)
        }))
    }

    fn time_in(&self, column: usize, options: &Options) -> Option<TimeColumn> {
        if self.looks[column] == Look::Text {
            return None;
        }
        let name = self.name(column);
        let told = options
            .time_unit
            .or_else(|| name.and_then(TimeUnit::of_name));
        let (pace, unit) = Pace::of(&self.heads[column], told)?;
        Some(TimeColumn {
            column: AxisColumn {
                axis: names::bare(&self.called(column)).to_owned(),
                column,
            },
            pace,
            unit,
        })
    }
}

fn is_index(numbers: &[f64]) -> bool {
    numbers.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
}
