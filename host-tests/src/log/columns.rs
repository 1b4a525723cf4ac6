//! Finds the columns of a log that are the sensor's axes.

use super::{ColumnChoice, CovariateChoice, names};
use crate::{
    failure::{Failure, Place, quoted},
    unit::{Sensor, Unit},
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
}

/// The columns that were taken as axes.
#[derive(Debug)]
pub(super) struct Taken {
    pub(super) axes: Vec<AxisColumn>,
    /// The sensor that the names of the columns indicate.
    pub(super) sensor: Option<Sensor>,
    /// A note that lists the columns that were taken and left out, if the choice is not obvious.
    pub(super) note: Option<String>,
}

/// What a column's first values look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// Numbers.
    Number,
    /// Numbers that rise from every row to the next: a time or an index.
    Rising,
    /// Something else.
    Text,
}

impl Look {
    /// The look of a column whose first values are these numbers.
    pub(super) fn of_numbers(numbers: &[f64]) -> Self {
        // Nine values of white noise rise throughout with a probability of 1 in 9!.
        if numbers.len() > 8 && numbers.is_sorted_by(|a, b| a < b) {
            Self::Rising
        } else {
            Self::Number
        }
    }
}

impl Columns {
    /// The columns that the user asks for, in the order of the request.
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

    /// The sensor that the names of these columns agree on.
    pub(super) fn sensor_of(&self, axes: &[AxisColumn]) -> Option<Sensor> {
        let all_are = |sensor: &Sensor| {
            let is = |axis: &AxisColumn| {
                let name = self.name(axis.column);
                name.is_some_and(|name| names::is_axis(name, *sensor))
            };
            axes.iter().all(is)
        };
        [Sensor::Gyro, Sensor::Accelerometer]
            .into_iter()
            .find(all_are)
    }

    /// The unit that the names of these columns indicate, and the factor from their values to that
    /// unit. Returns `None` if the names indicate none, or if it is not a unit of this sensor.
    ///
    /// # Errors
    /// When the names do not agree on a unit, or when a unit is not known.
    pub(super) fn unit_of(
        &self,
        path: &Path,
        axes: &[AxisColumn],
        sensor: Sensor,
    ) -> Result<Option<(Unit, f64)>, Failure> {
        let of_axis = |axis: &AxisColumn| {
            let unit = names::unit(self.name(axis.column).unwrap_or_default());
            let unit = unit.map_err(|text| {
                Place::file(path).failure(
                    format!(
                        "column {}: the unit {} is not known",
                        self.called(axis.column),
                        quoted(text.as_bytes())
                    ),
                    "give --unit, and --scale with the size of one such unit",
                )
            })?;
            Ok(unit.filter(|(unit, _)| unit.sensor() == sensor))
        };
        let units = axes.iter().map(of_axis);
        let units: Vec<_> = units.collect::<Result<_, Failure>>()?;
        let Some((&unit, others)) = units.split_first() else {
            return Ok(None);
        };
        let first = &axes[0];
        let other = others.iter().position(|other| *other != unit);
        match other.and_then(|other| axes.get(other + 1)) {
            None => Ok(unit),
            Some(other) => Err(Place::file(path).failure(
                format!(
                    "columns {} and {} have different units",
                    self.called(first.column),
                    self.called(other.column)
                ),
                "choose columns of one unit with --columns, or give --unit and --scale",
            )),
        }
    }

