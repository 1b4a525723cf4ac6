//! Recognises the axes of a sensor by the names of columns: by words, by the usual short forms, and by units.
//!
//! No list has every name. What counts is a word for the quantity or a unit of it, and a letter of an axis.

use super::{
    names::{self, bare, is_angle, tokens},
    unit_names,
};
use crate::unit::Sensor;

/// Words for a rate of rotation, with an underscore between words.
const ROTATION: [&str; 18] = [
    "gyr",
    "pqr",
    "angular_vel",
    "angularvel",
    "angular_rate",
    "angularrate",
    "angular_speed",
    "angularspeed",
    "ang_vel",
    "angvel",
    "ang_rate",
    "turn_rate",
    "turnrate",
    "rotation_rate",
    "rotationrate",
    "body_rate",
    "omega",
    "w_rs_s_",
];

/// Words for an acceleration.
const ACCELERATION: [&str; 3] = ["acc", "specific_force", "a_rs_s_"];

/// Parts of names of what is neither: other quantities, what is computed from the axes, and halves of a number.
const OTHERS: [&str; 16] = [
    "magnet",
    "temp",
    "time",
    "cov",
    "bias",
    "clip",
    "accura",
    "calib",
    "device",
    "count",
    "error",
    "integral",
    "norm",
    "magnitude",
    "variance",
    "status",
];
const OTHER_TOKENS: [&str; 20] = [
    "magx", "magy", "magz", "dt", "id", "mag", "magn", "total", "abs", "rms", "mean", "std", "var",
    "h", "l", "hi", "lo", "high", "low", "msb",
];

/// Whether a column is named like an axis of this sensor: `gx`, `gyro_y`, `imu.angular_velocity.z`, `Angular Velocity
/// X`, `w_RS_S_x [rad s^-1]`, `AsX(°/s)`, `xRate (deg/s)`, `rot0`, or `ax`, `accel_y`, `linear_acceleration.z`,
/// `x-axis (g)`, and the like.
pub(super) fn is_axis(name: &str, sensor: Sensor) -> bool {
    sensor_of(name) == Some(sensor)
}

/// The sensor of which a column is an axis by its name.
fn sensor_of(name: &str) -> Option<Sensor> {
    let lower = bare(name).to_lowercase();
    let words: Vec<&str> = tokens(&lower).collect();
    let is_other = OTHERS.iter().any(|other| lower.contains(other))
        || words.iter().any(|word| OTHER_TOKENS.contains(word));
    if is_other || is_angle(&lower) && !has_unit_of_rate(name) {
        return None;
    }
    let joined = words.join("_");
    let says = |words: &[&str]| words.iter().any(|word| joined.contains(word));
    let is_rotation = says(&ROTATION) || is_short(&words, &["g", "w"]) || is_rotated(&words);
    let is_acceleration = says(&ACCELERATION) || is_short(&words, &["a"]);
    match (is_rotation, is_acceleration) {
        (true, false) => Some(Sensor::Gyro),
        (false, true) => Some(Sensor::Accelerometer),
        (true, true) => None,
        (false, false) => {
            let (unit, _) = unit_names::unit(name).ok()??;
            has_axis(&words).then_some(unit.sensor())
        }
    }
}

/// Whether three names differ in the letter or number of their axis alone, so that they are the axes of something: `foo_x`,
/// `foo_y` and `foo_z`, or `foo[0]`, `foo[1]` and `foo[2]`.
pub(super) fn are_triple(names: [&str; 3]) -> bool {
    let lower = names.map(|name| bare(name).to_lowercase());
    let [x, y, z] = lower.each_ref().map(|name| name.as_bytes());
    let differ: Vec<usize> = (0..x.len()).filter(|&i| y.get(i) != Some(&x[i])).collect();
    let is_last = x.len() == y.len() && y.len() == z.len();
    is_last
        && matches!(differ.as_slice(), &[at] if [b"xyz", b"012", b"123"].contains(&&[x[at], y[at], z[at]])
            && x[..at] == z[..at] && x[at + 1..] == z[at + 1..])
}

/// Whether a name tells a unit of a rate. The unit `rad` of a name such as `roll_rad` is that of an angle.
fn has_unit_of_rate(name: &str) -> bool {
    let lower = name.trim().to_lowercase();
    let is_of_angle =
        lower.ends_with("rad") || names::in_brackets(&lower).is_some_and(|(_, unit)| unit == "rad");
    !is_of_angle
        && matches!(unit_names::unit(name), Ok(Some((unit, _))) if unit.sensor() == Sensor::Gyro)
}

