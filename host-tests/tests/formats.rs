//! Logs that the formats' own libraries wrote: read to the value, and refused where they are broken.

use allanite::Accumulator;
use host_tests::{
    log::{self, Log, OCTAVES, Options, TimeUnit},
    unit::{Sensor, Unit},
};
use indicatif::ProgressBar;
use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};
use tempfile::TempDir;

const ROWS: usize = 48;

/// What a count of the fixtures is: powers of two, so that every value is exact.
const GYRO: f64 = 1.0 / 1024.0;
const ACCELEROMETER: f64 = 1.0 / 256.0;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

/// The counts that `make.py` made: three of a gyro, three of an accelerometer.
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

/// Every sum of the log's axes is that of these rows of the generator, exactly.
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

#[test]
fn every_format_gives_the_values_that_were_written() {
    let rows = counts();
    let gyro = of(Sensor::Gyro);
    let accelerometer = of(Sensor::Accelerometer);
    let default = Options::default();
    let half: Vec<_> = rows.iter().step_by(2).copied().collect();
    for (name, options, rows, first, rate_hz) in [
        ("euroc.csv", &default, &rows[..], 0, 200.0),
        ("euroc.csv", &accelerometer, &rows, 3, 200.0),
        ("imu-zstd.mcap", &default, &rows, 0, 200.0),
        ("imu-zstd.mcap", &accelerometer, &rows, 3, 200.0),
        ("imu-lz4.mcap", &gyro, &rows, 0, 200.0),
        ("imu-plain.mcap", &default, &rows[..16], 0, 200.0),
        ("two-imus.mcap", &topic("/imu/right"), &rows, 0, 200.0),
        ("ros1.mcap", &default, &rows, 0, 200.0),
        ("ros1.mcap", &accelerometer, &rows, 3, 200.0),
        ("gyro.ulg", &default, &rows, 0, 200.0),
        ("gyro.ulg", &accelerometer, &half, 3, 100.0),
        ("gyro.ulg", &topic("sensor_combined"), &half, 0, 100.0),
        ("two-gyros.ulg", &topic("sensor_gyro:0"), &rows, 0, 200.0),
    ] {
        let log = read(name, options);
        let (scale, unit) = match first {
            0 => (GYRO, Unit::RadiansPerSecond),
            _ => (ACCELEROMETER, Unit::MetresPerSecondSquared),
        };
        assert_eq!((log.rate_hz, log.unit), (rate_hz, unit), "{name}");
        assert_sums(&log, rows.iter(), first, scale, name);
    }
    let half_as_noisy = read("two-gyros.ulg", &topic("sensor_gyro:1"));
    assert_sums(&half_as_noisy, rows.iter(), 0, GYRO / 2.0, "second gyro");
    let stamped = read("stamped.npy", &default);
    assert_eq!(
        (stamped.rate_hz, stamped.unit),
        (200.0, Unit::DegreesPerSecond)
    );
    assert_sums(&stamped, rows.iter(), 0, GYRO, "stamped.npy");
    let options = Options {
        rate_hz: Some(200.0),
        scale: Some(GYRO),
        ..Options::default()
    };
    assert_sums(
        &read("counts.npy", &options),
        rows.iter(),
        0,
        GYRO,
        "counts.npy",
    );
}

#[test]
fn what_was_found_is_said_on_one_line() {
    let notes = read("euroc.csv", &Options::default()).notes;
    assert_eq!(
        notes,
        [
            "taken as axes: w_RS_S_x [rad s^-1], w_RS_S_y [rad s^-1], w_RS_S_z [rad s^-1]; \
             left out a_RS_S_x [m s^-2], a_RS_S_y [m s^-2], a_RS_S_z [m s^-2] \
             (choose with --columns or --sensor accel); unit rad/s by their names; \
             200 Hz by the time stamps of timestamp, in ns",
            "time stamps 5ms apart, jitter 0s rms, 0s at most",
        ]
    );
    let notes = read("gyro.ulg", &Options::default()).notes.join("\n");
    assert!(
        notes.contains(
            "topic sensor_gyro:0 of 48 messages; others: sensor_combined:0 (24 messages)"
        ),
        "{notes}"
    );
}

