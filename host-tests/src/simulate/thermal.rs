//! A temperature that the rate follows.

use std::f64::consts::PI;

/// A temperature that changes in the course of a record, and a rate that follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    /// Rate units per kelvin.
    pub slope: f64,
    /// How far the temperature rises, or the amplitude of its cycle.
    pub kelvin: f64,
    /// How the temperature changes.
    pub course: Course,
}

/// The course of a temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// `1 − e^(−t/time)`: a sensor that has been switched on.
    WarmUp {
        /// The time constant, in seconds.
        time_s: f64,
    },
    /// `sin(2πt/period)`: a room with a thermostat.
    Cycle {
        /// The period, in seconds.
        period_s: f64,
    },
}

/// Where every temperature begins, in °C.
const ROOM_CELSIUS: f64 = 25.0;

impl Thermal {
    /// Kelvin above the beginning, so many seconds into the record.
    fn kelvin_at(&self, time_s: f64) -> f64 {
        self.kelvin
            * match self.course {
                Course::WarmUp { time_s: constant } => -(-time_s / constant).exp_m1(),
                Course::Cycle { period_s } => (2.0 * PI * (time_s / period_s).fract()).sin(),
            }
    }

    /// What it adds to the rate.
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
