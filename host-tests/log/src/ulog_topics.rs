//! The columns of PX4's topics: which of their fields are axes, and in which unit.

use super::ulog_format::{Field, Value};
use crate::unit::Sensor;

/// The topics of raw samples, which are taken without being asked for.
pub(super) const RAW: [&str; 4] = [
    "sensor_gyro",
    "sensor_accel",
    "sensor_combined",
    "vehicle_imu",
];

/// Where the values of a column come from.
#[derive(Clone, Debug)]
pub(super) struct Source {
    field: Field,
    /// The field with the integration time in microseconds, by which the values are divided.
    over: Option<Field>,
}

impl Source {
    /// The value in a message, or `None` if the message is too short.
    pub(super) fn value(&self, message: &[u8]) -> Option<Value> {
        let value = self.field.value(message)?;
        let Some(over) = &self.over else {
            return Some(value);
        };
        let seconds = 1e-6 * over.value(message)?.to_f64();
        Some(Value::Float(value.to_f64() / seconds))
    }
}

/// The columns of a topic. They get names that indicate sensor and unit where those of PX4's fields
/// do not.
pub(super) fn columns(topic: &str, fields: &[Field]) -> Vec<(String, Source)> {
    const GYRO: [&str; 3] = ["gyro_x [rad/s]", "gyro_y [rad/s]", "gyro_z [rad/s]"];
    const ACCEL: [&str; 3] = ["accel_x [m/s^2]", "accel_y [m/s^2]", "accel_z [m/s^2]"];
    const XYZ: [&str; 3] = ["x", "y", "z"];
    const ARRAY: [&str; 3] = ["xyz[0]", "xyz[1]", "xyz[2]"];
    const ANGLE: [&str; 3] = ["delta_angle[0]", "delta_angle[1]", "delta_angle[2]"];
    const RAD: [&str; 3] = ["gyro_rad[0]", "gyro_rad[1]", "gyro_rad[2]"];
    const M_S2: [&str; 3] = [
        "accelerometer_m_s2[0]",
        "accelerometer_m_s2[1]",
        "accelerometer_m_s2[2]",
    ];
    const VELOCITY: [&str; 3] = [
        "delta_velocity[0]",
        "delta_velocity[1]",
        "delta_velocity[2]",
    ];
    let known: &[([&str; 3], [&str; 3], Option<&str>)] = match topic {
        "sensor_gyro" => &[(XYZ, GYRO, None)],
        "sensor_accel" => &[(XYZ, ACCEL, None)],
        "sensor_combined" => &[(RAD, RAD, None), (M_S2, M_S2, None)],
        "vehicle_angular_velocity" => &[(ARRAY, GYRO, None)],
        "vehicle_acceleration" => &[(ARRAY, ACCEL, None)],
        "vehicle_imu" => &[
            (ANGLE, GYRO, Some("delta_angle_dt")),
            (VELOCITY, ACCEL, Some("delta_velocity_dt")),
        ],
        _ => &[],
    };
    let find = |name: &str| fields.iter().find(|field| field.name == name).cloned();
    let named = |field: &Field| {
        let name = field.name.as_str();
        for (from, to, over) in known {
            if let Some(axis) = from.iter().position(|one| *one == name) {
                return (to[axis].to_owned(), over.and_then(find));
            }
        }
        match name {
            "timestamp" | "timestamp_sample" => (format!("{name} [us]"), None),
            name => (name.to_owned(), None),
        }
    };
    let column = |field: &Field| {
        let (name, over) = named(field);
        let field = field.clone();
        (name, Source { field, over })
    };
    fields.iter().map(column).collect()
}

/// The columns that are axes in the definition of a topic of PX4. A topic has other fields with similar names, such as
/// `gyro_calibration_count`.
pub(super) fn defined(topic: &str, names: &[String]) -> Vec<(usize, Sensor)> {
    const TOPICS: [&str; 6] = [
        "sensor_gyro",
        "sensor_accel",
        "sensor_combined",
        "vehicle_imu",
        "vehicle_angular_velocity",
        "vehicle_acceleration",
    ];
    if !TOPICS.contains(&topic) {
        return Vec::new();
    }
    let sensor = |(column, name): (usize, &String)| {
        let is = |array: &str, unit: &str| name.starts_with(array) || name.ends_with(unit);
        if is("gyro_rad[", "[rad/s]") {
            Some((column, Sensor::Gyro))
        } else if is("accelerometer_m_s2[", "[m/s^2]") {
            Some((column, Sensor::Accelerometer))
        } else {
            None
        }
    };
    names.iter().enumerate().filter_map(sensor).collect()
}