#[test]
fn bags_and_logs_of_no_or_several_sensors_are_refused_by_what_they_hold() {
    for (name, options, expected) in [
        (
            "two-imus.mcap",
            Options::default(),
            "two-imus.mcap: 2 IMUs: /imu/left, /imu/right; choose one with --topic",
        ),
        (
            "two-imus.mcap",
            topic("/words"),
            "two-imus.mcap: there is no IMU's topic \"/words\"; \
             choose with --topic from /imu/left, /imu/right",
        ),
        (
            "no-imu.mcap",
            Options::default(),
            "no-imu.mcap: no topic of sensor_msgs/msg/Imu: \
             only /words (std_msgs/msg/String, cdr); give a bag with an IMU",
        ),
        (
            "no-gyro.ulg",
            Options::default(),
            "no-gyro.ulg: no topic of sensor_gyro, sensor_accel, sensor_combined, vehicle_imu with \
             messages: there are cpuload:0; \
             log one of these, or choose with --topic and --columns",
        ),
        (
            "two-gyros.ulg",
            Options::default(),
            "two-gyros.ulg: 2 that fit equally: sensor_gyro:0, sensor_gyro:1; \
             choose one with --topic",
        ),
        (
            "gyro.ulg",
            topic("sensor_gyro:1"),
            "gyro.ulg: there is no topic \"sensor_gyro:1\" with messages; \
             choose with --topic from sensor_gyro:0, sensor_combined:0, cpuload:0",
        ),
        (
            "euroc.csv",
            topic("/imu"),
            "euroc.csv: has no topics; leave --topic",
        ),
        (
            "stamped.npy",
            Options {
                sensor: Some(Sensor::Gyro),
                unit: Some(Unit::StandardGravity),
                ..Options::default()
            },
            "--unit g is not one of a gyro; give another --unit or --sensor",
        ),
    ] {
        assert_eq!(try_read(&fixture(name), &options).unwrap_err(), expected);
    }
}

#[test]
fn truncation_at_any_byte_is_refused_or_gives_the_rows_before_it_aloud() {
    let rows = counts();
    let folder = TempDir::new().unwrap();
    for name in [
        "imu-zstd.mcap",
        "imu-lz4.mcap",
        "imu-plain.mcap",
        "gyro.ulg",
        "euroc.csv",
        "stamped.npy",
    ] {
        let bytes = fs::read(fixture(name)).unwrap();
        let path = folder.path().join(name);
        let mut whole = 0;
        for cut in 0..bytes.len() {
            fs::write(&path, &bytes[..cut]).unwrap();
            let Ok(log) = try_read(&path, &Options::default()) else {
                continue;
            };
            assert!(
                name.ends_with("ulg") || name.ends_with("csv"),
                "{name} {cut}"
            );
            let said = log.notes.iter().any(|note| note.contains("cut off"));
            let samples = log.axes[0].accumulator.samples() as usize;
            let what = format!("{name} cut at {cut}");
            if name.ends_with("csv") {
                // The last row may be the half of one.
                let is_whole = bytes[..cut].ends_with(b"\n");
                assert_eq!(said, !is_whole, "{what}");
                whole += usize::from(is_whole);
                if !is_whole {
                    continue;
                }
            } else {
                whole += usize::from(!said);
            }
            // Of a ULog cut so short, another topic may be the longer one.
            let every = if log.rate_hz == 200.0 { 1 } else { 2 };
            let before = rows.iter().step_by(every).take(samples);
            assert_sums(&log, before, 0, GYRO, &what);
        }
        // Cuts between rows leave a whole file, and no others do.
        assert!(whole <= 2 * ROWS, "{name}: {whole}");
    }
}

