//! The sampling rate and the gaps follow from the time stamps.

use super::{counts, read_text};
use allanite::Accumulator;
use allanite_host::curve_file::{AxisCurve, CurveFile};
use allanite_log::{Log, OCTAVES, Options, TimeUnit, unit::Unit};
use program::rows;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fmt::Write as _, fs};
use tempfile::TempDir;

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
        ("timestamp,gx [deg/s]", 20, 50.0),
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
        // The clock of a cheap gyro is off by a per cent.
        let told_hz = 1.01 * rate_hz;
        let told = Options {
            rate_hz: Some(told_hz),
            unit: Some(Unit::RadiansPerSecond),
            scale: Some(0.5),
            ..Options::default()
        };
        let log = read_text(&text, &told).unwrap();
        assert_eq!(
            (log.rate_hz, log.unit),
            (told_hz, Unit::RadiansPerSecond),
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
fn lost_rows_are_filled_and_repeated_rows_are_left_out() {
    let noise = counts();
    let mut expected = Accumulator::<OCTAVES>::new();
    let mut text = String::from("timestamp [us],gx [deg/s]\n");
    for (i, count) in noise.iter().flatten().cycle().take(400).enumerate() {
        if (200..220).contains(&i) {
            if i == 200 {
                expected.lost(20);
            }
            continue;
        }
        let _ = writeln!(text, "{},{count}", 5000 * i);
        expected.push(*count);
        if i == 50 {
            let _ = writeln!(text, "{},{count}", 5000 * i);
        }
    }
    for given in [None, Some(200.5)] {
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

/// White noise at 40 Hz, of which every fiftieth row is lost on average.
#[test]
fn single_lost_rows_leave_all_octaves_and_the_noise() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let (mut text, mut whole) = (String::from("time [s],gx [deg/s]\n"), String::new());
    whole += &text;
    for i in 0..24_000 {
        let count = (100.0 * random.sample::<f64, _>(StandardNormal)).round();
        let row = format!("{:.3},{count}\n", 0.025 * f64::from(i));
        whole += &row;
        if i < 100 || random.random::<f64>() >= 0.02 {
            text += &row;
        }
    }
    let read = |text| read_text(text, &Options::default()).unwrap();
    let (log, whole) = (read(&text), read(&whole));
    let notes = log.notes.join("\n");
    assert!(notes.contains("gaps bridged"), "{notes}");
    let curve = |log: &Log| AxisCurve::of(&log.axes[0], log.rate_hz, log.unit).unwrap();
    let (curve, whole) = (curve(&log), curve(&whole));
    assert_eq!(curve.octaves.len(), whole.octaves.len());
    assert!(curve.samples < 23_700 && curve.gaps == 0 && whole.bridged.is_empty());
    for (octave, all) in curve.octaves.iter().zip(&whole.octaves).take(9) {
        // Without what is taken off, the octave of m = 4 is 5 % below.
        let ratio = octave.variance / all.variance;
        assert!((ratio - 1.0).abs() < 0.02, "m = {}: {ratio}", octave.m);
    }
    // The spectrum has all its levels too, and counts fewer segments than they have.
    let spectra = [&curve, &whole].map(|curve| curve.spectrum().unwrap());
    let [bins, all] = spectra.each_ref().map(|spectrum| spectrum.all());
    assert_eq!(bins.len(), all.len());
    assert!(bins[0].segments < all[0].segments);
    assert!(
        bins.iter()
            .zip(all)
            .all(|(bin, whole)| bin.segments <= whole.segments)
    );
    let ratio = bins
        .iter()
        .zip(all)
        .take(28)
        .map(|(bin, whole)| bin.density / whole.density);
    let ratio = ratio.sum::<f64>() / 28.0;
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    let merged = AxisCurve::merged(std::slice::from_ref(&curve)).unwrap();
    assert_eq!(merged.octaves, curve.octaves);
    let merged = merged.spectrum().unwrap();
    assert!(
        merged
            .all()
            .iter()
            .zip(bins)
            .all(|(one, other)| one.segments == other.segments)
    );
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("curve.json");
    let file = CurveFile::new(vec![curve]).to_json().unwrap();
    assert!(file.contains("segments_of_bins"));
    fs::write(&path, file).unwrap();
    let back = CurveFile::read(&path).unwrap();
    assert_eq!(back.axes[0].spectrum().unwrap(), spectra[0]);
}

#[test]
fn unusable_stamps_are_refused_with_their_row() {
    let regular = || (0..3000).map(|i| 5000 * i);
    let slower = regular().chain((1..500).map(|i| 5000 * 2999 + 10_000 * i));
    let back = regular().chain([7]);
    let coarse = (0..3000).map(|i| (i - i % 10 / 9) * 5000);
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
            "a.csv: time stamps repeat in 300 of 3000 rows: too coarse, or written in bursts; \
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
        line.starts_with("a.csv: the sampling rate is not known: column 1 only counts rows, "),
        "{line}"
    );
}

#[test]
fn stamps_without_a_unit_are_refused_if_several_units_fit() {
    for (header, step, expected) in rows! {
        "t,gx [deg/s]", 1, "t: no unit is told, and it may be s (1 Hz) or ms (1000 Hz)";
        "time,gx [deg/s]", 5, "time: no unit is told, and it may be s (0.2 Hz) or ms (200 Hz)";
        "timestamp,gx [deg/s]", 10, "may be s (0.1 Hz) or ms (100 Hz)";
        "timestamp,gx [deg/s]", 50, "may be ms (20 Hz) or µs (20000 Hz)";
        "timestamp,gx [deg/s]", 40_000, "may be µs (25 Hz) or ns (25000 Hz)";
        "timestamp,gx [deg/s]", 400_000_000_000, "no unit is told, and none gives a usual rate";
        "t [min],gx [deg/s]", 1, "time column t [min]: the unit \"min\" is not known";
        "time_10us,gx [deg/s]", 500, "the unit \"10us\" is not known";
        "time_hours,gx [deg/s]", 1, "the unit \"hours\" is not known";
    } {
        let text = stamped(header, (0..200).map(|i| i * step));
        let line = read_text(&text, &Options::default()).unwrap_err();
        assert!(
            line.contains(expected) && line.ends_with("; choose with --time-unit, or give --rate"),
            "{line}"
        );
        let told = Options {
            time_unit: Some(TimeUnit::Us),
            ..Options::default()
        };
        assert_eq!(read_text(&text, &told).unwrap().rate_hz, 1e6 / step as f64);
    }
    // Stamps in seconds since 1970 have no other unit, however slow they are.
    let text = stamped("t,gx [deg/s]", (0..200).map(|i| 1_700_000_000 + i));
    assert_eq!(read_text(&text, &Options::default()).unwrap().rate_hz, 1.0);
}

#[test]
fn rate_that_the_stamps_contradict_is_refused() {
    let text = stamped("time_us,gx [deg/s]", (0..200).map(|i| i * 5000));
    for (rate_hz, agrees) in [
        (200.0, true),
        (197.0, true),
        (190.0, false),
        (100.0, false),
        (400.0, false),
        (0.2, false),
        (1e6, false),
    ] {
        let options = Options {
            rate_hz: Some(rate_hz),
            ..Options::default()
        };
        match read_text(&text, &options) {
            Ok(log) => assert!(agrees && log.rate_hz == rate_hz),
            Err(line) => assert!(
                !agrees
                    && line.ends_with(
                        " Hz, but the time stamps of time_us give 200 Hz; \
                         omit --rate, correct --time-unit, or drop the column of time stamps"
                    ),
                "{line}"
            ),
        }
    }
}

#[test]
fn rows_missing_at_random_are_read_up_to_a_fifth_if_stamps_are_exact() {
    for percent in [0, 2, 8, 10, 30, 50] {
        let mut state = 1_u32;
        let is_kept = |_: &i64| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % 100 >= percent
        };
        let kept: Vec<i64> = (0..3000).filter(is_kept).map(|i| 10_000 * i).collect();
        let text = stamped("time_us,gx [deg/s]", kept.into_iter());
        match read_text(&text, &Options::default()) {
            Ok(log) => assert!(percent <= 10 && log.rate_hz == 100.0, "{percent} %"),
            Err(line) => assert!(
                percent > 10 && line.contains("rows are missing, or stamps are too coarse"),
                "{percent} %: {line}"
            ),
        }
    }
}

