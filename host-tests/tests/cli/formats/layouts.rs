//! Layouts that nobody listed: words, units, orders, separators, dates and headers, combined at random. What is read is the
//! gyro's three axes in their unit, or nothing.

use super::read_text;
use allanite_log::{Log, Options, unit::Unit};
use std::fmt::Write as _;

const ROWS: usize = 60;
const LAYOUTS: u32 = 500;

/// Names of a gyro's axes: `@` is the letter, `$` the capital letter, `%` the number.
const GYRO: [&str; 26] = [
    "gyro_@",
    "Gyro $",
    "gyr$",
    "g@",
    "w@",
    "w_@",
    "angular_velocity.@",
    "Angular Velocity $",
    "angular_vel_@",
    "AngVel$",
    "ang_vel_@",
    "turn_rate_@",
    "rotation_rate_@",
    "RotationRate$",
    "imu_g@",
    "imu0.gyro.@",
    "omega_@",
    "@Gyro",
    "@_gyro",
    "rate_@",
    "gyroscope[%]",
    "rot%",
    "body_rate_@",
    "GYRO_$",
    "sensor1_g@",
    "angularSpeed$",
];

/// Names of axes that need their unit.
const GYRO_WITH_UNIT: [&str; 3] = ["As$", "@Rate", "@-axis"];

const ACCELEROMETER: [&str; 10] = [
    "acc_@",
    "Accel $",
    "a@",
    "linear_acceleration.@",
    "Linear Acceleration $",
    "@Accel",
    "imu_a@",
    "accelerometer[%]",
    "ACC_$",
    "a_@",
];

/// Units behind the name of an axis.
const RATES: [(&str, Unit); 12] = [
    (" [deg/s]", Unit::DegreesPerSecond),
    (" (°/s)", Unit::DegreesPerSecond),
    ("(deg/s)", Unit::DegreesPerSecond),
    ("_dps", Unit::DegreesPerSecond),
    ("_deg_s", Unit::DegreesPerSecond),
    ("_deg_per_s", Unit::DegreesPerSecond),
    ("_degs", Unit::DegreesPerSecond),
    (" (rad/s)", Unit::RadiansPerSecond),
    (" [rad s^-1]", Unit::RadiansPerSecond),
    ("_rad_s", Unit::RadiansPerSecond),
    ("_rad_per_s", Unit::RadiansPerSecond),
    ("_rad_per_sec", Unit::RadiansPerSecond),
];
const ACCELERATIONS: [&str; 5] = ["", " (g)", " [m/s^2]", "_g", "_m_s2"];

/// Writes a time in milliseconds.
type Write = fn(u32) -> String;

/// Names of times, and how they are written.
const TIMES: [(&str, Write); 9] = [
    ("time", |ms| format!("{:.3}", f64::from(ms) / 1e3)),
    ("t_us", |ms| (ms * 1000).to_string()),
    ("timestamp (ms)", |ms| ms.to_string()),
    ("elapsed (s)", |ms| format!("{:.3}", f64::from(ms) / 1e3)),
    ("Time", |ms| format!("2026-03-02T07:48:{}", seconds(ms))),
    ("Date", |ms| format!("3/2/2026 7:48:{}", seconds(ms))),
    ("Zeit", |ms| format!("02.03.2026 07:48:{}", seconds(ms))),
    ("stamp", |ms| format!("02-Mar-2026 07:48:{}", seconds(ms))),
    ("time of day", |ms| format!("07:48:{}", seconds(ms))),
];

fn seconds(ms: u32) -> String {
    format!("{:02}.{:03}", ms / 1000, ms % 1000)
}

struct Random(u32);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % n
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

fn axes(template: &str, unit: &str) -> Vec<String> {
    let one = |i: usize| {
        let (letter, capital) = (["x", "y", "z"][i], ["X", "Y", "Z"][i]);
        let name = template.replace('@', letter).replace('$', capital);
        name.replace('%', &i.to_string()) + unit
    };
    (0..3).map(one).collect()
}

