//! Allan deviations of arrays, and nothing else.

use super::document::json;
use allanite::Scale;
use allanite_log::{self as log, Arrays, failure::Failure};
use indicatif::ProgressBar;
use serde::Serialize;

#[derive(Serialize)]
struct Column {
    axis: String,
    octaves: Vec<Octave>,
}

#[derive(Serialize)]
struct Octave {
    m: u32,
    tau_s: f64,
    differences: u64,
    deviation: f64,
}

/// The Allan deviation of every column at octaves of the averaging time, as JSON, of samples at a rate in Hz
/// with so many rate units per count.
///
/// # Errors
/// When the rate or the scale is not valid, or a value is not a finite number.
pub fn deviations(
    arrays: &Arrays<'_>,
    (rate_hz, rate_per_count): (f64, f64),
    progress: &ProgressBar,
) -> Result<String, Failure> {
    let accumulated = log::accumulate(arrays, progress)?.into_iter().enumerate();
    let columns = accumulated.map(|(column, (accumulator, step))| {
        let scale = Scale::new(rate_per_count * step, rate_hz)
            .map_err(|error| Failure::option(format!("{error:#}"), error.remedy()))?;
        let curve = accumulator.curve(scale);
        let octaves = curve.points().iter().map(|point| Octave {
            m: point.m,
            tau_s: point.tau_s,
            differences: point.differences,
            deviation: point.variance.sqrt(),
        });
        Ok(Column {
            axis: arrays.name(column),
            octaves: octaves.collect(),
        })
    });
    json(&columns.collect::<Result<Vec<_>, Failure>>()?)
}
