//! Gyros with white noise, bias instability and a rate random walk of random sizes, and a filter that is given no more than
//! white noise and a random walk, which is all that most formats have.

use super::{
    REFERENCE, SAMPLES, exported,
    filter::{Model, Run},
    gyro::{RATE_HZ, Truth},
};
use allanite_host::simulate::{Coefficients, Preset, Random, Simulator};
use allanite_log::failure::Failure;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::{
    fs::File,
    io::{self, BufWriter, Write},
    ops::Range,
    path::Path,
};

/// A count of the log over the white noise of a sample.
const COUNT: f64 = 0.02;

/// The samples of a second, over which a bias is averaged: a filter has one value of it for each of its steps.
const SECOND: usize = 100;

/// The largest NEES of a filter that knows its errors. A record has no more than some independent values of a bias that
/// walks slowly, so that the mean of a consistent filter scatters by a fifth.
pub const HELD: f64 = 1.5;

/// What became of one gyro.
#[derive(Clone, Debug)]
pub struct Walk {
    /// The seed of the gyro.
    pub seed: u64,
    /// The angular frequency in rad/s at which flicker noise is as large as white noise, `(B/N)²`.
    pub flicker: f64,
    /// The angular frequency in rad/s at which the random walk is as large as white noise, `K/N`.
    pub walk: f64,
    /// The filter with the random walk that formats have.
    pub exported: Filtered,
    /// The filter with the overbound.
    pub overbound: Filtered,
    /// The filter with K alone.
    pub alone: Filtered,
}

/// How a filter fared.
#[derive(Clone, Copy, Debug)]
pub struct Filtered {
    /// The mean of the normalised errors squared of angle and bias, over two: one if the filter knows its errors.
    pub nees: f64,
    /// The root-mean-square error of the angle over the white noise of one second.
    pub angle_error: f64,
}

/// The gyros of these seeds, with the white noise of a preset.
///
/// # Errors
/// When a log cannot be written, or `export` fails.
pub fn walks(preset: Preset, seeds: Range<u64>) -> io::Result<Vec<Walk>> {
    let white = preset.coefficients().angle_random_walk;
    let seeds: Vec<u64> = seeds.collect();
    let all = seeds.into_par_iter().map(|seed| one(white, seed));
    all.collect()
}

fn one(white: f64, seed: u64) -> io::Result<Walk> {
    let mut random = Random::seed_from_u64(seed ^ 0x7761_6c6b);
    let mut log = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
    // From corners that lie beyond the record to those of a gyro whose flicker noise exceeds its white noise at a second.
    let (flicker, walk) = (log(1e-4, 3.0), log(1e-4, 0.2));
    let noise = Coefficients {
        angle_random_walk: white,
        ..Coefficients::default()
    };
    let bias = Coefficients {
        bias_instability: white * flicker.sqrt(),
        rate_random_walk: white * walk,
        ..Coefficients::default()
    };
    let record = |seed: u64| -> Vec<Truth> {
        let noise = Simulator::new(noise, RATE_HZ, 2 * seed);
        let biases: Vec<f64> = Simulator::new(bias, RATE_HZ, 2 * seed + 1)
            .take(SAMPLES)
            .collect();
        let means = biases.chunks(SECOND);
        let means = means.map(|second| second.iter().sum::<f64>() / second.len() as f64);
        let means: Vec<f64> = means.collect();
        let both = noise.zip(&biases).enumerate();
        both.map(|(at, (noise, bias))| Truth {
            rate: noise + bias,
            temperature: 0.0,
            bias: means[at / SECOND],
        })
        .collect()
    };
    let folder = tempfile::tempdir()?;
    let log = folder.path().join("log.csv");
    write(&log, &record(2 * seed), COUNT * white * RATE_HZ.sqrt())?;
    let failed = |failure: Failure| io::Error::other(failure.to_string());
    let despite = ["--despite-invalid", "--despite-unexplained"];
    let axis = exported(&log, folder.path(), &despite).map_err(failed)?;
    let truth = white.to_radians();
    let record = record(2 * seed + 1);
    let filtered = |model: &Model| {
        let run = Run::of(model, &record, REFERENCE * truth);
        Filtered {
            nees: run.nees,
            angle_error: run.angle_error / truth,
        }
    };
    Ok(Walk {
        seed,
        flicker,
        walk,
        exported: filtered(&Model::of_format(&axis)),
        overbound: filtered(&Model::of_overbound(&axis)),
        alone: filtered(&Model::of(&axis, true)),
    })
}

/// Writes a record as a log.
fn write(path: &Path, record: &[Truth], count: f64) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "gx")?;
    for truth in record {
        writeln!(file, "{:.6}", (truth.rate / count).round() * count)?;
    }
    file.flush()
}