    /// The columns that look like axes of the sensor, and a note on the choice if it is not
    /// obvious.
    ///
    /// With a header, these are the columns that are named like axes of the wanted sensor. If no
    /// sensor is wanted, axes of a gyro win over axes of an accelerometer. If no column is named
    /// like an axis, all columns of numbers are taken except those that are times, indices or
    /// temperatures by their names or values. A column that is known to be the time is left out
    /// without a note.
    pub(super) fn guessed(
        &self,
        path: &Path,
        wanted: Option<Sensor>,
        time: &[AxisColumn],
    ) -> Result<Taken, Failure> {
        let count = self.looks.len();
        let is_time = |column: usize| time.iter().any(|time| time.column == column);
        let named = |sensor: Sensor| -> Vec<usize> {
            let is = |column: &usize| {
                let name = self.name(*column);
                name.is_some_and(|name| names::is_axis(name, sensor))
            };
            (0..count).filter(is).collect()
        };
        let sensors = [Sensor::Gyro, Sensor::Accelerometer];
        let found = sensors
            .into_iter()
            .filter(|&sensor| !named(sensor).is_empty())
            .collect::<Vec<_>>();
        let sensor = match wanted {
            None => found.first().copied(),
            Some(wanted) if found.contains(&wanted) || found.is_empty() => Some(wanted),
            Some(wanted) => {
                return Err(Place::file(path).failure(
                    format!("no column is named like an axis of a {wanted}"),
                    "name them with --columns, such as x=3,y=4,z=5",
                ));
            }
        };
        let by_name = sensor.map_or_else(Vec::new, named);
        let taken = if by_name.is_empty() {
            let is_no_axis = |name| names::is_other(name) || names::is_time(name);
            let is_axis = |&column: &usize| {
                self.looks[column] == Look::Number
                    && !is_time(column)
                    && !self.name(column).is_some_and(is_no_axis)
            };
            (0..count).filter(is_axis).collect()
        } else {
            by_name.clone()
        };
        if taken.is_empty() {
            return Err(Place::file(path).failure(
                format!("none of {count} columns looks like an axis"),
                "name them with --columns, such as gx=3,gy=4,gz=5",
            ));
        }

        let conventional = match sensor {
            Some(Sensor::Accelerometer) => ["ax", "ay", "az"],
            _ => ["gx", "gy", "gz"],
        };
        let axes: Vec<AxisColumn> = taken
            .iter()
            .enumerate()
            .map(|(i, &column)| AxisColumn {
                axis: match self.name(column) {
                    Some(name) => names::bare(name).to_owned(),
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
            .filter(|column| !taken.contains(column) && !is_time(*column))
            .collect();
        let note = (by_name.is_empty() || !left.is_empty()).then(|| {
            let taken = self.list(&taken);
            let left = if left.is_empty() {
                "none left out".into()
            } else {
                format!("left out {}", self.list(&left))
            };
            let other = match found.as_slice() {
                [_, other] if wanted.is_none() => format!(" or --sensor {}", other.option()),
                _ => String::new(),
            };
            format!("taken as axes: {taken}; {left} (choose with --columns{other})")
        });
        Ok(Taken { axes, sensor, note })
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

    fn list(&self, columns: &[usize]) -> String {
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
            Some(names) => format!("choose by name from {} or by number", names.join(", ")),
            None => format!("there is no header: choose by number from 1 to {count}"),
        };
        Err(Place::file(path).failure(what, remedy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guess(names: Option<&[&str]>, looks: &[Look]) -> (Vec<String>, Vec<usize>, Option<String>) {
        let columns = Columns {
            names: names.map(|names| names.iter().map(|&name| name.into()).collect()),
            looks: looks.to_vec(),
            heads: Vec::new(),
        };
        let Taken { axes, note, .. } = columns.guessed(Path::new("a.csv"), None, &[]).unwrap();
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
    fn time_and_temperature_beside_gyro_axes_are_left_out_with_a_note() {
        let names = ["t_s", "gx_raw131", "gy_raw131", "temp_C"];
        let (_, columns, note) = guess(Some(&names), &[Look::Number; 4]);
        assert_eq!(columns, [1, 2]);
        assert_eq!(
            note.unwrap(),
            "taken as axes: gx_raw131, gy_raw131; left out t_s, temp_C (choose with --columns)"
        );
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
    fn without_axis_names_all_numbers_but_times_and_temperatures_are_taken() {
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
