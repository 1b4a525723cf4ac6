//! Measures how fast a log is read, and how fast an accumulator takes slices.

use super::RATE_HZ;
use allanite::{Accumulator, Curve, Scale};
use allanite_host::simulate::{Preset, Simulator};
use allanite_log::{
    self as log, Covariates,
    npy_header::{Header, Kind},
};
use anyhow::{Context as _, Result, ensure};
use indicatif::ProgressBar;
use serde::Serialize;
use std::{
    fs::File,
    hint::black_box,
    io::{BufWriter, Read as _, Write as _},
    path::Path,
    time::Instant,
};

/// The number of runs of which the median is told.
const RUNS: usize = 9;

/// The number of noise deviations of a sample in a count of 16 bits, as of a gyro at rest.
const COUNTS_PER_DEVIATION: f64 = 50.0;

/// The median and the quartiles of some runs, in ns per sample.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Time {
    /// The median.
    pub median_ns: f64,
    /// The first and the third quartile.
    pub quartiles_ns: [f64; 2],
}

/// The times of one kind of work.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What was done.
    pub work: &'static str,
    /// The type of the elements, as NumPy writes it.
    pub elements: &'static str,
    /// How long it took, by the clock.
    pub time: Time,
    /// The Allan variances at the shortest averaging times, in counts², which are those of every other way.
    pub variances: Vec<f64>,
}

/// The elements of the arrays: their name, kind and size, and the size of a count.
const ELEMENTS: [(&str, Kind, usize, f64); 4] = [
    ("i2", Kind::Signed, 2, 1.0),
    ("i4", Kind::Signed, 4, 1.0),
    ("f4", Kind::Float, 4, 0.125),
    ("f8", Kind::Float, 8, 0.125),
];

/// Reads arrays of `samples` counts of one axis, of every type, and accumulates the counts as slices.
///
/// # Errors
/// Fails if a file cannot be written or read.
pub fn study(samples: usize) -> Result<Vec<Row>> {
    let preset = Preset::Mems.coefficients();
    let scale = COUNTS_PER_DEVIATION / (preset.angle_random_walk * RATE_HZ.sqrt());
    let simulator = Simulator::new(preset, RATE_HZ, 1);
    let counts: Vec<i32> = simulator
        .take(samples)
        .map(|rate| (rate * scale).round() as i32)
        .collect();
    let folder = tempfile::tempdir().context("making a folder")?;
    let mut rows = Vec::new();
    for (elements, kind, size, step) in ELEMENTS {
        let path = folder.path().join(format!("{elements}.npy"));
        write(&path, &counts, kind, size, step)?;
        let (time, ()) = timed(samples, || alone(&path))?;
        rows.push(Row {
            work: "read the bytes",
            elements,
            time,
            variances: Vec::new(),
        });
        let (time, variances) = timed(samples, || for_fit(&path, step))?;
        rows.push(Row {
            work: "read for a fit",
            elements,
            time,
            variances,
        });
    }
    let (time, variances) = timed(samples, || {
        let mut accumulator = Accumulator::<{ log::OCTAVES }>::new();
        accumulator.push_slice(black_box(&counts));
        Ok(variances(&accumulator.curve(Scale::new(1.0, RATE_HZ)?)))
    })?;
    rows.push(Row {
        work: "slices of counts",
        elements: "i4",
        time,
        variances,
    });
    let (time, variances) = timed(samples, || Ok(vec![neighbours(black_box(&counts))]))?;
    rows.push(Row {
        work: "least work",
        elements: "i4",
        time,
        variances,
    });
    Ok(rows)
}

/// The Allan variance of neighbouring counts alone, without overlap, gaps or any other averaging time, in one loop that the
/// compiler can spread over vectors: what is left of the work if nothing else is asked for.
fn neighbours(counts: &[i32]) -> f64 {
    let square = |pair: &[i32]| {
        let difference = i64::from(pair[1].wrapping_sub(pair[0]));
        difference.wrapping_mul(difference)
    };
    let sum = counts.windows(2).map(square).fold(0, i64::wrapping_add);
    0.5 * sum as f64 / (counts.len() - 1) as f64
}

/// The median time of some runs, and the result of the last one.
fn timed<T>(samples: usize, work: impl Fn() -> Result<T>) -> Result<(Time, T)> {
    let mut last = work()?;
    let mut times = Vec::new();
    for _ in 0..RUNS {
        let begun = Instant::now();
        last = black_box(work()?);
        times.push(begun.elapsed().as_secs_f64() * 1e9 / samples as f64);
    }
    times.sort_by(f64::total_cmp);
    let time = Time {
        median_ns: times[RUNS / 2],
        quartiles_ns: [times[RUNS / 4], times[RUNS - 1 - RUNS / 4]],
    };
    Ok((time, last))
}

fn alone(path: &Path) -> Result<()> {
    let mut file = File::open(path)?;
    let mut bytes = vec![0; 1 << 16];
    while file.read(&mut bytes)? > 0 {
        black_box(&bytes);
    }
    Ok(())
}

fn for_fit(path: &Path, step: f64) -> Result<Vec<f64>> {
    let options = log::Options {
        rate_hz: Some(RATE_HZ),
        ..log::Options::default()
    };
    let none = Covariates::Chosen(Vec::new());
    let log = log::read_with_evidence(path, &options, &none, &ProgressBar::hidden())?;
    ensure!(log.axes.len() == 1, "one axis was written");
    let axis = &log.axes[0];
    let scale = Scale::new(axis.rate_per_count / step, log.rate_hz)?;
    Ok(variances(&axis.accumulator.curve(scale)))
}

fn variances<const K: usize>(curve: &Curve<K>) -> Vec<f64> {
    let points = curve.points().iter().take(8);
    points.map(|point| point.variance).collect()
}

/// Writes counts as an array of one dimension, in units of `step`.
fn write(path: &Path, counts: &[i32], kind: Kind, size: usize, step: f64) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let header = Header {
        kind,
        size,
        big_endian: false,
        fortran_order: false,
        shape: vec![counts.len() as u64],
    };
    header.write(&mut file)?;
    for &count in counts {
        let bytes = match (kind, size) {
            (Kind::Float, 4) => ((f64::from(count) * step) as f32).to_le_bytes().to_vec(),
            (Kind::Float, _) => (f64::from(count) * step).to_le_bytes().to_vec(),
            _ => count.to_le_bytes()[..size].to_vec(),
        };
        file.write_all(&bytes)?;
    }
    file.flush()?;
    Ok(())
}