struct Layout {
    text: String,
    /// The same axes in the plainest layout.
    plain: String,
    unit: Option<Unit>,
}

fn layout(random: &mut Random) -> Layout {
    let (rate_unit, unit) = match random.below(3) {
        0 => ("", None),
        _ => {
            let (text, unit) = random.of(&RATES);
            (text, Some(unit))
        }
    };
    let is_in_words = rate_unit.starts_with('_');
    let mut template = random.of(&GYRO);
    if unit.is_some() && !is_in_words && random.below(4) == 0 {
        template = random.of(&GYRO_WITH_UNIT);
    }
    if is_in_words && (template.contains([' ', '[', '.'])) {
        template = "gyro_@";
    }
    let acceleration = match random.of(&ACCELERATIONS) {
        text if template == "@-axis" && !text.contains(['(', '[']) => " (g)",
        text => text,
    };
    let mut acceleration_name = random.of(&ACCELEROMETER);
    if template == "@-axis" {
        acceleration_name = "acc_@";
    }
    if acceleration.starts_with('_') && acceleration_name.contains([' ', '[', '.']) {
        acceleration_name = "acc_@";
    }
    let (separator, decimal) =
        random.of(&[(",", "."), (";", "."), ("\t", "."), (";", ","), ("\t", ",")]);
    let (time, written) = random.of(&TIMES);
    let mut columns: Vec<(String, usize)> = Vec::new();
    let gyro = axes(template, rate_unit).into_iter().zip(0..3);
    let accelerometer = axes(acceleration_name, acceleration).into_iter().zip(3..6);
    if random.below(2) == 0 {
        columns.extend(gyro.chain(accelerometer));
    } else {
        columns.extend(accelerometer.chain(gyro));
    }
    if random.below(2) == 0 {
        columns.push(("temp_C".into(), 6));
    }
    if random.below(4) == 0 {
        columns.push(("mag_x".into(), 7));
    }
    let quote = |name: &str| format!("\"{name}\"");
    let names = [time.to_owned()]
        .into_iter()
        .chain(columns.iter().map(|(name, _)| name.clone()));
    let header = match random.below(3) {
        0 => names
            .map(|name| quote(&name))
            .collect::<Vec<_>>()
            .join(separator),
        1 => format!("# {}", names.collect::<Vec<_>>().join(separator)),
        _ => names.collect::<Vec<_>>().join(separator),
    };
    let mut text = header + "\n";
    let mut plain = String::from("gx,gy,gz\n");
    for row in 0..ROWS {
        let values: Vec<String> = (0..8)
            .map(|column| {
                let noise = random.below(400) as f64 / 1e4;
                format!("{:.4}", if column == 5 { 1.0 + noise } else { noise })
            })
            .collect();
        let _ = writeln!(plain, "{}", values[..3].join(","));
        let stamp = written(10 * row as u32);
        let stamp = if decimal == "," {
            stamp.replace('.', if stamp.contains(':') { "." } else { "," })
        } else {
            stamp
        };
        let cells = columns
            .iter()
            .map(|&(_, column)| values[column].replace('.', decimal));
        let row: Vec<String> = [stamp].into_iter().chain(cells).collect();
        let _ = writeln!(text, "{}", row.join(separator));
    }
    Layout { text, plain, unit }
}

/// Whether the log holds the three axes of the plain one, in the unit that the names tell.
fn is_right(log: &Log, layout: &Layout) -> bool {
    let options = Options {
        rate_hz: Some(100.0),
        ..Options::default()
    };
    let plain = read_text(&layout.plain, &options).unwrap();
    let same = |(one, other): (&allanite_log::Axis, &allanite_log::Axis)| {
        one.accumulator == other.accumulator
    };
    log.axes.len() == 3
        && log.axes.iter().zip(&plain.axes).all(same)
        && (log.rate_hz / 100.0 - 1.0).abs() < 1e-6
        && layout.unit.is_none_or(|unit| log.unit == unit)
}

