//! The sampling rate and the gaps follow from the time stamps.

use super::{counts, read_text};
use allanite::Accumulator;
use host_tests::{
    log::{OCTAVES, Options, TimeUnit},
    unit::Unit,
};
use std::fmt::Write as _;

/// A log of one axis with these stamps.
fn stamped(header: &str, stamps: impl Iterator<Item = i64>) -> String {
    let noise = counts();
    let rows = stamps.zip(noise.iter().flatten().cycle());
    rows.fold(format!("{header}\n"), |mut text, (stamp, count)| {
        let _ = writeln!(text, "{stamp},{count}");
        text
    })
}

#[test]
fn rate_follows_from_stamps_of_every_unit() {
    for (header, step, rate_hz) in [
        ("time_us,gx [deg/s]", 2500, 400.0),
        ("t (ms),gx [deg/s]", 8, 125.0),
        ("timestamp,gx [deg/s]", 5_000_000, 200.0),
        ("timestamp,gx [deg/s]", 10_000, 100.0),
        ("timestamp,gx [deg/s]", 10, 100.0),
        ("TimeUS,gx (dps)", 1000, 1000.0),
    ] {
        let text = stamped(header, (0..200).map(|i| 77 + i * step));
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!(
            (log.rate_hz, log.unit),
            (rate_hz, Unit::DegreesPerSecond),
            "{header}"
        );
        assert_eq!(log.axes[0].name, "gx");
        let told = Options {
            rate_hz: Some(50.0),
            unit: Some(Unit::RadiansPerSecond),
            scale: Some(0.5),
            ..Options::default()
        };
        let log = read_text(&text, &told).unwrap();
        assert_eq!(
            (log.rate_hz, log.unit),
            (50.0, Unit::RadiansPerSecond),
            "{header}"
        );
        assert_eq!(log.axes[0].rate_per_count, 0.5);
    }
    let text = stamped("tick,gx [deg/s]", (0..200).map(|i| i * 4));
    let options = Options {
        time: Some("tick".into()),
        time_unit: Some(TimeUnit::Us),
        ..Options::default()
    };
    assert_eq!(read_text(&text, &options).unwrap().rate_hz, 250_000.0);
}

#[test]
fn seconds_and_nanoseconds_are_one_stamp() {
    for (sec, nanosec) in [
        ("header.stamp.secs", "header.stamp.nsecs"),
        ("header_stamp_sec", "header_stamp_nanosec"),
    ] {
        let mut text = format!("Time,{sec},{nanosec},angular_velocity.x\n");
        for (i, count) in (0i64..).zip(counts().iter().flatten().cycle().take(600)) {
            let stamp = 1_700_000_000_900_000_000 + 5_000_000 * i;
            // This is the time of recording, which comes in bursts.
            let recorded = 1_700_000_001 + i / 50;
            let (sec, nanosec) = (stamp / 1_000_000_000, stamp % 1_000_000_000);
            let _ = writeln!(text, "{recorded},{sec},{nanosec},{count}");
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!((log.rate_hz, log.axes.len()), (200.0, 1), "{sec}");
        assert!(log.axes[0].accumulator.gaps() == 0 && log.axes[0].accumulator.samples() == 600);
        let name = format!("200 Hz from the time stamps of {sec} and {nanosec}, in ns");
        assert!(log.notes[0].ends_with(&name), "{}", log.notes[0]);
    }
}

#[test]
fn gaps_split_the_record_and_repeated_rows_are_left_out() {
    let noise = counts();
    let mut expected = Accumulator::<OCTAVES>::new();
    let mut text = String::from("timestamp [us],gx [deg/s]\n");
    for (i, count) in noise.iter().flatten().cycle().take(400).enumerate() {
        if (200..220).contains(&i) {
            if i == 200 {
                expected.gap();
            }
            continue;
        }
        let _ = writeln!(text, "{},{count}", 5000 * i);
        expected.push(*count);
        if i == 50 {
            let _ = writeln!(text, "{},{count}", 5000 * i);
        }
    }
    for given in [None, Some(100.0)] {
        let options = Options {
            rate_hz: given,
            time: Some("timestamp".into()),
            ..Options::default()
        };
        let log = read_text(&text, &options).unwrap();
        assert_eq!(log.rate_hz, given.unwrap_or(200.0));
        assert!(log.axes[0].accumulator == expected);
        let notes = log.notes.join("\n");
        assert!(
            notes.contains("1 gap, the longest 105ms, about 20 samples lost")
                && notes.contains("1 row with a repeated stamp left out"),
            "{notes}"
        );
    }
}

#[test]
fn unusable_stamps_are_refused_with_their_row() {
    let regular = || (0..3000).map(|i| 5000 * i);
    let slower = regular().chain((1..500).map(|i| 5000 * 2999 + 10_000 * i));
    let back = regular().chain([7]);
    let coarse = (0..3000).map(|i| i / 4 * 20_000);
    for (stamps, expected) in [
        (
            slower.collect::<Vec<_>>(),
            "a.csv:3017: two rates in one log: time stamps are 10ms apart up to here, and were 5ms \
             apart before; cut the record there, or give --rate to ignore the stamps",
        ),
        (
            back.collect(),
            "a.csv:3002: time stamps go back from 14995000 to 7; \
             cut the record there, or give --rate to ignore the stamps",
        ),
        (
            coarse.collect(),
            "a.csv: time stamps repeat in 2250 of 3000 rows: too coarse, or written in bursts; \
             give --rate to ignore the stamps",
        ),
    ] {
        let text = stamped("time_us,gx [deg/s]", stamps.into_iter());
        assert_eq!(read_text(&text, &Options::default()).unwrap_err(), expected);
        let options = Options {
            rate_hz: Some(200.0),
            ..Options::default()
        };
        assert!(read_text(&text, &options).is_ok());
    }
    let index = stamped(",gx", 0..200);
    let line = read_text(&index, &Options::default()).unwrap_err();
    assert!(
        line.starts_with("a.csv: the sampling rate is not known; "),
        "{line}"
    );
}
