use super::{Description, Filter};
use crate::numerics::real::Real;
use core::fmt;

/// What a user chooses of a sensor: rate, range, low pass, and when its FIFO signals.
///
/// A function of the sensor turns it into a [`Description`] and refuses what the sensor does not offer, and a low
/// pass that would let noise fold back. The functions are constant, so that a program refuses it when it is
/// compiled:
///
/// ```
/// use allanite::sensor::{Configuration, Description, icm_42688_p};
///
/// static GYRO: Description = match icm_42688_p(Configuration::new(200, 500)) {
///     Ok(description) => description,
///     Err(_) => panic!("the ICM-42688-P does not offer this"),
/// };
/// assert_eq!((GYRO.rate_hz, GYRO.scale_dps), (200.0, 1.0 / 65.5));
/// ```
///
/// ```compile_fail
/// # use allanite::sensor::{Configuration, Description, icm_42688_p};
/// // A cut-off of 100 Hz is beyond half the rate of 100 Hz.
/// static GYRO: Description = match icm_42688_p(Configuration::new(100, 250).bandwidth_hz(100)) {
///     Ok(description) => description,
///     Err(_) => panic!("the ICM-42688-P does not offer this"),
/// };
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Configuration {
    rate_hz: u16,
    range_dps: u16,
    bandwidth_hz: Option<u16>,
    watermark: u16,
}

impl Configuration {
    /// A configuration with the widest low pass that is certain to keep noise from folding back, and a watermark of 8
    /// samples. `rate_hz` is the rate in samples per second, and `range_dps` the range in °/s to either side, both as the data
    /// sheet names them; of a range with a fraction, the integer part.
    pub const fn new(rate_hz: u16, range_dps: u16) -> Self {
        Self {
            rate_hz,
            range_dps,
            bandwidth_hz: None,
            watermark: 8,
        }
    }

    /// Chooses the low pass by its nominal cut-off in Hz; of one with a fraction, the integer part.
    pub const fn bandwidth_hz(self, bandwidth_hz: u16) -> Self {
        Self {
            bandwidth_hz: Some(bandwidth_hz),
            ..self
        }
    }

    /// Chooses the number of samples in the FIFO at which the interrupt pin signals.
    pub const fn watermark(self, samples: u16) -> Self {
        Self {
            watermark: samples,
            ..self
        }
    }
}

/// Why a sensor refuses a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ConfigurationError {
    /// The sensor has no such rate, or nothing is known of its low pass at this rate.
    Rate {
        /// The name of the sensor.
        sensor: &'static str,
        /// The rate, in samples per second.
        rate_hz: u16,
    },
    /// The sensor has no such range.
    Range {
        /// The name of the sensor.
        sensor: &'static str,
        /// The range, in °/s.
        range_dps: u16,
    },
    /// The sensor has no such low pass at this rate.
    Bandwidth {
        /// The name of the sensor.
        sensor: &'static str,
        /// The nominal cut-off, in Hz.
        bandwidth_hz: u16,
        /// The rate, in samples per second.
        rate_hz: u16,
    },
    /// The low pass would let noise beyond half the rate fold back.
    Folding {
        /// The name of the sensor.
        sensor: &'static str,
        /// The nominal cut-off, in Hz.
        bandwidth_hz: u16,
        /// The rate, in samples per second.
        rate_hz: u16,
    },
    /// The FIFO cannot signal at this number of samples.
    Watermark {
        /// The name of the sensor.
        sensor: &'static str,
        /// The watermark, in samples.
        samples: u16,
        /// The largest possible watermark.
        most: u16,
    },
}

impl fmt::Display for ConfigurationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rate { sensor, rate_hz } => {
                write!(f, "{sensor} is not described at a rate of {rate_hz} Hz")
            }
            Self::Range { sensor, range_dps } => {
                write!(f, "{sensor} has no range of ±{range_dps} °/s")
            }
            Self::Bandwidth {
                sensor,
                bandwidth_hz,
                rate_hz,
            } => write!(
                f,
                "{sensor} has no low pass of {bandwidth_hz} Hz at a rate of {rate_hz} Hz"
            ),
            Self::Folding {
                sensor,
                bandwidth_hz,
                rate_hz,
            } => write!(
                f,
                "at {rate_hz} Hz, the low pass of {sensor} at {bandwidth_hz} Hz lets noise fold back: \
                 choose a lower one"
            ),
            Self::Watermark {
                sensor,
                samples,
                most,
            } => write!(
                f,
                "{sensor} cannot signal at {samples} samples: choose 1 to {most}"
            ),
        }
    }
}

