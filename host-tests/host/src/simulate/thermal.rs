//! A temperature that the rate depends on.

use std::f64::consts::PI;

/// A temperature that changes during a record, and a rate that is proportional to its change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    /// The slope, in rate units per kelvin.
    pub slope: f64,
    /// The rise of the temperature, or the amplitude of its cycle, in kelvin.
    pub kelvin: f64,
    /// How the temperature changes with time.
    pub course: Course,
}

/// The course of a temperature over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// The sensor has been switched on: `1 − e^(−t/time)`.
    WarmUp {
        /// The time constant, in seconds.
        time_s: f64,
    },
    /// The room has a thermostat: `sin(2πt/period)`.
    Cycle {
        /// The period, in seconds.
        period_s: f64,
    },
}

/// The temperature at the beginning of every record, in °C.
const ROOM_CELSIUS: f64 = 25.0;

impl Thermal {
    /// The temperature above that at the beginning, in kelvin, `time_s` into the record.
    fn kelvin_at(&self, time_s: f64) -> f64 {
        self.kelvin
            * match self.course {
                Course::WarmUp { time_s: constant } => -(-time_s / constant).exp_m1(),
                Course::Cycle { period_s } => (2.0 * PI * (time_s / period_s).fract()).sin(),
            }
    }

    /// The contribution to the rate.
    pub fn rate_at(&self, time_s: f64) -> f64 {
        self.slope * self.kelvin_at(time_s)
    }

    /// The temperature in °C.
    pub fn celsius_at(&self, time_s: f64) -> f64 {
        ROOM_CELSIUS + self.kelvin_at(time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_follows_the_temperature_of_either_course() {
        let at = |course, time_s| {
            let thermal = Thermal {
                slope: 0.01,
                kelvin: 10.0,
                course,
            };
            (thermal.celsius_at(time_s), thermal.rate_at(time_s))
        };
        let warm_up = Course::WarmUp { time_s: 600.0 };
        assert_eq!(at(warm_up, 0.0), (25.0, 0.0));
        let (celsius, rate) = at(warm_up, 600.0);
        assert!(
            (celsius - 25.0 - 6.321_205_588).abs() < 1e-8 && (rate - 0.063_212_055).abs() < 1e-8
        );
        let cycle = Course::Cycle { period_s: 1200.0 };
        let (celsius, rate) = at(cycle, 1500.0);
        assert!((celsius - 35.0).abs() < 1e-9 && (rate - 0.1).abs() < 1e-12);
    }
}
