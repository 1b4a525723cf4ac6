//! The units of coefficients: those of the log, and those that data sheets are written in.

use crate::unit::Unit;

const SECONDS_PER_HOUR: f64 = 3600.0;

/// The unit of a coefficient, rate unit · s^(half_seconds/2), as it is usually written.
pub(super) fn unit(unit: Unit, half_seconds: i8) -> String {
    let angle = unit.angle();
    match half_seconds {
        2 => angle.into(),
        1 => format!("{angle}/s/√Hz"),
        0 => format!("{angle}/s"),
        -1 => format!("{angle}/s/√s"),
        -2 => format!("{angle}/s²"),
        other => format!("{angle}/s·s^({other}/2)"),
    }
}

/// The factor to a coefficient's customary unit, and that unit: arc seconds for an angle, else
/// degrees and hours. `None` for a power of time that has no custom.
pub(super) fn customary(unit: Unit, half_seconds: i8) -> Option<(f64, &'static str)> {
    let (factor, name) = match half_seconds {
        2 => (SECONDS_PER_HOUR, "arcsec"),
        1 => (SECONDS_PER_HOUR.sqrt(), "°/√h"),
        0 => (SECONDS_PER_HOUR, "°/h"),
        -1 => (SECONDS_PER_HOUR.powf(1.5), "°/h^1.5"),
        -2 => (SECONDS_PER_HOUR.powi(2), "°/h²"),
        _ => return None,
    };
    Some((factor * unit.degrees(), name))
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
        let (factor, _) = customary(Unit::RadiansPerSecond, 0).unwrap();
        assert!((factor - 206_264.806_247_096_36).abs() < 1e-6);
    }
}
