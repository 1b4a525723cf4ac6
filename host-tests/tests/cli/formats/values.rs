//! Values that were written are read back, and contradictory requests are refused.

use super::{
    ACCELEROMETER, GYRO, assert_sums, counts, fixture, of, read, read_text, topic, try_read,
};
use allanite_log::{
    Options,
    unit::{Sensor, Unit},
};
use program::rows;
use std::fmt::Write as _;

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
fn detected_columns_units_and_rate_are_noted_on_one_line() {
    let notes = read("euroc.csv", &Options::default()).notes;
    assert_eq!(
        notes,
        [
            "taken as axes: w_RS_S_x [rad s^-1], w_RS_S_y [rad s^-1], w_RS_S_z [rad s^-1]; \
             left out a_RS_S_x [m s^-2], a_RS_S_y [m s^-2], a_RS_S_z [m s^-2] \
             (choose with --columns or --sensor accel); unit rad/s from the column names; \
             200 Hz from the time stamps of timestamp, in ns",
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
fn bags_and_logs_of_no_or_several_sensors_are_refused_with_a_list_of_their_topics() {
    for (name, options, expected) in rows! {
        "two-imus.mcap",
            Options::default(),
            "two-imus.mcap: there are 2 IMU topics: /imu/left, /imu/right; choose one with --topic";
        "two-imus.mcap",
            topic("/words"),
            "two-imus.mcap: no IMU topic is named \"/words\"; \
             choose with --topic from /imu/left, /imu/right";
        "no-imu.mcap",
            Options::default(),
            "no-imu.mcap: no topic of sensor_msgs/msg/Imu: \
             only /words (std_msgs/msg/String, cdr); give a bag with an IMU, or name a topic of other messages with rates with --topic";
        "no-gyro.ulg",
            Options::default(),
            "no-gyro.ulg: no topic of sensor_gyro, sensor_accel, sensor_combined, vehicle_imu with \
             messages: there are cpuload:0; \
             log one of these, or choose with --topic and --columns";
        "two-gyros.ulg",
            Options::default(),
            "two-gyros.ulg: 2 topics fit equally well: sensor_gyro:0, sensor_gyro:1; \
             choose one with --topic";
        "gyro.ulg",
            topic("sensor_gyro:1"),
            "gyro.ulg: no topic \"sensor_gyro:1\" has messages; \
             choose with --topic from sensor_gyro:0, sensor_combined:0, cpuload:0";
        "euroc.csv", topic("/imu"), "euroc.csv: this kind of log has no topics; omit --topic";
        "stamped.npy",
            Options { sensor: Some(Sensor::Gyro), unit: Some(Unit::StandardGravity), ..Options::default() },
            "--unit g is not a unit of a gyro; give another --unit or --sensor";
    } {
        assert_eq!(try_read(&fixture(name), &options).unwrap_err(), expected);
    }
}

#[test]
fn contradictory_and_impossible_units_are_refused_and_doubtful_ones_noted() {
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
        "a.csv: columns gx [rad/s] and gy [deg/s] have different units; \
         choose columns of one unit with --columns, or give --unit and --scale"
    );
    let doubtful = format!("gx [rad/s],temp\n{}", rows(0.2));
    let notes = read_text(&doubtful, &options).unwrap().notes.join("\n");
    assert!(
        notes.contains("is unlikely for a gyro at rest: check --scale and --unit"),
        "{notes}"
    );
    let impossible = format!("gx [rad/s],temp\n{}", rows(1e3));
    let line = read_text(&impossible, &options).unwrap_err();
    assert!(
        line.contains("is impossible for a gyro at rest; check --scale and --unit"),
        "{line}"
    );
    let milli = format!("gx [mdps],temp\n{}", rows(1.0));
    let log = read_text(&milli, &options).unwrap();
    assert_eq!(
        (log.unit, log.axes[0].rate_per_count),
        (Unit::DegreesPerSecond, 1e-3)
    );
}