#[test]
fn layouts_that_nobody_listed_are_read_right_or_refused() {
    read_right_or_refused(1, LAYOUTS);
}

mod thorough {
    #[test]
    fn more_layouts_that_nobody_listed_are_read_right_or_refused() {
        super::read_right_or_refused(2, 4 * super::LAYOUTS);
    }
}

/// Reads so many random layouts.
fn read_right_or_refused(seed: u32, layouts: u32) {
    let mut random = Random(seed);
    let (mut right, mut refused) = (0, Vec::new());
    for _ in 0..layouts {
        let layout = layout(&mut random);
        let head: String = layout.text.lines().take(3).collect::<Vec<_>>().join("\n");
        match read_text(&layout.text, &Options::default()) {
            Ok(log) => {
                let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
                assert!(
                    is_right(&log, &layout),
                    "read {names:?} in {} at {} Hz:\n{head}",
                    log.unit,
                    log.rate_hz
                );
                right += 1;
            }
            Err(line) => refused.push(format!("{line}\n{head}\n")),
        }
    }
    assert!(
        100 * right >= 97 * layouts,
        "{right} of {layouts} are read; refused, among others:\n{}",
        refused
            .iter()
            .step_by(refused.len() / 12 + 1)
            .cloned()
            .collect::<String>()
    );
    println!(
        "{right} of {layouts} layouts are read right, {} refused",
        refused.len()
    );
}

/// A log of a gyro and an accelerometer at rest, of these names and scatters.
fn beside(names: &str, scatter: f64, gravity: f64) -> String {
    let mut random = Random(3);
    let mut text = format!("time,{names}\n");
    for row in 0..ROWS {
        let noise: Vec<f64> = (0..6)
            .map(|_| random.below(1000) as f64 / 500.0 - 1.0)
            .collect();
        let [x, y, z] = [0, 1, 2].map(|i| scatter * noise[i]);
        let [a, b, c] = [3, 4, 5].map(|i| 0.01 * gravity * noise[i]);
        let _ = writeln!(
            text,
            "{:.2},{x:.6},{y:.6},{z:.6},{a:.5},{b:.5},{:.5}",
            row as f64 / 100.0,
            c + gravity
        );
    }
    text
}

#[test]
fn without_a_unit_the_accelerometer_beside_a_gyro_tells_it() {
    for (scatter, gravity, unit) in [
        (0.002, 9.81, Unit::RadiansPerSecond),
        (0.002, 1.0, Unit::DegreesPerSecond),
        (0.1, 9.81, Unit::DegreesPerSecond),
    ] {
        let text = beside("gx,gy,gz,ax,ay,az", scatter, gravity);
        let log = read_text(&text, &Options::default()).unwrap();
        assert_eq!(log.unit, unit, "{scatter} beside {gravity}");
        let said = log.notes.join("\n");
        assert!(said.contains("assumed"), "{said}");
    }
}

#[test]
fn where_two_readings_are_plausible_both_are_spelled_out() {
    let text = beside("foo_x,foo_y,foo_z,acc_x,acc_y,acc_z", 0.05, 1.0);
    let line = read_text(&text, &Options::default()).unwrap_err();
    assert_eq!(
        line,
        "a.csv: foo_x to foo_z may be the axes of a gyro, and acc_x, acc_y, acc_z are those of an \
         accelerometer; choose with --sensor accel, or with --columns gx=2,gy=3,gz=4"
    );
    let sensor = Some(allanite_log::unit::Sensor::Accelerometer);
    let options = Options {
        sensor,
        ..Options::default()
    };
    assert_eq!(read_text(&text, &options).unwrap().axes[0].name, "acc_x");
}
