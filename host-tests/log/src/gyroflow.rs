//! The scales in the header of a `.gcsv`, the log of motion that Gyroflow reads.

use crate::unit::{Sensor, Unit};

/// The lines above the rows of such a log, in lower case.
pub(super) struct Header<'a>(&'a str);

impl<'a> Header<'a> {
    /// The header of a log of which this stands above the rows, if it is such a log.
    pub(super) fn of(said: &'a str) -> Option<Self> {
        said.contains("gyroflow imu log").then_some(Self(said))
    }

    /// The positive number behind a key.
    fn number(&self, wanted: &str) -> Option<f64> {
        let mut pairs = self.0.lines().filter_map(|line| line.split_once(','));
        let (_, value) = pairs.find(|(key, _)| key.trim() == wanted)?;
        let value = value.trim().trim_end_matches(',').parse::<f64>().ok()?;
        (1e-12..=1e12).contains(&value).then_some(value)
    }

    /// The seconds in a step of the time.
    pub(super) fn time_step_s(&self) -> Option<f64> {
        self.number("tscale")
    }

    /// The unit of a sensor, and the size of a count in it.
    pub(super) fn scale(&self, sensor: Sensor) -> Option<(Unit, f64)> {
        let (unit, key) = match sensor {
            Sensor::Gyro => (Unit::RadiansPerSecond, "gscale"),
            Sensor::Accelerometer => (Unit::StandardGravity, "ascale"),
        };
        Some((unit, self.number(key)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_those_of_the_header() {
        let said = "log.gcsv\ngyroflow imu log\nversion,1.3\norientation,yxz\ntscale,0.001\ngscale,0.00122,\n";
        let header = Header::of(said).unwrap();
        assert_eq!(header.time_step_s(), Some(0.001));
        let gyro = header.scale(Sensor::Gyro);
        assert_eq!(gyro, Some((Unit::RadiansPerSecond, 0.00122)));
        assert_eq!(header.scale(Sensor::Accelerometer), None);
        assert!(Header::of("log.csv\ntscale,0.001\n").is_none());
    }
}
