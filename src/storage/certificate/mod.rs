//! Certificates of a gyro's calibration: the identity of the gyro, the conditions of the measurement,
//! and its results.
//!
//! This table describes version 3 of the payload of the [envelope](crate::storage::envelope). The payload is
//! in postcard's encoding: f32 and f64 are little endian, integers longer than one byte are varints, and an
//! option is a byte 0, or a byte 1 followed by its content. NaN stands for an unknown number.
//!
//! | content | type |
//! |---|---|
//! | device: number of bytes up to 16, and the bytes | varint, bytes |
//! | firmware: major, minor, patch | 3 × u16 |
//! | lowest and highest temperature in °C | option of 2 × f32 |
//! | duration in s, sample rate in Hz | 2 × f64 |
//! | samples, gaps | 2 × u64 |
//! | rate unit: 0 is deg/s, 1 rad/s | u8 |
//! | number of axes up to 3; for each axis: | u8 |
//! | – χ², p-value | 2 × f64 |
//! | – degrees of freedom | u16 |
//! | – tolerance granted | f32 |
//! | – verdict: 0 none, 1 adequate, 2 improved, 3 unexplained, 4 invalid and why, 5 too short, 6 incomplete | u8, reason |
//! | – number of terms up to 8; for each term: | u8 |
//! | – – [code](EffectCode) of the effect, 0 for an effect that has none | u8 |
//! | – – value, lower, upper, standard error of the square | 4 × f32 |
//! | – – state: 0 measured, 1 upper bound, 2 not observable and the length in s that would do | u8, option of f32 |
//! | – – number of shape parameters up to 2; for each: value, lower, upper | u8, 3 × f32 |
//! | – correlations of the squares, lower triangle row by row without diagonal | f32 each |
//! | – number of limits of detection up to 18; for each of them: | u8 |
//! | – – code of the effect | u8 |
//! | – – limit, lowest and highest value of the first shape parameter | 3 × f32 |
//! | – number of covariates that the rate follows up to 2; for each of them: | u8 |
//! | – – place among those of the diagnosis | u8 |
//! | – – slope, its standard error | 2 × f32 |
//! | – number of doubts up to 12; for each: code of an effect of the model, and of one that explains as much | u8, 2 × u8 |
//! | – number of bands of the spectrum up to 3; for each: lowest and highest frequency in Hz, standard errors | u8, 3 × f32 |
//! | – 0 without a course; else 1, and the number of events up to 8; for each of them: | u8, u8 |
//! | – – kind: 0 noise change, 1 bursts and blocks (u8), 2 step, 3 warm-up and time constant in s (f32) | u8, and as listed |
//! | – – time in s, size, lower, upper, standard errors | 5 × f32 |
//!
//! Version 2 ends an axis with the limits of detection, and version 1 with the correlations. A certificate is written
//! as the lowest version that has room for what it says, so that earlier readers read it.
//!
//! A reason is 0 stuck (longest run u32, changes u64, samples u64), 1 railed (hits u64, samples u64),
//! 2 spiked (spikes u64, percent u8), 3 moved (motions u64, cluster u16, percent u8), 4 missing (missing u64,
//! sent u64), 5 left out (left out u64, samples u64), 6 repeated (times u8, changes u64, samples u64), 7 coarse
//! (per mille u16), 8 dead band (zeros u64, samples u64), 9 misread (bits u8), 10 changed (after u64, percent u16),
//! 11 unanswered (reads u64, samples u64) or 12 stale (stale u64, distance u16, samples u64).
//!
//! Every number is checked when a certificate is read, by itself and against the others: intervals contain their values,
//! a doubt is one about an effect of the model, bands lie below half of the sample rate, and events within the duration.

mod axis;
mod effect_code;
mod findings;
mod possible;
mod verdict;
mod wire;

pub use axis::{AxisCertificate, CertifiedLimit, CertifiedShape, CertifiedState, CertifiedTerm};
pub use effect_code::EffectCode;
pub use findings::{
    CertifiedBand, CertifiedEvent, CertifiedSlope, CertifiedWhat, Doubt, Findings, MAX_COVARIATES,
    MAX_DOUBTS,
};
pub(crate) use verdict::WireReason;

use super::Error;
use heapless::Vec;

/// The largest number of axes in a certificate.
pub const MAX_AXES: usize = 3;

/// The largest number of bytes of a device's identity.
pub const MAX_DEVICE_BYTES: usize = 16;

/// The unit of the rates in a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RateUnit {
    /// deg/s.
    DegreesPerSecond,
    /// rad/s.
    RadiansPerSecond,
}

/// The conditions under which a gyro was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Conditions {
    /// The lowest and the highest temperature in °C; `None` if the temperature was not measured.
    pub temperature_c: Option<(f32, f32)>,
    /// The duration of the measurement, in seconds.
    pub duration_s: f64,
    /// The sample rate, in samples per second.
    pub rate_hz: f64,
    /// The number of samples.
    pub samples: u64,
    /// The number of ends of contiguous stretches among the samples.
    pub gaps: u64,
}

/// The certificate of a gyro's factory calibration.
///
/// # Example
///
/// ```
/// use allanite::{Curve, Model, Real, fit::{Options, fit}, storage::{AxisCertificate, Conditions, RateUnit, Certificate}};
///
/// let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / (1 << k) as Real));
/// let (curve, model) = (Curve::<10>::new(100.0, white)?, Model::ieee_952());
/// let fit = fit(&curve, &model, Options::default())?;
///
/// let conditions = Conditions {
///     temperature_c: Some((22.5, 24.0)),
///     duration_s: 400.0,
///     rate_hz: 100.0,
///     samples: 40_000,
///     gaps: 0,
/// };
/// let mut record = Certificate::new(b"SN-0042", [1, 2, 0], conditions, RateUnit::DegreesPerSecond)?;
/// let axis = AxisCertificate::new(&curve, &model, &fit)?;
/// assert!(record.axes.push(axis).is_ok());
///
/// let mut buffer = [0; Certificate::MAX_BYTES];
/// let stored = record.encode(&mut buffer)?;
/// let read = Certificate::decode(stored)?;
/// assert_eq!(read.device, record.device);
/// assert_eq!(read.axes[0].terms[1].effect.name(), "angle_random_walk");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Certificate {
    /// The identity of the device, such as a serial number; it need not be text.
    pub device: Vec<u8, MAX_DEVICE_BYTES>,
    /// The version of its firmware: major, minor, patch.
    pub firmware: [u16; 3],
    /// The conditions of the measurement.
    pub conditions: Conditions,
    /// The unit of the rates.
    pub unit: RateUnit,
    /// The results for each axis.
    pub axes: Vec<AxisCertificate, MAX_AXES>,
}

impl Certificate {
    /// A certificate without axes.
    ///
    /// # Errors
    /// [`Error::DeviceTooLong`] if the identity is longer than [`MAX_DEVICE_BYTES`].
    pub fn new(
        device: &[u8],
        firmware: [u16; 3],
        conditions: Conditions,
        unit: RateUnit,
    ) -> Result<Self, Error> {
        let too_long = Error::DeviceTooLong {
            length: device.len(),
            capacity: MAX_DEVICE_BYTES,
        };
        Ok(Self {
            device: Vec::from_slice(device).map_err(|_| too_long)?,
            firmware,
            conditions,
            unit,
            axes: Vec::new(),
        })
    }
}
