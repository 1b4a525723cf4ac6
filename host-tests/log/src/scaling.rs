//! Finds the size of one count of a log from the options, the comments and the names of columns, in
//! this order.

use super::{Axis, Options, columns::AxisColumn, gyroflow, table::Table};
use crate::{
    failure::{Failure, Place},
    unit::{Sensor, Unit},
};
use std::path::Path;

/// The scale and the unit of a log's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scaling {
    /// The scale, in units per count.
    pub(super) scale: f64,
    pub(super) unit: Unit,
    /// Whether the scale is given. Otherwise it is assumed to be 1.
    pub(super) scale_is_told: bool,
    pub(super) origin: Origin,
}

/// Where the unit comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// The unit is given by an option or a comment.
    Told,
    /// The unit is in the names of the columns.
    Names,
    /// The unit is the one that a program always uses.
    Convention(&'static str),
    /// The unit is the one that goes with an accelerometer in m/s² beside the gyro.
    Beside,
    /// The unit and the scale are in the header of Gyroflow's log.
    Header,
    /// The unit is that in which an accelerometer feels gravity as 1.
    Gravity,
    /// The unit is assumed.
    Assumed,
}

/// The sensor that the options ask for, by itself or by its unit.
pub(super) fn wanted_sensor(options: &Options) -> Result<Option<Sensor>, Failure> {
    match (options.sensor, options.unit) {
        (Some(sensor), Some(unit)) if sensor != unit.sensor() => Err(Failure::option(
            format!("--unit {} is not a unit of a {sensor}", unit.name()),
            "give another --unit or --sensor",
        )),
        (sensor, unit) => Ok(sensor.or(unit.map(Unit::sensor))),
    }
}

impl Scaling {
    /// Finds the scale and unit of these axes, whose names may indicate the sensor.
    pub(super) fn settle(
        table: &impl Table,
        path: &Path,
        options: &Options,
        axes: &[AxisColumn],
        named: Option<Sensor>,
    ) -> Result<Self, Failure> {
        let sensor = wanted_sensor(options)?.or(named);
        let fits = |unit: &Unit| sensor.is_none_or(|sensor| unit.sensor() == sensor);
        let told = match options.unit {
            None => table.metadata().unit(path)?.filter(fits),
            unit => unit,
        };
        let scale = table.metadata().scale(path, options)?;
        // Unit and scale together say all about the values. A unit alone names the unit of the
        // results, and the names may still say in what part of it the values are.
        let mut of_header = None;
        let by_names = match (told, scale) {
            (Some(_), Some(_)) => None,
            (told, _) => {
                let sensor = sensor.or(told.map(Unit::sensor)).unwrap_or(Sensor::Gyro);
                let header = gyroflow::Header::of(&table.columns().said);
                of_header = header.and_then(|header| header.scale(sensor));
                table.columns().unit_of(path, axes, sensor)?
            }
        };
        let of_header = of_header.filter(|_| by_names.is_none());
        let by_names = by_names.or(of_header);
        if let (Some(told), Some((named, _))) = (told, by_names)
            && told != named
        {
            return Err(Place::file(path).failure(
                format!("the unit is said to be {told}, but the columns are named in {named}"),
                "omit the unit, or give --scale too if the names are wrong",
            ));
        }
        let usual = Unit::usual(sensor.unwrap_or(Sensor::Gyro));
        let convention = table.columns().convention_of(axes);
        let convention = convention.filter(|convention| fits(&convention.unit));
        let (unit, origin) = match (told, by_names, convention) {
            (Some(unit), ..) => (unit, Origin::Told),
            (None, Some((unit, _)), _) if of_header.is_some() => (unit, Origin::Header),
            (None, Some((unit, _)), _) => (unit, Origin::Names),
            (None, None, Some(convention)) => {
                (convention.unit, Origin::Convention(convention.program))
            }
            (None, None, None) => {
                let columns = table.columns();
                match () {
                    () if scale.is_some() => (usual, Origin::Assumed),
                    () if columns.is_in_si(axes) && fits(&Unit::RadiansPerSecond) => {
                        (Unit::RadiansPerSecond, Origin::Beside)
                    }
                    () if columns.is_in_g(axes) && fits(&Unit::StandardGravity) => {
                        (Unit::StandardGravity, Origin::Gravity)
                    }
                    () => (usual, Origin::Assumed),
                }
            }
        };
        let is_convention = matches!(origin, Origin::Convention(_));
        Ok(Self {
            scale: scale.unwrap_or(1.0) * by_names.map_or(1.0, |(_, part)| part),
            unit,
            scale_is_told: scale.is_some() || by_names.is_some() || is_convention,
            origin,
        })
    }

    /// Whether it is known how large the values are, of numbers that are whole or not.
    pub(super) fn has_scale(&self, are_whole: bool) -> bool {
        self.origin != Origin::Assumed && (self.scale_is_told || !are_whole)
    }

    /// Checks that the scatter between neighbouring samples of an axis is possible for a sensor at
    /// rest. An unlikely scatter is a warning, an impossible one an error.
    pub(super) fn check(&self, path: &Path, axis: &Axis) -> Result<Option<String>, Failure> {
        // The limits are in deg/s or m/s². The first lies beyond the noisiest sensors at their
        // highest rates, and the second beyond every sensor's range. Both are chosen by hand; no
        // collection of data sheets was evaluated for them.
        let (doubtful, impossible) = match self.unit.sensor() {
            Sensor::Gyro => (100.0, 1e5),
            Sensor::Accelerometer => (20.0, 1e5),
        };
        let Some(octave) = axis.accumulator.octave(0) else {
            return Ok(None);
        };
        let variance = 0.5 * octave.sum.to_real() / octave.differences as f64;
        let deviation = variance.sqrt() * axis.rate_per_count;
        let what = format!(
            "axis {}: a scatter of {deviation:.3e} {} between neighbours is {{}} for a {} at rest",
            axis.name,
            self.unit,
            self.unit.sensor(),
        );
        let remedy = "check --scale and --unit";
        match deviation * self.unit.in_usual() {
            usual if usual > impossible => {
                Err(Place::file(path).failure(what.replace("{}", "impossible"), remedy))
            }
            usual if usual > doubtful => Ok(Some(format!(
                "{}: {remedy}",
                what.replace("{}", "unlikely")
            ))),
            _ => Ok(None),
        }
    }
}
