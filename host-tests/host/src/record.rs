//! The curves of a log or of a curve file, with what was recorded beside them.

use crate::curve_file::{AxisCurve, CurveFile};
use allanite_log::{
    Covariates, Evidence, Log, Options,
    failure::{Failure, Place},
    pieces::Pieces,
};
use std::path::Path;

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
    Ok(curves(log)?.into_iter().zip(evidence).collect())
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

/// The curves of a curve file, whose evidence is what their [pieces](beside) say.
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
    let axes = curves_of_file(path, options)?.into_iter();
    Ok(axes.map(beside).collect())
}

/// A curve, with what its pieces say of the samples, if it has them: whether the record is that of a gyro at rest.
pub fn beside(axis: AxisCurve) -> (AxisCurve, Evidence) {
    let evidence = Evidence {
        invalid: axis.pieces.as_ref().and_then(Pieces::invalid),
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
