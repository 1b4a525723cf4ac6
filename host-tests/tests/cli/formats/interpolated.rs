//! Rows that a program interpolated are no samples: their noise is smaller, and there are more of them than the sensor gave.

use super::try_read;
use allanite_log::{Options, Repeats};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fmt::Write as _, fs};
use tempfile::TempDir;

const SAMPLES: usize = 20_000;
const RATE_HZ: f64 = 100.0;

/// Samples of three axes, with a standard deviation of one.
fn samples(seed: u64) -> Vec<[f64; 3]> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..SAMPLES)
        .map(|_| [(); 3].map(|()| StandardNormal.sample(&mut random)))
        .collect()
}

/// The samples at these times, in samples from the first one, by linear interpolation.
fn table(samples: &[[f64; 3]], times: impl Iterator<Item = f64>) -> String {
    let mut text = String::from("time (s),gx (deg/s),gy (deg/s),gz (deg/s)\n");
    for time in times {
        let share = time.fract();
        let rows = [time as usize, (time.ceil() as usize).min(SAMPLES - 1)];
        let [before, behind] = rows.map(|row| samples[row]);
        let [x, y, z] = [0, 1, 2].map(|axis| before[axis] + share * (behind[axis] - before[axis]));
        writeln!(text, "{:.7},{x:.6},{y:.6},{z:.6}", time / RATE_HZ).unwrap();
    }
    text
}

/// The rate, N of the first axis, and the note on interpolated rows.
fn read(text: &str, options: &Options) -> (f64, f64, Option<String>) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("log.csv");
    fs::write(&path, text).unwrap();
    let log = try_read(&path, options).unwrap();
    let axis = &log.axes[0];
    let octave = axis.accumulator.octave(0).unwrap();
    let variance = 0.5 * octave.sum.to_real() / octave.differences as f64;
    let density = (variance / log.rate_hz).sqrt() * axis.rate_per_count;
    let note = log
        .notes
        .into_iter()
        .find(|note| note.contains("straight line"));
    (log.rate_hz, density, note)
}

/// asammdf 8.8.28 makes a common table of a gyro and a thermometer of another rate so: the gyro has a row at each time of the
/// thermometer as well, interpolated between its samples.
#[test]
fn rows_at_the_times_of_a_thermometer_are_left_out() {
    let samples = samples(1);
    for (period, first) in [(10.0, 0.37), (9.73, 0.2), (100.0, 0.5)] {
        let steps = (SAMPLES as f64 / period) as usize - 1;
        let inserted = (0..steps).map(|step| first + period * step as f64);
        let inserted: Vec<f64> = inserted.filter(|time| time.fract() > 0.01).collect();
        let mut times: Vec<f64> = (0..SAMPLES).map(|row| row as f64).collect();
        times.extend(&inserted);
        times.sort_by(f64::total_cmp);
        let text = table(&samples, times.into_iter());
        let (rate_hz, density, note) = read(&text, &Options::default());
        let note = note.unwrap_or_else(|| panic!("no note for {period}"));
        assert!((rate_hz / RATE_HZ - 1.0).abs() < 2e-3, "{rate_hz}: {note}");
        assert!((10.0 * density - 1.0).abs() < 0.02, "{density}: {note}");
        let words: Vec<&str> = note.split(' ').collect();
        let place = words
            .iter()
            .position(|word| *word == "interpolated")
            .unwrap();
        let left_out: f64 = words[place - 1].parse().unwrap();
        let all = inserted.len() as f64;
        assert!((left_out / all - 1.0).abs() < 0.01, "{all}: {note}");
    }
}

/// `resample().interpolate()` of pandas and `numpy.interp` onto times that include those of the samples.
#[test]
fn a_log_that_was_interpolated_to_a_faster_rate_has_the_rate_of_the_sensor() {
    let samples = samples(2);
    for times in [2, 5] {
        let rows = (0..times * (SAMPLES - 1)).map(|row| row as f64 / times as f64);
        let text = table(&samples, rows);
        let (rate_hz, density, note) = read(&text, &Options::default());
        assert!(note.is_some(), "{times}");
        assert!((rate_hz / RATE_HZ - 1.0).abs() < 2e-3, "{rate_hz}");
        assert!((10.0 * density - 1.0).abs() < 0.02, "{density}");
        let kept = Options {
            repeats: Repeats::Keep,
            ..Options::default()
        };
        let (rate_hz, _, note) = read(&text, &kept);
        assert_eq!((rate_hz.round(), note), (RATE_HZ * times as f64, None));
    }
}

/// Noise that was averaged, filtered or counted in whole numbers has no row on the line by more than chance.
#[test]
fn no_row_of_a_smooth_or_coarse_record_is_left_out() {
    let samples = samples(3);
    let mut smooth = samples.clone();
    for row in 1..SAMPLES {
        for axis in 0..3 {
            smooth[row][axis] =
                smooth[row - 1][axis] + 0.02 * (samples[row][axis] - smooth[row - 1][axis]);
        }
    }
    let counts = |scale: f64| -> Vec<[f64; 3]> {
        let rows = samples.iter();
        rows.map(|row| row.map(|value| (scale * value).round()))
            .collect()
    };
    for rows in [smooth, counts(1.0), counts(5.0), counts(40.0)] {
        let text = table(&rows, (0..SAMPLES).map(|row| row as f64));
        let (rate_hz, _, note) = read(&text, &Options::default());
        assert_eq!((rate_hz, note), (RATE_HZ, None));
    }
}
