//! Characters that a monitor or a logger puts around every row.

use super::read_text;
use allanite_log::{Log, Options};
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Write as _;

/// Rows of a pattern, in which `x`, `y` and `z` are samples, `T` is a time of day, `M` milliseconds and `C` a checksum.
pub(super) fn rows(pattern: &str) -> (String, [Vec<f64>; 3]) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut text, mut values) = (String::new(), [const { Vec::new() }; 3]);
    for n in 0..300_u32 {
        let mut row = pattern.to_owned();
        for (axis, size) in [0.05, 0.1, 0.2].into_iter().enumerate() {
            let value: f64 = StandardNormal.sample(&mut random);
            let number = format!("{:.5}", size * value);
            values[axis].push(number.parse().unwrap());
            row = row.replace(["x", "y", "z"][axis], &number);
        }
        let time = format!("12:30:{:02}.{:03}", n / 100, n % 100 * 10);
        let check: u8 = random.random();
        row = row
            .replace('T', &time)
            .replace('M', &(312 + 10 * n).to_string());
        writeln!(text, "{}", row.replace('C', &format!("{check:02X}"))).unwrap();
    }
    (text, values)
}

/// Asserts that a log has these samples.
pub(super) fn assert_values(log: &Log, values: &[Vec<f64>], what: &str) {
    assert_eq!(
        (log.rate_hz, log.axes.len()),
        (100.0, values.len()),
        "{what}"
    );
    for (axis, values) in log.axes.iter().zip(values) {
        assert_eq!(axis.accumulator.samples(), values.len() as u64, "{what}");
        let squares = values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
        let octave = axis.accumulator.octave(0).unwrap();
        let sum = octave.sum.to_real() * axis.rate_per_count.powi(2);
        let right: f64 = squares.sum();
        assert!((sum / right - 1.0).abs() < 1e-6, "{what}: {sum} {right}");
    }
}

#[test]
fn characters_that_are_glued_to_every_row_cost_no_axis() {
    let told = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    for (pattern, options, words) in [
        ("T -> x,y,z", Options::default(), "\" -> \" behind the time"),
        (
            "T -> x\ty\tz",
            Options::default(),
            "\" -> \" behind the time",
        ),
        (
            "I (M) icm6050: x, y, z",
            Options::default(),
            "\"I (\" and \") icm6050: \" around the time",
        ),
        ("T -> x,y,z;", Options::default(), "\";\" behind them"),
        (
            "GX:x,GY:y,GZ:z",
            told.clone(),
            "labels such as \"GX:\" before the values are the names",
        ),
        (
            "t_ms=M GX=x GY=y GZ=z",
            Options::default(),
            "labels such as \"t_ms=\" before the values",
        ),
        ("x,y,z;", told.clone(), "\";\" behind them"),
        ("x,y,z*C", told.clone(), "a checksum behind them"),
        (
            "rates: x,y,z",
            told.clone(),
            "\"rates: \" before its values",
        ),
        (
            "[x, y, z]",
            told.clone(),
            "\"[\" before its values, \"]\" behind them",
        ),
        (
            "(x;y;z)",
            told,
            "\"(\" before its values, \")\" behind them",
        ),
    ] {
        let (text, values) = rows(pattern);
        let log = read_text(&text, &options).unwrap_or_else(|line| panic!("{pattern}: {line}"));
        assert_values(&log, &values, pattern);
        let notes = log.notes.join("\n");
        let is_of_rows = |note: &str| {
            note.starts_with("cut off each row: ") || note.starts_with("labels such as ")
        };
        let is_said = |note: &str| is_of_rows(note) && note.contains(words);
        assert!(notes.lines().any(is_said), "{pattern}: {notes}");
    }
}

#[test]
fn names_are_found_behind_the_time_that_a_monitor_writes_before_them_too() {
    for (pattern, header) in [
        ("T -> x,y,z", "12:29:59.990 -> gyro_x,gyro_y,gyro_z"),
        ("I (M) imu: x,y,z", "I (302) imu: gyro_x,gyro_y,gyro_z"),
    ] {
        let (text, values) = rows(pattern);
        let text = format!("{header}\n{text}");
        let log = read_text(&text, &Options::default()).unwrap();
        assert_values(&log, &values, pattern);
        assert_eq!(log.axes[0].name, "gyro_x");
    }
}

#[test]
fn a_row_of_another_shape_is_a_lost_sample() {
    let (text, _) = rows("I (M) imu: x, y, z");
    let mut lines: Vec<&str> = text.lines().collect();
    lines[120] = "W (1512) wifi: beacon timeout";
    let log = read_text(&(lines.join("\n") + "\n"), &Options::default()).unwrap();
    let notes = log.notes.join("\n");
    assert!(notes.contains("1 sample lost in row 121"), "{notes}");
}

/// A label in front of every value, and a label that tells sensors apart, are not around the row.
#[test]
fn labels_are_not_cut_off_as_if_they_were_around_the_row() {
    let told = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    let (text, _) = rows("gx:x,gy:y,gz:z");
    assert!(read_text(&text, &told).is_err());
    let (text, values) = rows("$ABD,x,y,z");
    assert_values(&read_text(&text, &told).unwrap(), &values, "$ABD");
}
