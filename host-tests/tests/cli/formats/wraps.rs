//! Counters of few bits and times of day begin anew during a record, which loses no sample.

use super::read_text;
use allanite::Accumulator;
use allanite_log::{OCTAVES, Options, TimeUnit};
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fmt::Write as _;

/// A log with these stamps.
fn log(header: &str, stamps: impl Iterator<Item = String>) -> String {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut text = format!("{header}\n");
    for stamp in stamps {
        let value: f64 = StandardNormal.sample(&mut random);
        writeln!(text, "{stamp},{:.6}", 0.05 * value).unwrap();
    }
    text
}

fn within(time_unit: TimeUnit) -> Options {
    Options {
        time_unit: Some(time_unit),
        ..Options::default()
    }
}

/// Asserts that a log is read with every sample and the rate, and that its account of stamps ends with these words.
fn assert_whole(text: &str, options: &Options, rate_hz: f64, words: &str) {
    let rows = text.lines().count() as u64 - 1;
    let log = read_text(text, options).unwrap_or_else(|line| panic!("{words}: {line}"));
    let accumulator: &Accumulator<OCTAVES> = &log.axes[0].accumulator;
    assert!(
        (log.rate_hz / rate_hz - 1.0).abs() < 1e-3,
        "{words}: {} Hz",
        log.rate_hz
    );
    assert_eq!((accumulator.samples(), accumulator.gaps()), (rows, 0));
    assert!(accumulator.bridged().is_empty(), "{words}");
    let notes = log.notes.join("\n");
    assert!(
        notes.lines().any(|note| note.ends_with(words)),
        "{words}: {notes}"
    );
}

#[test]
fn a_counter_that_overflows_loses_no_sample() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    for (unit, bits, rate_hz, jitter, words) in [
        (TimeUnit::Us, 32, 50.0, 0, "; wraps once, at 2^32 µs"),
        (TimeUnit::Us, 32, 200.0, 40, "; wraps once, at 2^32 µs"),
        (TimeUnit::Us, 31, 100.0, 4, "; wraps once, at 2^31 µs"),
        (TimeUnit::Ms, 32, 100.0, 0, "; wraps once, at 2^32 ms"),
        (TimeUnit::Ms, 31, 952.0, 0, "; wraps once, at 2^31 ms"),
        (TimeUnit::Us, 24, 833.0, 9, "; wraps once, at 2^24 µs"),
        (TimeUnit::Ms, 16, 100.0, 1, "; wraps once, at 2^16 ms"),
        (TimeUnit::Us, 16, 1000.0, 3, "; wraps 31 times, at 2^16 µs"),
    ] {
        let modulus = 1_i64 << bits;
        let per_second = if unit == TimeUnit::Us { 1e6 } else { 1e3 };
        let step = per_second / rate_hz;
        let first = modulus as f64 - 1000.3 * step;
        let stamps = (0..2000).map(|row| {
            let late = random.random_range(0..=jitter);
            let stamp = (first + step * f64::from(row)).floor() as i64 + late;
            stamp.rem_euclid(modulus).to_string()
        });
        let text = log("ticks,gx [deg/s]", stamps);
        let options = Options {
            time: Some("ticks".into()),
            ..within(unit)
        };
        assert_whole(&text, &options, rate_hz, words);
    }
}

#[test]
fn a_counter_with_a_sign_and_one_that_is_written_in_seconds_wrap_too() {
    let signed = (0..2000_i64).map(|row| {
        let stamp = i64::from(i32::MAX) - 5_000_000 + 10_000 * row;
        (stamp as i32).to_string()
    });
    let text = log("time_us,gx [deg/s]", signed);
    assert_whole(
        &text,
        &Options::default(),
        100.0,
        "; wraps once, at 2^32 µs",
    );
    let seconds = (0..2000_u32).map(|row| {
        let micros = 0xffff_ffff_u32 - 3_000_000;
        format!("{:.6}", f64::from(micros.wrapping_add(5000 * row)) / 1e6)
    });
    let text = log("time_s,gx [deg/s]", seconds);
    assert_whole(
        &text,
        &Options::default(),
        200.0,
        "; wraps once, at 2^32 µs",
    );
}

#[test]
fn a_time_of_day_goes_on_at_midnight() {
    let of_day = |row: u32| (86_400_000 - 7_003 + 10 * row) % 86_400_000;
    let clock = (0..2000).map(|row| {
        let (ms, s) = (of_day(row), of_day(row) / 1000);
        let (hour, minute, second) = (s / 3600, s / 60 % 60, s % 60);
        format!("{hour:02}:{minute:02}:{second:02}.{:03}", ms % 1000)
    });
    let text = log("time,gx [deg/s]", clock);
    assert_whole(&text, &Options::default(), 100.0, "; wraps once, at 24 h");
    let seconds = (0..2000).map(|row| format!("{:.3}", f64::from(of_day(row)) / 1000.0));
    let text = log("time_s,gx [deg/s]", seconds);
    assert_whole(&text, &Options::default(), 100.0, "; wraps once, at 24 h");
}

/// Once a counter has wrapped, its modulus is known, and rows may be lost where it wraps again.
#[test]
fn rows_that_are_lost_where_a_counter_wraps_again_are_counted() {
    let rows = (0..3000_i64).filter(|row| !(1095..1100).contains(row));
    let stamps = rows.map(|row| ((65_536 * 2 - 60_000 + 60 * row) & 0xffff).to_string());
    let text = log("time_us,gx [deg/s]", stamps);
    let log = read_text(&text, &Options::default()).unwrap();
    let notes = log.notes.join("\n");
    assert!(
        notes.contains("1 gap, the longest 360us, about 5 samples lost"),
        "{notes}"
    );
}

#[test]
fn a_counter_that_is_reset_is_still_refused() {
    for (last, first) in [
        (4_294_000_000_i64, 0),
        (4_294_960_000, 30_000),
        (65_000, 9_000),
        (2_000_000, 0),
    ] {
        let before = (0..1000).map(|row| last - 10_000 * (999 - row));
        let before = before.filter(|stamp| *stamp >= 0);
        let after = (0..1000).map(|row| first + 10_000 * row);
        let text = log(
            "time_us,gx [deg/s]",
            before.chain(after).map(|stamp| stamp.to_string()),
        );
        let line = read_text(&text, &Options::default()).unwrap_err();
        let words = format!("time stamps go back from {last} to {first}");
        assert!(line.contains(&words), "{line}");
    }
}
