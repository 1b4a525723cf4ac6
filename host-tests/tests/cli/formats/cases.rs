//! Logs that were read wrong once, each with what must be read of it. They are simulated in the layouts of programs and
//! boards; what goes wrong in them was seen in logs of other people.

use super::{of, read_text};
use crate::formats::try_read;
use allanite_log::{
    Options,
    unit::{Sensor, Unit},
};
use std::fmt::Write as _;

/// Gaussian noise of standard deviation 1, the same in every run.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// What must be read of a log.
struct Case {
    name: &'static str,
    header: &'static str,
    /// The cells of a row: its number, the gyro's axes and the accelerometer's.
    row: fn(u32, [f64; 3], [f64; 3]) -> String,
    options: fn() -> Options,
    rows: u32,
    rate_hz: f64,
    unit: Unit,
    axes: &'static [&'static str],
    /// The white noise of an axis, in its unit.
    sigma: f64,
}

fn none() -> Options {
    Options::default()
}

/// The time of day of a row at 100 Hz.
fn clock(row: u32) -> String {
    let (ms, s) = (row % 100 * 10, 12 + row / 100);
    format!("07:{:02}:{:02}.{ms:03}", 48 + s / 60, s % 60)
}

fn gyro([x, y, z]: [f64; 3], decimals: usize, separator: &str) -> String {
    format!("{x:.decimals$}{separator}{y:.decimals$}{separator}{z:.decimals$}")
}

/// An accelerometer at rest in g.
fn gravity([x, y, z]: [f64; 3], scale: f64, separator: &str) -> String {
    let [x, y, z] = [0.003 * x, 0.003 * y, 1.0 + 0.003 * z].map(|value| scale * value);
    format!("{x:.5}{separator}{y:.5}{separator}{z:.5}")
}

const CASES: [Case; 10] = [
    Case {
        name: "a date with a blank, in American order, shifts no column",
        header: "Time\tax\tay\taz\tgx\tgy\tgz\ttemp",
        row: |n, g, a| {
            format!(
                "03/02/2026 {}\t{}\t{}\t25.1",
                clock(n),
                gravity(a, 1.0, "\t"),
                gyro(g, 4, "\t")
            )
        },
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["gx", "gy", "gz"],
        sigma: 0.05,
    },
    Case {
        name: "a date in German order, unpadded",
        header: "Zeit;gx;gy;gz",
        row: |n, g, _| format!("2.3.2026 {};{}", clock(n), gyro(g, 4, ";")),
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["gx", "gy", "gz"],
        sigma: 0.05,
    },
    Case {
        name: "a date with the month in letters",
        header: "time,gx,gy,gz",
        row: |n, g, _| format!("02-Mar-2026 {},{}", clock(n), gyro(g, 4, ",")),
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["gx", "gy", "gz"],
        sigma: 0.05,
    },
    Case {
        name: "angular rates that are named by their unit alone",
        header: "time\tDeviceName\tChipTime()\tAccX(g)\tAccY(g)\tAccZ(g)\tAsX(°/s)\tAsY(°/s)\tAsZ(°/s)\tAngleX(°)\tTemperature(°C)",
        row: |n, g, a| {
            let (accelerometer, gyro) = (gravity(a, 1.0, "\t"), gyro(g, 3, "\t"));
            format!(
                "2026-03-02T{}\tWT901(COM5)\tnull\t{accelerometer}\t{gyro}\t-0.44\t29.00",
                clock(n)
            )
        },
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["AsX", "AsY", "AsZ"],
        sigma: 0.05,
    },
    Case {
        name: "the accelerometer first, rates by their unit",
        header: "timeCntr ( msec ),xAccel (g),yAccel (g),zAccel (g),xRate (deg/s),yRate (deg/s),zRate (deg/s)",
        row: |n, g, a| format!("{},{},{}", 10 * n, gravity(a, 1.0, ","), gyro(g, 5, ",")),
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["xRate", "yRate", "zRate"],
        sigma: 0.05,
    },
    Case {
        name: "names of several words; the accelerometer beside it tells the unit",
        header: "time,Angular Velocity X,Angular Velocity Y,Angular Velocity Z,Linear Acceleration X,Linear Acceleration Y,Linear Acceleration Z",
        row: |n, g, a| {
            format!(
                "{:.2},{},{}",
                0.01 * f64::from(n),
                gyro(g, 5, ","),
                gravity(a, 9.81, ",")
            )
        },
        options: none,
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::RadiansPerSecond,
        axes: &[
            "Angular Velocity X",
            "Angular Velocity Y",
            "Angular Velocity Z",
        ],
        sigma: 0.001,
    },
    Case {
        name: "a prefix that all columns have",
        header: "time,imu_gx,imu_gy,imu_gz,imu_ax,imu_ay,imu_az",
        row: |n, g, a| {
            format!(
                "{:.2},{},{}",
                0.01 * f64::from(n),
                gyro(g, 5, ","),
                gravity(a, 9.81, ",")
            )
        },
        options: || of(Sensor::Gyro),
        rows: 2500,
        rate_hz: 100.0,
        unit: Unit::RadiansPerSecond,
        axes: &["imu_gx", "imu_gy", "imu_gz"],
        sigma: 0.001,
    },
    Case {
        name: "three samples of a radio packet share a stamp",
        header: "epoc (ms),timestamp (+0100),elapsed (s),x-axis (deg/s),y-axis (deg/s),z-axis (deg/s)",
        row: |n, g, _| {
            let ms = 30 * u64::from(n / 3);
            let at = 1_699_999_999_994 + ms;
            let seconds = ms as f64 / 1000.0;
            format!(
                "{at},2023-11-14T22.13.{:06.3},{seconds:.3},{}",
                19.994 + seconds % 30.0,
                gyro(g, 3, ",")
            )
        },
        options: none,
        rows: 2001,
        rate_hz: 100.0,
        unit: Unit::DegreesPerSecond,
        axes: &["x-axis", "y-axis", "z-axis"],
        sigma: 0.06,
    },
    Case {
        name: "every twentieth stamp is late by most of an interval",
        header: "time,gyro_x",
        row: |n, [x, ..], _| {
            let late = if n % 20 == 19 { 0.004 } else { 0.0 };
            format!("{:.6},{x:.7}", 0.005 * f64::from(n) + late)
        },
        options: || Options {
            unit: Some(Unit::RadiansPerSecond),
            ..none()
        },
        rows: 4000,
        rate_hz: 200.0,
        unit: Unit::RadiansPerSecond,
        axes: &["gyro_x"],
        sigma: 0.001,
    },
    Case {
        name: "stamps of 5 ms of which none is missing",
        header: "time,gyro_x",
        row: |n, [x, ..], _| format!("{:.3},{x:.6}", 0.005 * f64::from(n)),
        options: || Options {
            unit: Some(Unit::RadiansPerSecond),
            ..none()
        },
        rows: 4000,
        rate_hz: 200.0,
        unit: Unit::RadiansPerSecond,
        axes: &["gyro_x"],
        sigma: 0.004,
    },
];

