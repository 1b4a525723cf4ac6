//! The units of logs.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The sensor that a log was recorded with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Sensor {
    /// A gyro, which measures angular rates.
    Gyro,
    /// An accelerometer, which measures specific forces.
    #[value(name = "accel", alias = "accelerometer")]
    Accelerometer,
}

/// The unit of a gyro's rate, or of an accelerometer's acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
pub enum Unit {
    /// Degrees per second.
    #[serde(rename = "deg/s")]
    #[value(name = "deg/s")]
    DegreesPerSecond,
    /// Radians per second.
    #[serde(rename = "rad/s")]
    #[value(name = "rad/s")]
    RadiansPerSecond,
    /// Metres per second squared.
    #[serde(rename = "m/s^2")]
    #[value(name = "m/s^2")]
    MetresPerSecondSquared,
    /// Standard gravity, 9.80665 m/s².
    #[serde(rename = "g")]
    #[value(name = "g")]
    StandardGravity,
}

impl Unit {
    const ALL: [Self; 4] = [
        Self::DegreesPerSecond,
        Self::RadiansPerSecond,
        Self::MetresPerSecondSquared,
        Self::StandardGravity,
    ];

    /// The unit as written in files and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DegreesPerSecond => "deg/s",
            Self::RadiansPerSecond => "rad/s",
            Self::MetresPerSecondSquared => "m/s^2",
            Self::StandardGravity => "g",
        }
    }

    /// The sensor that has this unit.
    pub const fn sensor(self) -> Sensor {
        match self {
            Self::DegreesPerSecond | Self::RadiansPerSecond => Sensor::Gyro,
            Self::MetresPerSecondSquared | Self::StandardGravity => Sensor::Accelerometer,
        }
    }

    /// The unit that is assumed for a sensor's log without a unit.
    pub const fn usual(sensor: Sensor) -> Self {
        match sensor {
            Sensor::Gyro => Self::DegreesPerSecond,
            Sensor::Accelerometer => Self::MetresPerSecondSquared,
        }
    }

    /// The factor from this unit to the usual unit of its sensor, deg/s or m/s².
    pub const fn in_usual(self) -> f64 {
        match self {
            Self::DegreesPerSecond | Self::MetresPerSecondSquared => 1.0,
            Self::RadiansPerSecond => 180.0 / std::f64::consts::PI,
            Self::StandardGravity => 9.80665,
        }
    }

    /// The factor from this unit to the SI unit, rad/s or m/s².
    pub const fn in_si(self) -> f64 {
        match self {
            Self::DegreesPerSecond => std::f64::consts::PI / 180.0,
            Self::RadiansPerSecond | Self::MetresPerSecondSquared => 1.0,
            Self::StandardGravity => self.in_usual(),
        }
    }

    /// The unit with this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.name() == name)
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MetresPerSecondSquared => "m/s²",
            _ => self.name(),
        })
    }
}

impl Sensor {
    /// The sensor as the option spells it.
    pub const fn option(self) -> &'static str {
        match self {
            Self::Gyro => "gyro",
            Self::Accelerometer => "accel",
        }
    }
}

impl fmt::Display for Sensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gyro => "gyro",
            Self::Accelerometer => "accelerometer",
        })
    }
}

impl From<allanite::storage::RateUnit> for Unit {
    fn from(unit: allanite::storage::RateUnit) -> Self {
        match unit {
            allanite::storage::RateUnit::DegreesPerSecond => Self::DegreesPerSecond,
            allanite::storage::RateUnit::RadiansPerSecond => Self::RadiansPerSecond,
        }
    }
}
