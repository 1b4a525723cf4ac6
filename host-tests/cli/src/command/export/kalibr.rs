//! YAML of camera-IMU calibration: Kalibr's imu.yaml and the chain file of OpenVINS.
//!
//! Both take continuous-time densities in SI units, one number for all axes: the white noise of the
//! rate in rad/s/√Hz and the white noise that drives its bias in rad/s²/√Hz, which is the rate random
//! walk coefficient K (Kalibr's wiki, "IMU Noise Model"). Both stop if a density is missing, and Kalibr
//! also if it is not above zero. A density that a record does not give is left out, and a comment gives the reason.

use super::{
    arguments::Arguments,
    characterisation::{Characterisation, Choice},
    decimal::decimal,
    given::Given,
    summary,
};
use std::fmt::Write;

/// Kalibr's imu.yaml.
pub(super) fn kalibr(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = String::new();
    body(&mut text, "", "Kalibr then stops", known, arguments);
    text + &summary::below(known, "#")
}

/// OpenVINS' kalibr_imu_chain.yaml, which has the same entries under `imu0`, in the YAML dialect of
/// OpenCV.
pub(super) fn openvins(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = "%YAML:1.0\n\nimu0:\n".to_owned();
    matrix(&mut text, "T_i_b", 4, "1.0");
    body(&mut text, "  ", "OpenVINS then stops", known, arguments);
    text += "  time_offset: 0.0\n  model: \"kalibr\"\n";
    // OpenVINS requires the intrinsics. A noise record says nothing about them, so they are neutral.
    for name in ["Tw", "R_IMUtoGYRO", "Ta", "R_IMUtoACC"] {
        matrix(&mut text, name, 3, "1.0");
    }
    matrix(&mut text, "Tg", 3, "0.0");
    text + &summary::below(known, "#")
}

/// Writes a square matrix with one number on the diagonal and zeros elsewhere.
fn matrix(text: &mut String, name: &str, size: usize, diagonal: &str) {
    let _ = writeln!(text, "  {name}:");
    for row in 0..size {
        let entry = |column| if row == column { diagonal } else { "0.0" };
        let row: Vec<&str> = (0..size).map(entry).collect();
        let _ = writeln!(text, "    - [{}]", row.join(", "));
    }
}

fn body(
    text: &mut String,
    indent: &str,
    without: &str,
    known: &Characterisation,
    arguments: &Arguments,
) {
    let (live, beside) = known.chosen(arguments.overbound);
    for (choice, mark) in [(live, ""), (beside, "# ")] {
        let Choice { name, pair } = choice;
        let _ = writeln!(text, "{indent}# {name}, continuous-time:");
        let both = [
            (
                "gyroscope_noise_density",
                &pair.noise_density,
                "rad/s/sqrt(Hz)",
            ),
            (
                "gyroscope_random_walk",
                &pair.random_walk,
                "rad/s^2/sqrt(Hz)",
            ),
        ];
        for (key, given, unit) in both {
            let given = given.clone().without(without);
            line(text, indent, mark, key, &given, unit);
        }
        if let Some(density) = pair.noise_density.value() {
            let sigma = number_at(density, known.rate_hz);
            let _ = writeln!(
                text,
                "{indent}# discrete-time: {sigma} rad/s is the standard deviation of a sample at update_rate"
            );
        }
    }
    let pair = &known.accelerometer.pair;
    let accelerometer = [
        (
            "accelerometer_noise_density",
            &pair.noise_density,
            "m/s^2/sqrt(Hz)",
        ),
        (
            "accelerometer_random_walk",
            &pair.random_walk,
            "m/s^3/sqrt(Hz)",
        ),
    ];
    for (key, given, unit) in accelerometer {
        let given = given.clone().without(without);
        line(text, indent, "", key, &given, unit);
    }
    // A JSON string is also a YAML string.
    let topic = serde_json::Value::from(arguments.rostopic.as_str());
    let _ = writeln!(text, "{indent}rostopic: {topic}");
    let _ = writeln!(
        text,
        "{indent}update_rate: {}  # Hz",
        decimal(known.rate_hz)
    );
}

fn number_at(density: f64, rate_hz: f64) -> String {
    decimal(density * rate_hz.sqrt())
}

/// Writes `key: value  # unit; remark`, or a comment with the reason why there is no value.
fn line(text: &mut String, indent: &str, mark: &str, key: &str, given: &Given, unit: &str) {
    let words = given.words();
    let _ = match given.value() {
        Some(value) => {
            let remark = if words.is_empty() {
                String::new()
            } else {
                format!("; {words}")
            };
            writeln!(
                text,
                "{indent}{mark}{key}: {}  # {unit}{remark}",
                decimal(value)
            )
        }
        None => writeln!(text, "{indent}# {key}:  # {unit}; {words}"),
    };
}
