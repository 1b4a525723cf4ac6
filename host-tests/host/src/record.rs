//! The curves of a log or of a curve file, with what was recorded beside them.

use crate::curve_file::{AxisCurve, CurveFile};
use allanite::{Curve, Real, integrity::Reason, motion};
use allanite_log::{
    Covariates, Evidence, Log, OCTAVES, Options,
    failure::{Failure, Place},
    pieces::Pieces,
    unit::Sensor,
};
use std::path::Path;

/// The axes of a sensor that is judged as a whole.
const SENSOR: usize = 3;
/// No gyro has a larger count, in deg/s: whole numbers without a scale have no unit either.
const LARGEST_COUNT: f64 = 0.2;

/// The curves of a log.
///
/// # Errors
/// When the sums of an axis are too large for a curve.
pub fn curves(log: &Log) -> Result<Vec<AxisCurve>, Failure> {
    log.axes
        .iter()
        .map(|axis| AxisCurve::of(axis, log.rate_hz, log.unit))
        .collect()
}

/// The curves of a log that was read, with the evidence beside each.
///
/// # Errors
/// When the sums of an axis are too large for a curve.
pub fn with_evidence(log: &Log) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    let evidence = log.axes.iter().map(|axis| axis.evidence.clone());
    let evidence = evidence.map(Option::unwrap_or_default).collect::<Vec<_>>();
    Ok(judged(
        curves(log)?.into_iter().zip(evidence),
        log.has_scale,
    ))
}

/// The axes of a record, each three of which are one sensor's if it has so many, with what their courses and their curves say: whether
/// the noise changed, and whether the sensor moved all the time. Every record that is judged passes here; `compare` fits curves alone. `has_scale` is false where the unit is assumed.
fn judged(
    axes: impl IntoIterator<Item = (AxisCurve, Evidence)>,
    has_scale: bool,
) -> Vec<(AxisCurve, Evidence)> {
    let mut axes: Vec<(AxisCurve, Evidence)> = axes.into_iter().collect();
    let size = if axes.len().is_multiple_of(SENSOR) {
        SENSOR
    } else {
        1
    };
    for sensor in axes.chunks_mut(size) {
        let reason = moved(sensor, has_scale);
        for (axis, evidence) in sensor {
            // In the order in which a device asks.
            if let Some(course) = &evidence.course {
                evidence.invalid = course.or_changed(evidence.invalid);
            }
            evidence.invalid = evidence.invalid.or(reason);
            axis.invalid = evidence.invalid;
        }
    }
    axes
}

/// The motion that never stopped, of the axes of a sensor.
fn moved(axes: &[(AxisCurve, Evidence)], has_scale: bool) -> Option<Reason> {
    let (first, _) = axes.first()?;
    let is_one = |axis: &AxisCurve| axis.unit == first.unit && axis.rate_hz == first.rate_hz;
    if first.unit.sensor() != Sensor::Gyro || !axes.iter().all(|(axis, _)| is_one(axis)) {
        return None;
    }
    let in_degrees = first.unit.in_usual();
    let has_unit = axes
        .iter()
        .all(|(axis, _)| axis.rate_per_count * in_degrees <= LARGEST_COUNT);
    let per_degree = (has_scale && has_unit).then_some((1.0 / in_degrees) as Real);
    let curves = axes.iter().map(|(axis, _)| axis.curve().ok());
    let curves: Option<Vec<Curve<OCTAVES>>> = curves.collect();
    match curves?.as_slice() {
        [x, y, z] => motion::judge([x, y, z], per_degree),
        [one] => motion::judge([one], per_degree),
        _ => None,
    }
}

/// The curves of a curve file. It has its rate, scale, unit and axes, so that these options are refused.
///
/// # Errors
/// When the file is not valid, or an option is about logs.
pub fn curves_of_file(path: &Path, options: &Options) -> Result<Vec<AxisCurve>, Failure> {
    if *options != Options::default() {
        return Err(Place::file(path).failure(
            "a curve file contains its rate, scale, unit and axes",
            "drop the options about logs",
        ));
    }
    Ok(CurveFile::read(path)?.axes)
}

/// The curves of a curve file, whose evidence is what they and their pieces [say](of_curves).
///
/// # Errors
/// When the file is not valid, or an option is about logs.
pub fn curves_without_evidence(
    path: &Path,
    options: &Options,
    covariates: &Covariates,
) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    if let Covariates::Chosen(chosen) = covariates
        && !chosen.is_empty()
    {
        return Err(Place::file(path).failure(
            "a curve file has no covariates",
            "give the log, or drop --covariates",
        ));
    }
    Ok(of_curves(curves_of_file(path, options)?))
}

/// The curves of a record, with what they and their pieces say of the samples: whether the record is that of a gyro at rest.
pub fn of_curves(axes: impl IntoIterator<Item = AxisCurve>) -> Vec<(AxisCurve, Evidence)> {
    judged(axes.into_iter().map(beside), true)
}

/// A curve, with what its file or its pieces say of the samples, if they do.
fn beside(axis: AxisCurve) -> (AxisCurve, Evidence) {
    let evidence = Evidence {
        invalid: axis
            .invalid
            .or_else(|| axis.pieces.as_ref().and_then(Pieces::invalid)),
        ..Evidence::default()
    };
    (axis, evidence)
}

/// Whether the extension is that of a curve file.
pub fn is_curve(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// The failure for an error of the library about an axis.
pub fn library_failure(path: &Path, axis: &str, error: allanite::Error) -> Failure {
    Place::file(path).axis_failure(axis, format!("{error:#}"), error.remedy())
}