impl core::error::Error for ConfigurationError {}

/// A low pass on offer.
#[derive(Clone, Copy)]
pub(super) struct LowPass {
    pub(super) code: u8,
    /// The nominal cut-off.
    pub(super) bandwidth_hz: u16,
    pub(super) filter: Filter,
    /// Whether folded noise is certain to raise N by less than 2 %. If not, it has to be asked for.
    pub(super) is_tight: bool,
}

/// The codes that a data sheet gives for a configuration.
pub(super) struct Chosen {
    pub(super) rate_hz: u16,
    pub(super) rate: u8,
    pub(super) range: u8,
    pub(super) scale_dps: Real,
    pub(super) low_pass: LowPass,
    pub(super) watermark: u16,
}

/// What a sensor offers.
pub(super) struct Offer<const RATES: usize, const RANGES: usize> {
    pub(super) sensor: &'static str,
    /// The rates in Hz, and their codes.
    pub(super) rates: [(u16, u8); RATES],
    /// The ranges in °/s, their codes, and the scales in °/s per count.
    pub(super) ranges: [(u16, u8, Real); RANGES],
    /// The largest watermark.
    pub(super) most: u16,
}

impl<const RATES: usize, const RANGES: usize> Offer<RATES, RANGES> {
    /// Looks a configuration up. `low_passes` are those at its rate, from the widest to the narrowest.
    pub(super) const fn choose(
        &self,
        wanted: Configuration,
        low_passes: &[LowPass],
    ) -> Result<Chosen, ConfigurationError> {
        let Configuration {
            rate_hz,
            range_dps,
            bandwidth_hz,
            watermark,
        } = wanted;
        let sensor = self.sensor;
        if watermark == 0 || watermark > self.most {
            return Err(ConfigurationError::Watermark {
                sensor,
                samples: watermark,
                most: self.most,
            });
        }
        let mut k = 0;
        while k < RATES && self.rates[k].0 != rate_hz {
            k += 1;
        }
        if k >= RATES {
            return Err(ConfigurationError::Rate { sensor, rate_hz });
        }
        let rate = self.rates[k].1;
        let mut k = 0;
        while k < RANGES && self.ranges[k].0 != range_dps {
            k += 1;
        }
        if k >= RANGES {
            return Err(ConfigurationError::Range { sensor, range_dps });
        }
        let (_, range, scale_dps) = self.ranges[k];
        let mut refusal = ConfigurationError::Rate { sensor, rate_hz };
        if let Some(bandwidth_hz) = bandwidth_hz {
            refusal = ConfigurationError::Bandwidth {
                sensor,
                bandwidth_hz,
                rate_hz,
            };
        }
        let mut k = 0;
        while k < low_passes.len() {
            let low_pass = low_passes[k];
            k += 1;
            let nominal = low_pass.bandwidth_hz;
            match bandwidth_hz {
                Some(bandwidth_hz) if bandwidth_hz != nominal => continue,
                None if !low_pass.is_tight => continue,
                _ => {}
            }
            if 2.0 * low_pass.filter.noise_bandwidth_hz < rate_hz as Real {
                return Ok(Chosen {
                    rate_hz,
                    rate,
                    range,
                    scale_dps,
                    low_pass,
                    watermark,
                });
            }
            if bandwidth_hz.is_some() {
                refusal = ConfigurationError::Folding {
                    sensor,
                    bandwidth_hz: nominal,
                    rate_hz,
                };
            }
        }
        Err(refusal)
    }
}

impl Configuration {
    /// The rate, in samples per second.
    pub(super) const fn rate_hz(&self) -> u16 {
        self.rate_hz
    }
}

/// A description in a static of this crate. What is refused does not compile.
pub(super) const fn checked(result: Result<Description, ConfigurationError>) -> Description {
    match result {
        Ok(description) => description,
        Err(_) => panic!("the default configuration is refused"),
    }
}
