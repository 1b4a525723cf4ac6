use crate::{
    Error,
    numerics::real::{Real, real},
};
use core::num::NonZeroU64;

/// The number of intervals in a window. A timestamp that is late by a whole interval changes the
/// measured rate by 0.4 %. Chosen by hand for that error.
const WINDOW: u32 = 256;

/// The default tolerance of the rate, in per cent. It is larger than the error of the oscillators in
/// cheap sensors. Chosen by hand.
const TOLERANCE_PERCENT: u8 = 5;

const NS_PER_S: Real = 1e9;
const NS_PER_US: u64 = 1000;

/// Checks the samples' timestamps for skipped samples and for a configured rate that is not the true one.
/// A wrong rate shifts a whole curve along τ, and the counts do not show it.
///
/// A timestamp is the time at which a sample was read, in microseconds of any free-running 32-bit counter,
/// which may wrap. A stamp costs one integer division, and the state takes 48 bytes.
///
/// ```
/// use allanite::{Error, sensor::Pace};
///
/// let mut pace = Pace::new(100.0)?;
/// let mut now = u32::MAX - 500_000;
/// for _ in 0..=256 {
///     assert_eq!(pace.stamp(now), 1); // the next sample
///     now = now.wrapping_add(12_000); // a sensor at 83 Hz
/// }
/// assert!(matches!(pace.check(), Err(Error::RateContradicted { .. })));
/// assert_eq!(pace.stamp(now.wrapping_add(18_000)), 3); // two samples were skipped
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    interval_ns: NonZeroU64,
    /// The timestamp before.
    previous_us: Option<u32>,
    /// The time since the window began, in µs.
    elapsed_us: u64,
    /// The number of intervals since the window began.
    intervals: u32,
    /// The duration of the last complete window, in µs.
    window_us: Option<u64>,
    tolerance_percent: u8,
}

impl Pace {
    /// Expects samples at `rate_hz`, within 5 %.
    ///
    /// # Errors
    /// [`Error::InvalidRate`] if the rate is not positive or is 1 GHz or more.
    pub fn new(rate_hz: Real) -> Result<Self, Error> {
        // The cast gives zero for a rate that is negative, infinite or not a number, and saturates for a
        // rate near zero.
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

    /// Sets another tolerance of the configured rate, in per cent.
    pub const fn with_tolerance(mut self, tolerance_percent: u8) -> Self {
        self.tolerance_percent = tolerance_percent;
        self
    }

    /// Takes the time at which a sample was read, and returns how many sample intervals have passed since the
    /// sample before, rounded. If it is above 1, samples were skipped; if it is 0, one sample may have been
    /// read twice.
    ///
    /// The first sample, and the first after [`restart`](Self::restart), return 1.
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

    /// Begins a new window with the next timestamp. This is needed after reading was interrupted on purpose,
    /// or for longer than the counter takes to wrap.
    pub fn restart(&mut self) {
        self.previous_us = None;
        (self.elapsed_us, self.intervals) = (0, 0);
    }

    /// The rate over the last complete window of 256 intervals, in samples per second; `None` before that.
    pub fn measured_hz(&self) -> Option<Real> {
        self.window_us.map(|us| real(WINDOW) * 1e6 / us as Real)
    }

    /// Checks that the last complete window agrees with the configured rate. Before the first window is
    /// complete, the check succeeds.
    ///
    /// # Errors
    /// [`Error::RateContradicted`] if the measured rate is off by more than the tolerance.
    pub fn check(&self) -> Result<(), Error> {
        let Some(window_us) = self.window_us else {
            return Ok(());
        };
        // With f = n/t and f₀ = 1/T, |n T − t| ≤ tolerance · t is the same as |f − f₀| ≤ tolerance · f₀.
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
