//! Logs of every format give the same counts, and bad ones are refused with their row.

mod bad_input;
mod counts;

use allanite::Accumulator;
use allanite_log::{
    self as log, ColumnChoice, Log, OCTAVES, Options,
    npy_header::{Header, Kind},
    unit::Unit,
};
use flate2::{Compression, write::GzEncoder};
use indicatif::ProgressBar;
use std::{fmt::Write as _, fs, io::Write as _};
use tempfile::TempDir;

/// The counts of a noisy gyro with three axes, which are the same in every run.
fn counts(rows: usize) -> Vec<[i32; 3]> {
    let mut state = 1u32;
    let mut count = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 20) as i32 - 2048
    };
    (0..rows)
        .map(|_| [count(), count() - 500, count() / 8])
        .collect()
}

/// The accumulators of the counts, one for each axis.
fn accumulators(rows: &[[i32; 3]]) -> Vec<Accumulator<OCTAVES>> {
    (0..3)
        .map(|axis| {
            let mut accumulator = Accumulator::new();
            rows.iter().for_each(|row| accumulator.push(row[axis]));
            accumulator
        })
        .collect()
}

fn rows_of_text(rows: &[[i32; 3]]) -> String {
    rows.iter().fold(String::new(), |mut text, [x, y, z]| {
        let _ = writeln!(text, "{x},{y},{z}");
        text
    })
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn npy(header: &Header, elements: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    header.write(&mut bytes).unwrap();
    bytes.extend_from_slice(elements);
    bytes
}

fn header(kind: Kind, size: usize, shape: &[u64]) -> Header {
    Header {
        kind,
        size,
        big_endian: false,
        fortran_order: false,
        shape: shape.to_vec(),
    }
}

fn at_100_hz() -> Options {
    Options {
        rate_hz: Some(100.0),
        scale: Some(0.05),
        unit: Some(Unit::DegreesPerSecond),
        ..Options::default()
    }
}

fn columns(list: &str) -> Options {
    Options {
        columns: Some(
            list.split(',')
                .map(|choice| choice.parse::<ColumnChoice>().unwrap())
                .collect(),
        ),
        ..at_100_hz()
    }
}

fn try_read(name: &str, bytes: &[u8], options: &Options) -> Result<Log, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    log::read(&path, options, &ProgressBar::hidden()).map_err(|failure| {
        let folder = format!("{}/", folder.path().display());
        failure.to_string().replace(&folder, "")
    })
}

fn read(name: &str, bytes: &[u8], options: &Options) -> Log {
    try_read(name, bytes, options).unwrap()
}

fn refusal(name: &str, bytes: &[u8], options: &Options) -> String {
    let line = try_read(name, bytes, options).unwrap_err();
    assert!(!line.contains('\n'), "{line}");
    line
}

fn assert_axes(log: &Log, expected: &[Accumulator<OCTAVES>], what: &str) {
    assert_eq!(log.axes.len(), expected.len(), "{what}");
    for (axis, expected) in log.axes.iter().zip(expected) {
        assert!(axis.accumulator == *expected, "{what}, axis {}", axis.name);
    }
}
