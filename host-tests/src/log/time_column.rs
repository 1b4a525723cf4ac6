//! Finds the column of a log that holds its time stamps, and their unit.

use super::{
    Options,
    clock::Pace,
    columns::{AxisColumn, Columns, Look},
    names::{self, TimeUnit},
};
use crate::failure::{Failure, Place, quoted};
use std::path::Path;

/// A column of time stamps, or two columns: the seconds and nanoseconds of messages of ROS.
#[derive(Clone, Debug)]
pub(super) struct TimeColumn {
    pub(super) columns: Vec<AxisColumn>,
    pub(super) pace: Pace,
    pub(super) unit: TimeUnit,
}

impl Columns {
    /// The time column. It is the column that the options name, or else the two columns of seconds
    /// and nanoseconds. Without these, it is the first column that is named like a time and
    /// advances in the first rows, or the only column without a name that rises by steps other than
    /// one.
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
        if let Some(pair) = self.seconds_and_nanoseconds() {
            return Ok(Some(pair));
        }
        let named = |column: &usize| self.name(*column).is_some_and(names::is_time);
        let mut by_name: Vec<usize> = (0..count).filter(named).collect();
        // A message has several times. The one at which the sensor was sampled comes first.
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
            columns: vec![self.time_axis(column)],
            pace,
            unit,
        })
    }

    fn time_axis(&self, column: usize) -> AxisColumn {
        AxisColumn {
            axis: names::bare(&self.called(column)).to_owned(),
            column,
        }
    }

    /// The two columns of a name such as `header.stamp.sec` and `header.stamp.nanosec`.
    fn seconds_and_nanoseconds(&self) -> Option<TimeColumn> {
        let all = || 0..self.looks.len();
        let lower = |column: usize| self.name(column).map(str::to_lowercase);
        all().find_map(|seconds| {
            let name = lower(seconds)?;
            let prefix = name.strip_suffix("secs").or(name.strip_suffix("sec"))?;
            let is_behind = |column: &usize| {
                let name = lower(*column).unwrap_or_default();
                let rest = name.strip_prefix(prefix);
                rest.is_some_and(|rest| ["nsec", "nsecs", "nanosec"].contains(&rest))
            };
            let behind = all().find(is_behind)?;
            let rows = self.heads[seconds].iter().zip(&self.heads[behind]);
            let first: Vec<f64> = rows.map(|(sec, nanosec)| sec * 1e9 + nanosec).collect();
            let (pace, unit) = Pace::of(&first, Some(TimeUnit::Ns))?;
            Some(TimeColumn {
                columns: vec![self.time_axis(seconds), self.time_axis(behind)],
                pace,
                unit,
            })
        })
    }
}

impl TimeColumn {
    /// The name of the column in messages.
    pub(super) fn name(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|one| one.axis.as_str()).collect();
        names.join(" and ")
    }
}

fn is_index(numbers: &[f64]) -> bool {
    numbers.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
}
