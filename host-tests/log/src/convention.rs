//! Units that the names of columns do not tell, but that the program that wrote them always uses.

use super::names;
use crate::unit::{Sensor, Unit};

/// A unit, and the program whose convention it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Convention {
    pub(super) unit: Unit,
    pub(super) program: &'static str,
}

/// The sensor of which a file of `x`, `y` and `z` is, if its name or the lines above its rows say so.
pub(super) fn sensor_said(said: &str) -> Option<Sensor> {
    let is = |sensor: Sensor| match sensor {
        Sensor::Gyro => said.contains("gyro"),
        Sensor::Accelerometer => said.contains("accel"),
    };
    match [Sensor::Gyro, Sensor::Accelerometer].map(is) {
        [true, false] => Some(Sensor::Gyro),
        [false, true] => Some(Sensor::Accelerometer),
        _ => None,
    }
}

/// Whether a column has the name of an axis alone: `x`, `Y`, `z (rad/s)`.
pub(super) fn is_bare_axis(name: &str) -> bool {
    matches!(&*names::bare(name).to_lowercase(), "x" | "y" | "z")
}

/// The convention that the column of this name follows. `said` is the file's name and what stands above the rows, in
/// lower case.
///
/// * ArduPilot logs `GyrX` in rad/s and `AccX` in m/s² (its list of log messages, `IMU`).
/// * Messages of ROS have rad/s and m/s² (REP 103).
/// * Betaflight logs `gyroADC` in deg/s.
/// * Kalibr extracts `omega_x` in rad/s and `alpha_x` in m/s².
/// * PX4's `sensor_gyro` and `sensor_accel`, of which `ulog2csv` writes a file each, have rad/s and m/s².
/// * VectorNav's rates are in rad/s and its accelerations in m/s² (its interface control document).
/// * Xsens' MT Manager exports `Gyr_X` in rad/s and `Acc_X` in m/s²; Xsens DOT exports `Gyr_X` in deg/s.
/// * Phones measure in rad/s and m/s² (Android's `SensorEvent`).
pub(super) fn of(name: &str, said: &str) -> Option<Convention> {
    let bare = names::bare(name);
    let lower = bare.to_lowercase();
    let (rad, deg, metres) = (
        Unit::RadiansPerSecond,
        Unit::DegreesPerSecond,
        Unit::MetresPerSecondSquared,
    );
    let of_sensor = |sensor: Sensor| match sensor {
        Sensor::Gyro => rad,
        Sensor::Accelerometer => metres,
    };
    let starts = |starts: &[&str]| starts.iter().any(|start| lower.starts_with(start));
    let (unit, program) = if matches!(bare, "GyrX" | "GyrY" | "GyrZ") {
        (rad, "ArduPilot")
    } else if matches!(bare, "AccX" | "AccY" | "AccZ") {
        (metres, "ArduPilot")
    } else if matches!(&*lower, "omega_x" | "omega_y" | "omega_z") {
        (rad, "Kalibr")
    } else if matches!(&*lower, "alpha_x" | "alpha_y" | "alpha_z") {
        (metres, "Kalibr")
    } else if lower.contains("angular_velocity") {
        (rad, "ROS")
    } else if lower.contains("linear_acceleration") {
        (metres, "ROS")
    } else if starts(&["gyroadc["]) {
        (deg, "Betaflight")
    } else if starts(&["gyr_x", "gyr_y", "gyr_z"])
        && (said.contains("xsens dot") || said.contains("movella dot"))
    {
        (deg, "Xsens DOT")
    } else if starts(&["gyr_x", "gyr_y", "gyr_z"]) && is_xsens(said) {
        (rad, "Xsens")
    } else if starts(&["acc_x", "acc_y", "acc_z"]) && said.contains("mt manager") {
        (metres, "Xsens")
    } else if starts(&["uncompgyro", "angularrate"])
        || (starts(&["gyro"]) && said.contains("vectornav"))
    {
        (rad, "VectorNav")
    } else if starts(&["uncompaccel"]) || (starts(&["accel"]) && said.contains("vectornav")) {
        (metres, "VectorNav")
    } else if is_bare_axis(name) {
        let program = if said.contains("sensor_") {
            "PX4"
        } else {
            "phones"
        };
        (of_sensor(sensor_said(said)?), program)
    } else {
        return None;
    };
    Some(Convention { unit, program })
}

/// Whether a text was written by one of Xsens' programs.
fn is_xsens(said: &str) -> bool {
    ["mt manager", "xsens", "mtb", "mti"]
        .iter()
        .any(|program| said.contains(program))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conventions_are_known_by_names_and_by_what_is_said() {
        let (rad, deg, metres) = (
            Unit::RadiansPerSecond,
            Unit::DegreesPerSecond,
            Unit::MetresPerSecondSquared,
        );
        for (name, said, expected) in [
            ("GyrX", "", Some((rad, "ArduPilot"))),
            ("AccZ", "", Some((metres, "ArduPilot"))),
            ("gyrx", "", None),
            ("angular_velocity.x", "", Some((rad, "ROS"))),
            ("gyroADC[0]", "", Some((deg, "Betaflight"))),
            ("Gyr_X", "// mt manager version", Some((rad, "Xsens"))),
            ("Gyr_X", "devicetag:,xsens dot", Some((deg, "Xsens DOT"))),
            ("gyr_x", "", None),
            ("UncompGyroX", "", Some((rad, "VectorNav"))),
            ("gyro_x", "vectornav", Some((rad, "VectorNav"))),
            ("gyro_x", "", None),
            ("x", "gyroscope.csv", Some((rad, "phones"))),
            ("x", "accelerometer.csv", Some((metres, "phones"))),
            ("omega_y", "", Some((rad, "Kalibr"))),
            ("x", "log_sensor_gyro_0.csv", Some((rad, "PX4"))),
            ("x", "log.csv", None),
            ("x", "accelerometer and gyroscope", None),
        ] {
            let found = of(name, said).map(|found| (found.unit, found.program));
            assert_eq!(found, expected, "{name} {said}");
        }
    }
}
