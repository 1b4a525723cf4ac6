//! Studies whether a filter that is given an exported model knows how wrong it is.
//!
//! A record with a random line, filter, temperature and Gauss–Markov noise is written as a log, and `export` reads it. A
//! Kalman filter with that model then runs over another record of the same gyro, whose angle and bias are known.

mod consumers;
mod filter;
mod gyro;
mod walks;

pub use consumers::{Number, consumers};
pub use filter::{Model, Run};
pub use gyro::{Gyro, RATE_HZ, Truth};
pub use walks::{Filtered, HELD, Walk, walks};

use allanite_cli::command::CommandLine;
use allanite_host::simulate::{Coefficients, Preset};
use allanite_log::failure::Failure;
use clap::Parser;
use rayon::prelude::*;
use serde_json::Value;
use std::{fs, io, path::Path};

/// The number of samples of a record, which is 44 minutes long.
pub const SAMPLES: usize = 1 << 18;

/// The standard deviation of the angle that a filter is told every second, over the white noise of one second.
const REFERENCE: f64 = 3.0;

/// What became of one gyro.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The seed of the gyro.
    pub seed: u64,
    /// What the gyro has, in words.
    pub truth: String,
    /// The reason why `export` refuses the record unless it is told; `None` if it exports it.
    pub refused: Option<String>,
    /// What the diagnosis finds, exported despite everything.
    pub diagnosed: Exported,
    /// The five terms.
    pub five_terms: Exported,
}

/// A model that was exported, and how a filter fares with it.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The model in words.
    pub model: String,
    /// N over its true value.
    pub density: f64,
    /// Whether the interval of N has the true value.
    pub inside: bool,
    /// The mean of the normalised errors squared of angle and bias, over two: one if the filter knows its errors.
    pub nees: f64,
    /// The root-mean-square error of the angle in degrees.
    pub angle_error: f64,
}

/// The gyros of these seeds. With `real`, they also have the bias instability and the random walk of the preset.
///
/// # Errors
/// When a log cannot be written, or `export` fails for another reason than its two refusals.
pub fn study(preset: Preset, seeds: std::ops::Range<u64>, real: bool) -> io::Result<Vec<Outcome>> {
    let mut base = preset.coefficients();
    if !real {
        base = Coefficients {
            quantization: base.quantization,
            angle_random_walk: base.angle_random_walk,
            ..Coefficients::default()
        };
    }
    let seeds: Vec<u64> = seeds.collect();
    let all = seeds.into_par_iter().map(|seed| one(base, seed));
    all.collect()
}

/// One gyro, from its log to its filters.
fn one(base: Coefficients, seed: u64) -> io::Result<Outcome> {
    let gyro = Gyro::drawn(base, seed);
    let folder = tempfile::tempdir()?;
    let log = folder.path().join("log.csv");
    gyro.write(&log, SAMPLES, 2 * seed)?;
    let export = |more: &[&str]| exported(&log, folder.path(), more);
    let refused = export(&[]).err().map(|failure| failure.to_string());
    let failed = |failure: Failure| io::Error::other(failure.to_string());
    let despite = ["--despite-invalid", "--despite-unexplained"];
    let told = export(&despite).map_err(failed)?;
    let five = export(&["--model", "five-terms", "--despite-invalid"]).map_err(failed)?;
    let record = gyro.record(SAMPLES, 2 * seed + 1);
    let fares = |axis: &Value, alone: bool| {
        let model = Model::of(axis, alone);
        let truth = base.angle_random_walk.to_radians();
        let run = Run::of(&model, &record, REFERENCE * truth);
        let of_white = |name: &str| axis[name].as_f64();
        let lower = of_white("noise_density_lower");
        let upper = of_white("noise_density_upper");
        Exported {
            model: axis["model"].as_str().unwrap_or_default().to_owned(),
            density: of_white("noise_density").unwrap_or(f64::NAN) / truth,
            inside: lower.is_some_and(|x| x <= truth) && upper.is_some_and(|x| truth <= x),
            nees: run.nees,
            angle_error: run.angle_error.to_degrees(),
        }
    };
    Ok(Outcome {
        seed,
        truth: gyro.words(),
        refused,
        diagnosed: fares(&told, false),
        five_terms: fares(&five, true),
    })
}

/// The first axis that `export` writes as JSON.
fn exported(log: &Path, folder: &Path, more: &[&str]) -> Result<Value, Failure> {
    let output = folder.join("model.json");
    export_as("json", log, &output, more)?;
    let text = fs::read_to_string(&output).unwrap_or_default();
    let document: Value = serde_json::from_str(&text).unwrap_or_default();
    Ok(document["axes"][0].clone())
}

/// Exports the log of a gyro in a format.
fn export_as(format: &str, log: &Path, output: &Path, more: &[&str]) -> Result<(), Failure> {
    let _ = fs::remove_file(output);
    let rate = RATE_HZ.to_string();
    let line: Vec<&str> = ["allanite", "--quiet", "export"].into();
    let paths = [log.to_str(), output.to_str()];
    let [log, output] = paths.map(Option::unwrap_or_default);
    let options = [
        log,
        "--rate",
        &rate,
        "--unit",
        "deg/s",
        "--columns",
        "gx",
        "--format",
        format,
        "--output",
        output,
    ];
    let line = line.into_iter().chain(options).chain(more.iter().copied());
    let command = CommandLine::try_parse_from(line)
        .map_err(|error| Failure::option(error.to_string(), "mend the study"))?;
    command.run()
}
