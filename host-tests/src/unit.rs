//! The two units that logs are kept in.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The unit of a gyro's rate.
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
}

impl Unit {
    /// The unit as written in files and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DegreesPerSecond => "deg/s",
            Self::RadiansPerSecond => "rad/s",
        }
    }

    /// The unit of the angle: that of the rate times a second.
    pub const fn angle(self) -> &'static str {
        match self {
            Self::DegreesPerSecond => "deg",
            Self::RadiansPerSecond => "rad",
        }
    }

    /// Degrees in one unit of the angle.
    pub const fn degrees(self) -> f64 {
        match self {
            Self::DegreesPerSecond => 1.0,
            Self::RadiansPerSecond => 180.0 / std::f64::consts::PI,
        }
    }

    /// Radians in one unit of the angle.
    pub const fn radians(self) -> f64 {
        match self {
            Self::DegreesPerSecond => std::f64::consts::PI / 180.0,
            Self::RadiansPerSecond => 1.0,
        }
    }

    /// The unit of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::DegreesPerSecond, Self::RadiansPerSecond]
            .into_iter()
            .find(|unit| unit.name() == name)
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl From<allanite::RateUnit> for Unit {
    fn from(unit: allanite::RateUnit) -> Self {
        match unit {
            allanite::RateUnit::DegreesPerSecond => Self::DegreesPerSecond,
            allanite::RateUnit::RadiansPerSecond => Self::RadiansPerSecond,
        }
    }
}
