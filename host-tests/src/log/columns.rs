//! Which columns of a log are gyro axes.

use super::{ColumnChoice, CovariateChoice};
use crate::failure::{Failure, Place, quoted};
use std::path::Path;

/// An axis and the column that holds it, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AxisColumn {
    pub(super) axis: String,
    pub(super) column: usize,
}

/// What the first rows of a log say about its columns.
#[derive(Debug)]
pub(super) struct Columns {
    /// Names of the header, if there is one.
    pub(super) names: Option<Vec<String>>,
    /// Of each column: what its first values are.
    pub(super) looks: Vec<Look>,
}

/// What a column's first values look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// Numbers.
    Number,
    /// Numbers that rise from row to row throughout: a time or an index.
    Rising,
    /// Something else.
    Text,
}

impl Look {
    /// The look of a column that begins with these numbers.
    pub(super) fn of_numbers(numbers: &[f64]) -> Self {
        // Noise rises eight times in a row once in 9! times.
        if numbers.len() > 8 && numbers.is_sorted_by(|a, b| a < b) {
            Self::Rising
        } else {
            Self::Number
        }
    }
}

impl Columns {
    /// The columns asked for, in that order.
    pub(super) fn chosen(
        &self,
        path: &Path,
        choices: &[ColumnChoice],
    ) -> Result<Vec<AxisColumn>, Failure> {
        let mut axes: Vec<AxisColumn> = Vec::new();
        for choice in choices {
            let column = self.find(path, &choice.column)?;
            let axis = match &choice.axis {
                Some(axis) => axis.clone(),
                None => self
                    .name(column)
                    .map_or_else(|| format!("c{}", column + 1), Into::into),
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

    /// The columns of the covariates, none of which is an axis.
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
                    "name a column that is none, or give --columns",
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

    /// The columns that look like a gyro's, and a note on the choice where it is not obvious: with
    /// a header, those named like a gyro's axes; where there are none, all numbers that neither
    /// by name nor by their values are times, indices or temperatures.
    pub(super) fn guessed(
        &self,
        path: &Path,
    ) -> Result<(Vec<AxisColumn>, Option<String>), Failure> {
        let count = self.looks.len();
        let is_gyro = |&column: &usize| self.name(column).is_some_and(is_gyro_name);
        let by_name: Vec<usize> = (0..count).filter(is_gyro).collect();
        let taken = if by_name.is_empty() {
            let is_axis = |&column: &usize| {
                self.looks[column] == Look::Number && !self.name(column).is_some_and(is_other_name)
            };
            (0..count).filter(is_axis).collect()
        } else {
            by_name.clone()
        };
        if taken.is_empty() {
            return Err(Place::file(path).failure(
                format!("none of {} columns looks like a gyro's axis", count),
                "name them with --columns, such as gx=3,gy=4,gz=5",
            ));
        }

        let conventional = ["gx", "gy", "gz"];
        let axes: Vec<AxisColumn> = taken
            .iter()
            .enumerate()
            .map(|(i, &column)| AxisColumn {
                axis: match self.name(column) {
                    Some(name) => name.to_owned(),
                    None if taken.len() <= conventional.len() => conventional[i].to_owned(),
                    None => format!("c{}", column + 1),
                },
                column,
            })
            .collect();
        let is_twice = |a: &&AxisColumn| axes.iter().any(|b| *a != b && a.axis == b.axis);
        if let Some(twice) = axes.iter().find(is_twice) {
            return Err(Place::file(path).failure(
                format!("two columns are named {}", quoted(twice.axis.as_bytes())),
                "tell them apart by number, such as --columns gx=1,gy=2",
            ));
        }

        let left: Vec<usize> = (0..count)
            .filter(|column| !taken.contains(column))
            .collect();
        let note = (by_name.is_empty() || !left.is_empty()).then(|| {
            let taken = self.list(&taken);
            let left = if left.is_empty() {
                "none left out".into()
            } else {
                format!("left out {}", self.list(&left))
            };
            format!("taken as axes: {taken}; {left} (choose with --columns)")
        });
        Ok((axes, note))
    }

    fn name(&self, column: usize) -> Option<&str> {
        self.names
            .as_ref()
            .map(|names| names[column].as_str())
            .filter(|name| !name.is_empty())
    }

    fn list(&self, columns: &[usize]) -> String {
        let one = |&column: &usize| match self.name(column) {
            Some(name) => name.to_owned(),
            None => format!("column {}", column + 1),
        };
        columns.iter().map(one).collect::<Vec<_>>().join(", ")
    }

    /// The column of that name, else of that number from 1.
    fn find(&self, path: &Path, wanted: &str) -> Result<usize, Failure> {
        let count = self.looks.len();
        let named: Vec<usize> = (0..count)
            .filter(|&column| self.name(column) == Some(wanted))
            .collect();
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
            Some(names) => format!("choose by name from {} or by number", names.join(", ")),
            None => format!("there is no header: choose by number from 1 to {count}"),
        };
        Err(Place::file(path).failure(what, remedy))
    }
}

/// `gx`, `gyro_y`, `imu.angular_velocity.z`, `w_RS_S_x [rad s^-1]`, and the like.
fn is_gyro_name(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    if ["temp", "time", "cov", "bias"]
        .iter()
        .any(|other| name.contains(other))
    {
        return false;
    }
    let short = ["gx", "gy", "gz", "wx", "wy", "wz", "w_rs_s_"]
        .iter()
        .any(|axis| {
            let rest = name.strip_prefix(axis);
            rest.is_some_and(|rest| axis.len() > 2 || !rest.starts_with(char::is_alphabetic))
        });
    let long = [
        "gyr",
        "angular_velocity",
        "angularvelocity",
        "angular_rate",
        "ang_vel",
        "omega",
    ];
    short || long.iter().any(|part| name.contains(part))
}

/// A time, an index or a temperature.
fn is_other_name(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let words = ["time", "stamp", "date", "index", "temp", "sample", "seq"];
    let first = name
        .split(|c: char| !c.is_alphanumeric())
        .next()
        .unwrap_or_default();
    words.iter().any(|word| name.contains(word))
        || [
            "t", "s", "ms", "us", "ns", "sec", "nsec", "secs", "nsecs", "i", "n", "id",
        ]
        .contains(&first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guess(names: Option<&[&str]>, looks: &[Look]) -> (Vec<String>, Vec<usize>, Option<String>) {
        let columns = Columns {
            names: names.map(|names| names.iter().map(|&name| name.into()).collect()),
            looks: looks.to_vec(),
        };
        let (axes, note) = columns.guessed(Path::new("a.csv")).unwrap();
        (
            axes.iter().map(|axis| axis.axis.clone()).collect(),
            axes.iter().map(|axis| axis.column).collect(),
            note,
        )
    }

    #[test]
    fn header_of_gyro_axes_alone_needs_no_note() {
        let (axes, columns, note) = guess(Some(&["gx", "gy", "gz"]), &[Look::Number; 3]);
        assert_eq!(
            (axes.join(" "), columns, note),
            ("gx gy gz".into(), vec![0, 1, 2], None)
        );
    }

    #[test]
    fn time_and_temperature_beside_gyro_axes_are_left_out_aloud() {
        let names = ["t_s", "gx_raw131", "gy_raw131", "temp_C"];
        let (_, columns, note) = guess(Some(&names), &[Look::Number; 4]);
        assert_eq!(columns, [1, 2]);
        assert_eq!(
            note.unwrap(),
            "taken as axes: gx_raw131, gy_raw131; left out t_s, temp_C (choose with --columns)"
        );
    }

    #[test]
    fn usual_names_of_gyro_axes_are_known() {
        for name in [
            "gx",
            "GyroX",
            "gyro_y [deg/s]",
            "gyrADC[0]",
            "angular_velocity.z",
            "w_RS_S_x [rad s^-1]",
            "wx",
        ] {
            assert!(is_gyro_name(name), "{name}");
        }
        for name in [
            "t",
            "ax",
            "gyro_temp",
            "gxyz",
            "angular_velocity_covariance_0",
            "weight",
        ] {
            assert!(!is_gyro_name(name), "{name}");
        }
    }

    #[test]
    fn rising_column_without_a_name_is_taken_for_time() {
        let looks = [Look::Rising, Look::Number, Look::Number, Look::Number];
        let (axes, columns, note) = guess(None, &looks);
        assert_eq!(
            (axes.join(" "), columns),
            ("gx gy gz".into(), vec![1, 2, 3])
        );
        assert!(note.unwrap().contains("left out column 1"));
    }

    #[test]
    fn names_of_no_gyro_leave_all_numbers_but_times_and_temperatures() {
        let names = ["timestamp", "x", "y", "label", "temperature"];
        let looks = [
            Look::Number,
            Look::Number,
            Look::Number,
            Look::Text,
            Look::Number,
        ];
        assert_eq!(guess(Some(&names), &looks).1, [1, 2]);
    }
}