#[test]
fn every_layout_that_was_read_wrong_is_read_right() {
    for case in &CASES {
        let mut noise = Noise(42);
        let mut text = format!("{}\n", case.header);
        for row in 0..case.rows {
            let g = [(); 3].map(|()| case.sigma * noise.next());
            let a = [(); 3].map(|()| noise.next());
            let _ = writeln!(text, "{}", (case.row)(row, g, a));
        }
        let log = read_text(&text, &(case.options)())
            .unwrap_or_else(|line| panic!("{}: {line}", case.name));
        let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!(names, case.axes, "{}", case.name);
        assert_eq!(log.unit, case.unit, "{}", case.name);
        let rate = log.rate_hz / case.rate_hz;
        assert!(
            (rate - 1.0).abs() < 1e-3,
            "{}: {} Hz",
            case.name,
            log.rate_hz
        );
        let notes = log.notes.join("\n");
        assert!(!notes.contains("samples lost"), "{}: {notes}", case.name);
        for axis in &log.axes {
            let octave = axis.accumulator.octave(0).unwrap();
            assert_eq!(
                axis.accumulator.samples(),
                u64::from(case.rows),
                "{}",
                case.name
            );
            let variance = 0.5 * octave.sum.to_real() / octave.differences as f64;
            let ratio = variance.sqrt() * axis.rate_per_count / case.sigma;
            assert!((ratio - 1.0).abs() < 0.06, "{}: {ratio}", case.name);
        }
    }
}

/// A log of one axis, whose stamps advance by these milliseconds in turn.
fn stamps(steps_ms: &[u32], rows: usize) -> String {
    let (mut noise, mut time_ms) = (Noise(7), 0);
    let mut text = String::from("time_ms,gx [rad/s]\n");
    for step in steps_ms.iter().cycle().take(rows) {
        let _ = writeln!(text, "{time_ms},{:.6}", 0.001 * noise.next());
        time_ms += step;
    }
    text
}

#[test]
fn a_rate_that_the_stamps_contradict_is_refused_with_both() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("log.csv");
    // 125 Hz; and 201 Hz in stamps of whole milliseconds, which the name of the sensor's rate promises as 208.
    for (steps_ms, told_hz, said, true_hz) in [
        (&[8][..], 2000.0, "125 Hz", 125.0),
        (
            &[5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 4][..],
            208.0,
            "201.6",
            // Of the whole log; a refusal looks at its first rows.
            1000.0 / 4.95,
        ),
    ] {
        std::fs::write(&path, stamps(steps_ms, 6000)).unwrap();
        let options = Options {
            rate_hz: Some(told_hz),
            ..none()
        };
        let line = try_read(&path, &options).unwrap_err();
        assert!(
            line.contains(&format!("{told_hz} Hz")) && line.contains(said),
            "{line}"
        );
        let log = try_read(&path, &none()).unwrap();
        assert!(
            (log.rate_hz / true_hz - 1.0).abs() < 1e-3,
            "{}",
            log.rate_hz
        );
    }
}
