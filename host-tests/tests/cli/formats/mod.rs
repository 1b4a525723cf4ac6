//! Logs that the formats' own libraries wrote are read exactly, and refused if they are broken.

mod above;
mod around;
mod broken;
mod cases;
mod hdf5;
mod interpolated;
mod layouts;
mod long;
mod measurements;
mod origins;
mod rounded;
mod sources;
mod stamps;
mod subscriptions;
mod text;
mod times_of_day;
mod unmeasured;
mod values;
mod wraps;

use allanite::Accumulator;
use allanite_log::{self as log, Log, OCTAVES, Options, unit::Sensor};
use indicatif::ProgressBar;
use std::{
    fs,
    path::{Path, PathBuf},
};
use tempfile::TempDir;

const ROWS: usize = 48;

/// The size of a count in the fixtures. It is a power of two, so that every value is exact.
const GYRO: f64 = 1.0 / 1024.0;
const ACCELEROMETER: f64 = 1.0 / 256.0;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/fixtures")
        .join(name)
}

/// The counts that `make.py` generates: three of a gyro and three of an accelerometer.
fn counts() -> Vec<[i32; 6]> {
    let mut state = 1u32;
    let mut count = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 22) as i32 - 512
    };
    (0..ROWS)
        .map(|_| std::array::from_fn(|_| count()))
        .collect()
}

fn try_read(path: &Path, options: &Options) -> Result<Log, String> {
    log::read(path, options, &ProgressBar::hidden()).map_err(|failure| {
        let line = failure.to_string();
        assert!(!line.contains('\n') && line.contains("; "), "{line}");
        let folder = format!("{}/", path.parent().unwrap().display());
        line.replace(&folder, "")
    })
}

fn read(name: &str, options: &Options) -> Log {
    try_read(&fixture(name), options).unwrap()
}

fn read_text(text: &str, options: &Options) -> Result<Log, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, text).unwrap();
    try_read(&path, options)
}

fn of(sensor: Sensor) -> Options {
    Options {
        sensor: Some(sensor),
        ..Options::default()
    }
}

fn topic(topic: &str) -> Options {
    Options {
        topic: Some(topic.into()),
        ..Options::default()
    }
}

/// Asserts that every sum of the log's axes equals that of these rows of the generator exactly.
fn assert_sums<'a>(
    log: &Log,
    rows: impl Iterator<Item = &'a [i32; 6]> + Clone,
    first: usize,
    scale: f64,
    what: &str,
) {
    assert_eq!(log.axes.len(), 3, "{what}");
    for (i, axis) in log.axes.iter().enumerate() {
        let mut expected = Accumulator::<OCTAVES>::new();
        rows.clone().for_each(|row| expected.push(row[first + i]));
        assert_eq!(axis.accumulator.samples(), expected.samples(), "{what}");
        for (octave, expected) in axis.accumulator.octaves().zip(expected.octaves()) {
            assert_eq!(octave.differences, expected.differences, "{what}");
            assert_eq!(
                octave.sum.to_real() * axis.rate_per_count.powi(2),
                expected.sum.to_real() * scale.powi(2),
                "{what}, axis {}",
                axis.name
            );
        }
    }
}
