//! Lines for the YAML of two odometries: VINS-Fusion's configuration and LIO-SAM's params.yaml.
//!
//! VINS-Fusion's `gyr_n` and `gyr_w` are discrete-time. `IntegrationBase::midPointIntegration` adds to the angle's
//! variance `2 (½ dt gyr_n)²` at each sample, for two ends that it takes for independent, and to the bias `(dt gyr_w)²`.
//! Continuous-time noise adds `N² dt` and `K² dt`, so that they are `N √(2 rate)` in rad/s and `K √rate` in rad/s².
//! LIO-SAM gives `imuGyrNoise` squared to GTSAM, which takes it for continuous-time, and multiplies `imuGyrBiasN` by the
//! root of the time between two frames: they are N and K.

use super::{
    arguments::Arguments,
    characterisation::{Characterisation, Choice},
    decimal::decimal,
    given::Given,
    summary,
};
use std::fmt::Write;

/// The names and factors of a program's configuration.
struct Names {
    indent: &'static str,
    /// White noise and random walk of the gyro, then of the accelerometer.
    keys: [&'static str; 4],
    units: [&'static str; 4],
    topic: &'static str,
    /// What N is multiplied by, and what K is.
    factors: fn(f64) -> [f64; 2],
    note: &'static str,
}

const VINS_FUSION: Names = Names {
    indent: "",
    keys: ["gyr_n", "gyr_w", "acc_n", "acc_w"],
    units: [
        "rad/s, N sqrt(2 rate)",
        "rad/s^2, K sqrt(rate)",
        "m/s^2, density times sqrt(2 rate)",
        "m/s^3, random walk times sqrt(rate)",
    ],
    topic: "imu_topic",
    factors: |rate_hz| [(2.0 * rate_hz).sqrt(), rate_hz.sqrt()],
    note: "discrete-time, as VINS-Fusion's integration takes them at this rate",
};

const LIO_SAM: Names = Names {
    indent: "  ",
    keys: ["imuGyrNoise", "imuGyrBiasN", "imuAccNoise", "imuAccBiasN"],
    units: [
        "rad/s/sqrt(Hz)",
        "rad/s^2/sqrt(Hz)",
        "m/s^2/sqrt(Hz)",
        "m/s^3/sqrt(Hz)",
    ],
    topic: "imuTopic",
    factors: |_| [1.0, 1.0],
    note: "continuous-time",
};

/// The lines for VINS-Fusion, in the YAML dialect of OpenCV.
pub(super) fn vins_fusion(known: &Characterisation, arguments: &Arguments) -> String {
    format!(
        "%YAML:1.0\n\n{}",
        configuration(known, arguments, &VINS_FUSION)
    )
}

/// The lines for LIO-SAM.
pub(super) fn lio_sam(known: &Characterisation, arguments: &Arguments) -> String {
    format!("lio_sam:\n{}", configuration(known, arguments, &LIO_SAM))
}

fn configuration(known: &Characterisation, arguments: &Arguments, names: &Names) -> String {
    let Names {
        indent,
        keys: [noise, walk, of_accelerometer @ ..],
        units,
        topic,
        factors,
        note,
    } = names;
    let factors = factors(known.rate_hz);
    let mut text = String::new();
    // A JSON string is also a YAML string.
    let named = serde_json::Value::from(arguments.rostopic.as_str());
    let _ = writeln!(text, "{indent}{topic}: {named}");
    let (live, beside) = known.chosen(arguments.overbound);
    for (Choice { name, pair }, mark) in [(live, ""), (beside, "# ")] {
        let _ = writeln!(
            text,
            "{indent}# {name}, {note} ({} Hz):",
            decimal(known.rate_hz)
        );
        let both = [(noise, pair.noise_density), (walk, pair.random_walk)];
        for (at, (key, given)) in both.into_iter().enumerate() {
            let given = given.times(factors[at]);
            let start = format!("{indent}{mark}{key}");
            line(&mut text, &start, &given, units[at]);
        }
    }
    let accelerometer = [
        (
            arguments.accelerometer_noise_density,
            "--accelerometer-noise-density",
        ),
        (
            arguments.accelerometer_random_walk,
            "--accelerometer-random-walk",
        ),
    ];
    for (at, (value, option)) in accelerometer.into_iter().enumerate() {
        let missing = || Given::Missing {
            why: format!("not part of a gyro record: fill it in, or give it with {option}"),
        };
        let given = value.map_or_else(missing, Given::plain).times(factors[at]);
        let start = format!("{indent}{}", of_accelerometer[at]);
        line(&mut text, &start, &given, units[at + 2]);
    }
    text + &summary::below(known, "#")
}

/// Writes `key: value  # unit; remark`, or a comment with the reason why there is no value.
fn line(text: &mut String, start: &str, given: &Given, unit: &str) {
    let words = given.words();
    let remark = match words {
        "" => String::new(),
        words => format!("; {words}"),
    };
    let _ = match given.value() {
        Some(value) => writeln!(text, "{start}: {}  # {unit}{remark}", decimal(value)),
        None => writeln!(text, "# {}:  # {unit}{remark}", start.trim_start()),
    };
}
