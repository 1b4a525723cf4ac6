//! Allan deviations of arrays, and nothing else.

use super::{document::json, options::parse};
use allanite::Scale;
use allanite_log::{self as log, Arrays, failure::Failure};
use clap::Args;
use indicatif::ProgressBar;
use serde::Serialize;

/// What is known of the samples.
#[derive(Args)]
struct Sensor {
    #[arg(long, allow_negative_numbers = true)]
    rate: f64,
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    scale: f64,
}

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

/// The Allan deviation of every column at octaves of the averaging time, as JSON.
///
/// # Errors
/// When an option is not valid, or a value is not a finite number.
pub fn deviations(
    arrays: &Arrays<'_>,
    options: &[String],
    progress: &ProgressBar,
) -> Result<String, Failure> {
    let Sensor { rate, scale } = parse(options)?;
    let accumulated = log::accumulate(arrays, progress)?.into_iter().enumerate();
    let columns = accumulated.map(|(column, (accumulator, step))| {
        let scale = Scale::new(scale * step, rate)
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
