use crate::Error;
use crate::real::{Real, real};
use core::num::NonZeroU64;

/// Intervals that a verdict takes: a timestamp late by a whole interval moves it by 0.4 %.
const WINDOW: u32 = 256;

/// How far a rate may be off, in per cent, unless told otherwise: above what the oscillators of
/// cheap sensors are off.
const TOLERANCE_PERCENT: u8 = 5;

const NS_PER_S: Real = 1e9;
const NS_PER_US: u64 = 1000;

/// Watches the samples' timestamps: were samples skipped, and is the configured rate the true one?
/// A wrong rate shifts a whole curve along τ, and nothing in the counts tells.
///
/// Timestamps are microseconds of any free-running counter of 32 bits, which may wrap, of the
/// moments when samples were read. A stamp costs one division of integers; 48 bytes.
///
/// ```
/// use allanite::{Error, sensor::Pace};
///
/// let mut pace = Pace::new(100.0)?;
/// let mut now = u32::MAX - 500_000;
/// for _ in 0..=256 {
///     assert_eq!(pace.stamp(now), 1); // the next sample
///     now = now.wrapping_add(12_000); // of a sensor at 83 Hz
/// }
/// assert!(matches!(pace.check(), Err(Error::RateContradicted { .. })));
/// assert_eq!(pace.stamp(now.wrapping_add(18_000)), 3); // two samples were skipped
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    interval_ns: NonZeroU64,
    /// Of the timestamp before.
    previous_us: Option<u32>,
    /// Since the window began.
    elapsed_us: u64,
    intervals: u32,
    /// How long the last complete window took.
    window_us: Option<u64>,
    tolerance_percent: u8,
}

impl Pace {
    /// Samples should come at `rate_hz`, within 5 %.
    ///
    /// # Errors
    /// [`Error::InvalidRate`] unless it is positive and below 1 GHz.
    pub fn new(rate_hz: Real) -> Result<Self, Error> {
        // Zero of a rate that is negative, infinite or not a number, saturated of one near zero.
        let interval_ns = (NS_PER_S / rate_hz + 0.5) as u64;
        match NonZeroU64::new(interval_ns) {
            Some(interval_ns) if interval_ns < NonZeroU64::MAX => Ok(Self {
                interval_ns,
                previous_us: None,
                elapsed_us: 0,
                intervals: 0,
                window_us: None,
                tolerance_percent: TOLERANCE_PERCENT,
            }),
            _ => Err(Error::InvalidRate(rate_hz)),
        }
    }

    /// Within `tolerance_percent` of the configured rate instead.
    pub const fn with_tolerance(mut self, tolerance_percent: u8) -> Self {
        self.tolerance_percent = tolerance_percent;
        self
    }

    /// A sample was read at `timestamp_us`. How many sample intervals have passed since the one
    /// before, rounded: above 1, samples were skipped; 0, one may have been read twice.
    ///
    /// The first sample, and the first after [`restart`](Self::restart), count as 1.
    pub fn stamp(&mut self, timestamp_us: u32) -> u32 {
        let Some(previous_us) = self.previous_us.replace(timestamp_us) else {
            return 1;
        };
        let elapsed_us = u64::from(timestamp_us.wrapping_sub(previous_us));
        self.elapsed_us = self.elapsed_us.saturating_add(elapsed_us);
        self.intervals += 1;
        if self.intervals == WINDOW {
            self.window_us = Some(self.elapsed_us);
            (self.elapsed_us, self.intervals) = (0, 0);
        }
        let rounded = (elapsed_us * NS_PER_US).saturating_add(self.interval_ns.get() / 2);
        u32::try_from(rounded / self.interval_ns).unwrap_or(u32::MAX)
    }

    /// Reading was interrupted on purpose, or for longer than the counter takes to wrap: the next
    /// timestamp is the first of a new window.
    pub fn restart(&mut self) {
        self.previous_us = None;
        (self.elapsed_us, self.intervals) = (0, 0);
    }

    /// Samples per second over the last complete window of 256; `None` before.
    pub fn measured_hz(&self) -> Option<Real> {
        self.window_us.map(|us| real(WINDOW) * 1e6 / us as Real)
    }

    /// Whether the last complete window agrees with the configured rate. Before there is one,
    /// nothing contradicts.
    ///
    /// # Errors
    /// [`Error::RateContradicted`] if the measured rate is off by more than the tolerance.
    pub fn check(&self) -> Result<(), Error> {
        let Some(window_us) = self.window_us else {
            return Ok(());
        };
        // |n T − t| ≤ tolerance · t is |f − f₀| ≤ tolerance · f₀ with f = n/t, f₀ = 1/T.
        let expected_ns = u128::from(self.interval_ns.get()) * u128::from(WINDOW);
        let elapsed_ns = u128::from(window_us) * u128::from(NS_PER_US);
        let off = expected_ns.abs_diff(elapsed_ns) * 100;
        if off <= elapsed_ns * u128::from(self.tolerance_percent) {
            return Ok(());
        }
        Err(Error::RateContradicted {
            configured_hz: NS_PER_S / self.interval_ns.get() as Real,
            measured_hz: real(WINDOW) * 1e6 / window_us as Real,
        })
    }
}
