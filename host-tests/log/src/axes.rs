//! Finds the columns of a log that are the sensor's axes, and their unit.

use super::{
    axis_names,
    columns::{AxisColumn, Columns, Look},
    convention::{self, Convention},
    names, unit_names,
};
use crate::{
    failure::{Failure, Place, quoted},
    unit::{Sensor, Unit},
};
use std::path::Path;

/// The columns that were taken as axes.
#[derive(Debug)]
pub(super) struct Taken {
    pub(super) axes: Vec<AxisColumn>,
    /// The sensor that the names of the columns indicate.
    pub(super) sensor: Option<Sensor>,
    /// A note that lists the columns that were taken and left out, if the choice is not obvious.
    pub(super) note: Option<String>,
}

impl Columns {
    /// The sensor that the names of these columns agree on, or those of the axes where the columns have none.
    pub(super) fn sensor_of(&self, axes: &[AxisColumn]) -> Option<Sensor> {
        let all_are = |sensor: &Sensor| {
            let is = |axis: &AxisColumn| {
                let name = self.name(axis.column).unwrap_or(&axis.axis);
                axis_names::is_axis(name, *sensor)
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
            let name = self.name(axis.column).unwrap_or_default();
            if names::is_angle(name) {
                return Err(Place::file(path).failure(
                    format!("column {name} is an angle, not a rate"),
                    "choose the columns of a gyro with --columns, or give --unit and --scale if the name is wrong",
                ));
            }
            let unit = unit_names::unit(name);
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

    /// The columns that are axes of a sensor by the definition of the log's format, or else by their names, or else
    /// because they are named `x`, `y` and `z` and the file says of which sensor they are.
    pub(super) fn axes_of(&self, sensor: Sensor) -> Vec<usize> {
        let all = 0..self.looks.len();
        if !self.defined.is_empty() {
            let of_sensor = |&column: &usize| self.defined.contains(&(column, sensor));
            return all.filter(of_sensor).collect();
        }
        let named = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
            let is = |column: &usize| {
                self.looks[*column] != Look::Date && self.name(*column).is_some_and(is)
            };
            all.clone().filter(is).collect()
        };
        let mut by_name = named(&|name| axis_names::is_axis(name, sensor));
        // Increments of an angle beside rates say the same once more.
        let is_rate = |column: &usize| !self.name(*column).is_some_and(names::is_increment);
        if by_name.iter().any(is_rate) {
            by_name.retain(is_rate);
        }
        let any = [Sensor::Gyro, Sensor::Accelerometer];
        let none_is_named = || {
            any.iter()
                .all(|&sensor| named(&|name| axis_names::is_axis(name, sensor)).is_empty())
        };
        if by_name.is_empty()
            && convention::sensor_said(&self.said) == Some(sensor)
            && none_is_named()
        {
            let mut bare = named(&convention::is_bare_axis);
            bare.sort_by_key(|&column| self.name(column).map(str::to_lowercase));
            return bare;
        }
        if by_name.is_empty() && sensor == Sensor::Gyro {
            return named(&names::is_increment);
        }
        by_name
    }

    /// Three columns of numbers, one behind the other, that are the axes of something which their names do not tell.
    fn unknown_triple(&self, known: &[usize]) -> Option<[usize; 3]> {
        let is_free = |column: usize| {
            let name = self.name(column)?;
            let is_other = names::is_other(name) || names::is_time(name);
            let is_free = self.looks[column] == Look::Number && !known.contains(&column);
            (is_free && !is_other && !convention::is_bare_axis(name)).then_some(name)
        };
        let starts = 0..self.looks.len().saturating_sub(2);
        starts
            .map(|first| [first, first + 1, first + 2])
            .find(|columns| match columns.map(is_free) {
                [Some(x), Some(y), Some(z)] => axis_names::are_triple([x, y, z]),
                _ => false,
            })
    }

    /// Whether these axes of a gyro stand beside three of an accelerometer that feel 9.3 to 10.3 units of gravity, and
    /// scatter less than rates in deg/s do: then both are in units of the SI.
    pub(super) fn is_in_si(&self, axes: &[AxisColumn]) -> bool {
        const GRAVITY: std::ops::Range<f64> = 9.3..10.3;
        // No gyro that has an accelerometer beside it is as quiet as 0.02 °/s in a sample. Chosen by hand.
        const QUIET: f64 = 0.02;
        let beside = self.axes_of(Sensor::Accelerometer);
        let beside = match beside.as_slice() {
            &[x, y, z] => Some([x, y, z]),
            [] => self.gravity_beside(axes),
            _ => None,
        };
        let Some(beside) = beside else {
            return false;
        };
        let norm = self.norm(beside);
        let scatter = |axis: &AxisColumn| {
            let head = &self.heads[axis.column];
            let squares = head.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
            (0.5 * squares.sum::<f64>() / (head.len().max(2) - 1) as f64).sqrt()
        };
        let is_gyro = self.sensor_of(axes) == Some(Sensor::Gyro);
        is_gyro && GRAVITY.contains(&norm) && axes.iter().all(|axis| scatter(axis) < QUIET)
    }

    /// Whether these are three axes of an accelerometer that feel 0.95 to 1.05 units of gravity: then their unit is g.
    pub(super) fn is_in_g(&self, axes: &[AxisColumn]) -> bool {
        let [x, y, z] = axes else {
            return false;
        };
        let is_accelerometer = self.sensor_of(axes) == Some(Sensor::Accelerometer);
        is_accelerometer && (0.95..1.05).contains(&self.norm([x, y, z].map(|axis| axis.column)))
    }

    /// The length of the mean of three columns.
    fn norm(&self, columns: [usize; 3]) -> f64 {
        let mean = |column: usize| {
            let head = &self.heads[column];
            head.iter().sum::<f64>() / head.len() as f64
        };
        let squares = columns.map(|column| mean(column).powi(2));
        squares.iter().sum::<f64>().sqrt()
    }

    /// The convention that all these columns follow.
    pub(super) fn convention_of(&self, axes: &[AxisColumn]) -> Option<Convention> {
        let of = |axis: &AxisColumn| convention::of(self.name(axis.column)?, &self.said);
        let (first, others) = axes.split_first()?;
        of(first).filter(|first| others.iter().all(|other| of(other).as_ref() == Some(first)))
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
        let named = |sensor: Sensor| self.axes_of(sensor);
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
        if wanted.is_none()
            && let (Some(Sensor::Accelerometer), Some(unknown)) =
                (sensor, self.unknown_triple(&by_name))
        {
            let [first, .., last] = unknown;
            return Err(Place::file(path).failure(
                format!(
                    "{} to {} may be the axes of a gyro, and {} are those of an accelerometer",
                    self.called(first),
                    self.called(last),
                    self.list(&by_name)
                ),
                format!(
                    "choose with --sensor accel, or with --columns gx={},gy={},gz={}",
                    first + 1,
                    unknown[1] + 1,
                    last + 1
                ),
            ));
        }
        let mut sensor = sensor;
        let taken = if by_name.is_empty() {
            let is_no_axis = |name| names::is_other(name) || names::is_time(name);
            let is_axis = |&column: &usize| {
                self.looks[column] == Look::Number
                    && !is_time(column)
                    && !self.name(column).is_some_and(is_no_axis)
            };
            let all: Vec<usize> = (0..count).filter(is_axis).collect();
            match self.told_by_values(path, wanted, &all)? {
                Some((told, taken)) => {
                    sensor = Some(told);
                    taken
                }
                None => all,
            }
        } else {
            by_name.clone()
        };
        if taken.is_empty() {
            return Err(Place::file(path).failure(
                match count {
                    1 => "the only column does not look like an axis".into(),
                    _ => format!("none of {count} columns looks like an axis"),
                },
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
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guess(names: Option<&[&str]>, looks: &[Look]) -> (Vec<String>, Vec<usize>, Option<String>) {
        let columns = Columns {
            names: names.map(|names| names.iter().map(|&name| name.into()).collect()),
            looks: looks.to_vec(),
            heads: Vec::new(),
            longer: Vec::new(),
            tags: Vec::new(),
            defined: Vec::new(),
            said: String::new(),
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