#[test]
fn any_changed_byte_of_a_ulog_is_met_without_a_panic() {
    let bytes = fs::read(fixture("gyro.ulg")).unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ulg");
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x41;
        fs::write(&path, &changed).unwrap();
        // A ULog has no checksum: a changed value is a value, but rows do not come from nowhere.
        if let Ok(log) = try_read(&path, &Options::default()) {
            assert!(log.axes[0].accumulator.samples() <= ROWS as u64);
        }
    }
}

#[test]
fn any_changed_byte_of_a_bag_is_met_without_a_panic() {
    let rows = counts();
    let bytes = fs::read(fixture("imu-plain.mcap")).unwrap();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.mcap");
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x41;
        fs::write(&path, &changed).unwrap();
        if let Ok(log) = try_read(&path, &Options::default()) {
            assert_sums(
                &log,
                rows[..16].iter(),
                0,
                GYRO,
                &format!("byte {at} changed"),
            );
        }
    }
}

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
            // When it was recorded, in bursts.
            let recorded = 1_700_000_001 + i / 50;
            let (sec, nanosec) = (stamp / 1_000_000_000, stamp % 1_000_000_000);
            let _ = writeln!(text, "{recorded},{sec},{nanosec},{count}");
        }
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!((log.rate_hz, log.axes.len()), (200.0, 1), "{sec}");
        assert!(log.axes[0].accumulator.gaps() == 0 && log.axes[0].accumulator.samples() == 600);
        let name = format!("200 Hz by the time stamps of {sec} and {nanosec}, in ns");
        assert!(log.notes[0].ends_with(&name), "{}", log.notes[0]);
    }
}

#[test]
fn gaps_end_stretches_and_repeated_rows_are_left_out() {
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
                && notes.contains("1 row with the stamp before it left out"),
            "{notes}"
        );
    }
}

#[test]
fn stamps_that_say_nothing_are_refused_with_their_row() {
    let regular = || (0..3000).map(|i| 5000 * i);
    let slower = regular().chain((1..500).map(|i| 5000 * 2999 + 10_000 * i));
    let back = regular().chain([7]);
    let coarse = (0..3000).map(|i| i / 4 * 20_000);
    for (stamps, expected) in [
        (
            slower.collect::<Vec<_>>(),
            "a.csv:3017: two rates in one log: time stamps are 10ms apart up to here, and were 5ms \
             apart before; cut the record there, or give --rate to leave the stamps out",
        ),
        (
            back.collect(),
            "a.csv:3002: time stamps go back from 14995000 to 7; \
             cut the record there, or give --rate to leave the stamps out",
        ),
        (
            coarse.collect(),
            "a.csv: time stamps repeat in 2250 of 3000 rows: too coarse, or written in bursts; \
             give --rate to leave them out",
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

#[test]
fn units_that_contradict_or_cannot_be_are_refused_and_doubtful_ones_doubted() {
    let rows = |scale: f64| {
        counts().iter().fold(String::new(), |mut text, row| {
            let _ = writeln!(text, "{},{}", f64::from(row[0]) * scale, row[1]);
            text
        })
    };
    let options = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    let mixed = format!("gx [rad/s],gy [deg/s]\n{}", rows(0.1));
    assert_eq!(
        read_text(&mixed, &options).unwrap_err(),
        "a.csv: columns gx [rad/s] and gy [deg/s] are of different units; \
         choose those of one unit with --columns, or say --unit and --scale"
    );
    let doubtful = format!("gx [rad/s],temp\n{}", rows(0.2));
    let notes = read_text(&doubtful, &options).unwrap().notes.join("\n");
    assert!(
        notes.contains("are unlikely of a gyro at rest: check --scale and --unit"),
        "{notes}"
    );
    let impossible = format!("gx [rad/s],temp\n{}", rows(1e3));
    let line = read_text(&impossible, &options).unwrap_err();
    assert!(
        line.contains("are impossible of a gyro at rest; check --scale and --unit"),
        "{line}"
    );
    let milli = format!("gx [mdps],temp\n{}", rows(1.0));
    let log = read_text(&milli, &options).unwrap();
    assert_eq!(
        (log.unit, log.axes[0].rate_per_count),
        (Unit::DegreesPerSecond, 1e-3)
    );
}