/// Whether the words begin or end with the letter of a quantity and that of an axis: `gx`, `gx_raw131`, `imu_gx`,
/// `w_x`, `imu0.wz`.
fn is_short(words: &[&str], letters: &[&str]) -> bool {
    let is_pair = |word: &str| {
        letters.iter().any(|letter| {
            let rest = word.strip_prefix(letter);
            rest.is_some_and(|rest| matches!(rest, "x" | "y" | "z"))
        })
    };
    let is_spread = |pair: &[&str]| letters.contains(&pair[0]) && is_letter(pair[1]);
    words.iter().any(|word| is_pair(word)) || words.windows(2).any(is_spread)
}

/// Whether the words are `rot0`, `rot_x`, `rate_y` or `zrate`.
fn is_rotated(words: &[&str]) -> bool {
    let is_name = |word: &str| matches!(word, "rot" | "rate");
    let has_end = |word: &&str| {
        let rest = word.strip_prefix("rot").or(word.strip_prefix("rate"));
        rest.is_some_and(|rest| is_letter(rest) || is_index(rest))
            || word.strip_suffix("rate").is_some_and(is_letter)
    };
    let is_pair = |pair: &[&str]| is_name(pair[0]) && (is_letter(pair[1]) || is_index(pair[1]));
    words.iter().any(has_end) || words.windows(2).any(is_pair)
}

/// Whether the words name an axis: `x`, `x-axis`, `AsX`, `xRate`, `roll rate`.
fn has_axis(words: &[&str]) -> bool {
    let at_an_end =
        |word: &&str| word.starts_with(['x', 'y', 'z']) || word.ends_with(['x', 'y', 'z']);
    let is_turn = |word: &&str| matches!(*word, "roll" | "pitch" | "yaw");
    words
        .iter()
        .any(|word| is_letter(word) || at_an_end(word) || is_turn(word))
}

fn is_letter(word: &str) -> bool {
    matches!(word, "x" | "y" | "z")
}

fn is_index(word: &str) -> bool {
    matches!(word, "0" | "1" | "2" | "3")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_names_of_axes_are_known() {
        let gyro = [
            "gx",
            "GyroX",
            "gyro_y [deg/s]",
            "gyrADC[0]",
            "angular_velocity.z",
            "w_RS_S_x [rad s^-1]",
            "wx",
            "gx_raw131",
            "Angular Velocity X",
            "w_x",
            "angular_vel_x",
            "turn_rate_x",
            "rot0",
            "AsX(°/s)",
            "xRate (deg/s)",
            "imu_gx",
            "imu0.gyro.z",
            "x-axis (deg/s)",
            "rate_y",
            "roll [deg/s]",
        ];
        let accelerometer = [
            "ax",
            "a_x",
            "acc_x",
            "AccZ",
            "accel_y (m/s^2)",
            "linear_acceleration.z",
            "Linear Acceleration X",
            "a_RS_S_x [m s^-2]",
            "accelerometer_m_s2[0]",
            "imu_az",
            "xAccel (g)",
            "x-axis (g)",
        ];
        let neither = [
            "t",
            "gyro_temp",
            "gxyz",
            "angular_velocity_covariance_0",
            "weight",
            "axis",
            "azimuth",
            "gyro_integral_dt",
            "accelerometer_timestamp_relative",
            "gyro_calibration_count",
            "gyro_device_id",
            "roll_deg",
            "roll_rad",
            "angle_x [rad]",
            "angular_velocity_covariance",
            "gyr_norm",
            "gyro_x_msb",
            "gx_high",
            "mag_x",
            "MagX_mG",
            "magnetometer_x_mG",
            "AngleX(°)",
            "heart_rate",
            "rate",
            "Temperature(°C)",
            "x",
        ];
        for (names, expected) in [
            (&gyro[..], [true, false]),
            (&accelerometer, [false, true]),
            (&neither, [false, false]),
        ] {
            for name in names {
                let is = [Sensor::Gyro, Sensor::Accelerometer].map(|one| is_axis(name, one));
                assert_eq!(is, expected, "{name}");
            }
        }
    }
}
