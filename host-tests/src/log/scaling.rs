//! What one count of a log is: from options, comments and the names of columns, in this order.

use super::{Axis, Options, columns::AxisColumn, table::Table};
use crate::{
    failure::{Failure, Place},
    unit::{Sensor, Unit},
};
use std::path::Path;

/// The scale and unit of a log's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scaling {
    /// Units per count.
    pub(super) scale: f64,
    pub(super) unit: Unit,
    /// Whether somebody said the scale; else it is one for want of a better.
    pub(super) scale_is_told: bool,
    pub(super) origin: Origin,
}

/// Who said the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// An option or a comment.
    Told,
    /// The names of the columns.
    Names,
    /// Nobody.
    Assumed,
}

/// The sensor that options ask for.
pub(super) fn wanted_sensor(options: &Options) -> Result<Option<Sensor>, Failure> {
    match (options.sensor, options.unit) {
        (Some(sensor), Some(unit)) if sensor != unit.sensor() => Err(Failure::option(
            format!("--unit {} is not one of a {sensor}", unit.name()),
            "give another --unit or --sensor",
        )),
        (sensor, unit) => Ok(sensor.or(unit.map(Unit::sensor))),
    }
}

impl Scaling {
    /// Settles the scale of these axes, whose names may tell the sensor.
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
        let by_names = match told {
            None => {
                let sensor = sensor.unwrap_or(Sensor::Gyro);
                table.columns().unit_of(path, axes, sensor)?
            }
            Some(_) => None,
        };
        let scale = table.metadata().scale(path, options)?;
        let (unit, origin) = match (told, by_names) {
            (Some(unit), _) => (unit, Origin::Told),
            (None, Some((unit, _))) => (unit, Origin::Names),
            (None, None) => (Unit::usual(sensor.unwrap_or(Sensor::Gyro)), Origin::Assumed),
        };
        Ok(Self {
            scale: scale.or(by_names.map(|(_, scale)| scale)).unwrap_or(1.0),
            unit,
            scale_is_told: scale.is_some() || by_names.is_some(),
            origin,
        })
    }

    /// Whether neighbouring samples of an axis scatter as those of a sensor at rest can: a warning
    /// where they hardly do, a failure where they cannot.
    pub(super) fn check(&self, path: &Path, axis: &Axis) -> Result<Option<String>, Failure> {
        // In deg/s or m/s²: beyond the noisiest parts at their highest rates, and beyond any range.
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
            "axis {}: samples that scatter by {deviation:.3e} {} are {{}} of a {} at rest",
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