#[test]
fn units_that_are_told_are_obeyed_or_refused() {
    let read = |header: &str, unit: Option<Unit>, scale: Option<f64>| {
        let text = stamped(header, (0..200).map(|i| i * 5000));
        let options = Options {
            unit,
            scale,
            ..Options::default()
        };
        let log = read_text(&text, &options)?;
        Ok::<_, String>((log.unit, log.axes[0].rate_per_count))
    };
    let (deg, rad) = (Unit::DegreesPerSecond, Unit::RadiansPerSecond);
    let [mdps, degrees] = ["time_us,gx [mdps]", "time_us,gx [deg/s]"];
    assert_eq!(read(mdps, None, None), Ok((deg, 1e-3)));
    assert_eq!(read(mdps, Some(deg), None), Ok((deg, 1e-3)));
    assert_eq!(read(mdps, None, Some(70.0)), Ok((deg, 0.07)));
    assert_eq!(read(mdps, Some(deg), Some(0.07)), Ok((deg, 0.07)));
    assert_eq!(read(degrees, Some(rad), Some(0.5)), Ok((rad, 0.5)));
    for header in [mdps, degrees] {
        let line = read(header, Some(rad), None).unwrap_err();
        assert!(
            line.contains("the unit is said to be rad/s, but the columns are named in deg/s"),
            "{line}"
        );
    }
    for unknown in ["rpm", "rad/h", "counts"] {
        let header = format!("time_us,gx [{unknown}]");
        for (unit, scale) in [(None, None), (Some(deg), None), (None, Some(0.5))] {
            let line = read(&header, unit, scale).unwrap_err();
            let expected = format!("column gx [{unknown}]: the unit \"{unknown}\" is not known; ");
            assert!(line.contains(&expected), "{line}");
        }
        assert_eq!(read(&header, Some(deg), Some(0.5)), Ok((deg, 0.5)));
    }
}
