//! The units of coefficients: those that follow from the log's unit, and those customary in data sheets.

use allanite_log::unit::{Sensor, Unit};

const SECONDS_PER_HOUR: f64 = 3600.0;

/// The unit of a coefficient, which is the rate unit · s^(half_seconds/2), in its usual spelling.
pub fn unit(unit: Unit, half_seconds: i8) -> String {
    // The unit times a second, and the unit divided by a second.
    let (integral, derivative) = match unit {
        Unit::DegreesPerSecond => ("deg", "deg/s²"),
        Unit::RadiansPerSecond => ("rad", "rad/s²"),
        Unit::MetresPerSecondSquared => ("m/s", "m/s³"),
        Unit::StandardGravity => ("g·s", "g/s"),
    };
    match half_seconds {
        2 => integral.into(),
        1 => format!("{unit}/√Hz"),
        0 => unit.to_string(),
        -1 => format!("{unit}/√s"),
        -2 => derivative.into(),
        other => format!("{unit}·s^({other}/2)"),
    }
}

/// The factor from the log's unit to a coefficient's customary unit, and the name of that unit. A gyro
/// has arc seconds for an angle, and otherwise degrees and hours. An accelerometer has metres per second
/// for a velocity, and otherwise thousandths and millionths of g. `None` if the power of time has no
/// customary unit.
pub fn customary(unit: Unit, half_seconds: i8) -> Option<(f64, &'static str)> {
    let in_g = Unit::StandardGravity.in_usual().recip();
    let (factor, name) = match (unit.sensor(), half_seconds) {
        (Sensor::Gyro, 2) => (SECONDS_PER_HOUR, "arcsec"),
        (Sensor::Gyro, 1) => (SECONDS_PER_HOUR.sqrt(), "°/√h"),
        (Sensor::Gyro, 0) => (SECONDS_PER_HOUR, "°/h"),
        (Sensor::Gyro, -1) => (SECONDS_PER_HOUR.powf(1.5), "°/h^1.5"),
        (Sensor::Gyro, -2) => (SECONDS_PER_HOUR.powi(2), "°/h²"),
        (Sensor::Accelerometer, 2) => (1.0, "m/s"),
        (Sensor::Accelerometer, 1) => (1e6 * in_g, "µg/√Hz"),
        (Sensor::Accelerometer, 0) => (1e3 * in_g, "mg"),
        (Sensor::Accelerometer, -1) => (1e3 * in_g * SECONDS_PER_HOUR.sqrt(), "mg/√h"),
        (Sensor::Accelerometer, -2) => (1e3 * in_g * SECONDS_PER_HOUR, "mg/h"),
        _ => return None,
    };
    Some((factor * unit.in_usual(), name))
}

/// The factor from the log's unit per √Hz to the customary unit of the root of a density, and the name of that unit. A
/// gyro has `°/h/√Hz` and not the `°/√h` of angle random walk, because the density of white noise is one-sided: its root
/// is √2 times the coefficient.
pub fn customary_density(unit: Unit) -> Option<(f64, &'static str)> {
    match unit.sensor() {
        Sensor::Gyro => Some((SECONDS_PER_HOUR * unit.in_usual(), "°/h/√Hz")),
        Sensor::Accelerometer => customary(unit, 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_deg_per_s_have_their_usual_units() {
        let units = [2, 1, 0, -1, -2].map(|half| unit(Unit::DegreesPerSecond, half));
        assert_eq!(units, ["deg", "deg/s/√Hz", "deg/s", "deg/s/√s", "deg/s²"]);
    }

    #[test]
    fn customary_units_follow_from_hours_and_degrees() {
        let factors =
            [2, 1, 0, -1, -2].map(|half| customary(Unit::DegreesPerSecond, half).unwrap());
        let expected = [
            (3600.0, "arcsec"),
            (60.0, "°/√h"),
            (3600.0, "°/h"),
            (216_000.0, "°/h^1.5"),
            (12_960_000.0, "°/h²"),
        ];
        for ((factor, name), (expected, expected_name)) in factors.into_iter().zip(expected) {
            assert!((factor / expected - 1.0).abs() < 1e-12 && name == expected_name);
        }
        let density = customary_density(Unit::DegreesPerSecond);
        assert_eq!(density, Some((3600.0, "°/h/√Hz")));
        let (factor, _) = customary(Unit::RadiansPerSecond, 0).unwrap();
        assert!((factor - 206_264.806_247_096_36).abs() < 1e-6);
    }

    #[test]
    fn accelerometers_have_units_of_their_own() {
        let units = [2, 1, 0, -1, -2].map(|half| unit(Unit::MetresPerSecondSquared, half));
        assert_eq!(units, ["m/s", "m/s²/√Hz", "m/s²", "m/s²/√s", "m/s³"]);
        // 100 µg/√Hz are 980.665 µm/s²/√Hz.
        for (unit, value) in [
            (Unit::MetresPerSecondSquared, 980.665e-6),
            (Unit::StandardGravity, 100e-6),
        ] {
            let (factor, name) = customary(unit, 1).unwrap();
            assert!((factor * value / 100.0 - 1.0).abs() < 1e-12 && name == "µg/√Hz");
        }
        // 1 mg an hour.
        let (factor, name) = customary(Unit::StandardGravity, -2).unwrap();
        assert!((factor * 1e-3 / 3600.0 - 1.0).abs() < 1e-12 && name == "mg/h");
    }
}
