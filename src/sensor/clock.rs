use super::Description;
use crate::{
    Error,
    numerics::real::{Real, real},
};

/// The number of sample intervals before the clock is judged. The time of a burst is uncertain by one interval, so
/// that the error is then below 0.4 %.
const JUDGED_AFTER: u64 = 256;

/// The default tolerance of the rate, in per cent, as in [`Pace`](super::Pace).
const TOLERANCE_PERCENT: u8 = 5;

/// The sensor's clock against the host's, from the sensor's own time stamps.
///
/// A curve is drawn over τ = m/f, and the rate f is that of the sensor's oscillator, which may be off by some per
/// cent. The stamps count the oscillator's ticks without loss, over as many bursts as there are, so that the
/// error of the rate becomes as small as one interval relative to the whole time.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Clock {
    rate_hz: Real,
    tick_ps: u32,
    /// The sample interval in 1/256 ticks.
    interval: u64,
    /// The sensor's time at the first burst and at the last one.
    ticks: Option<(u64, u64)>,
    /// The host's time at the last burst.
    now_us: u32,
    /// The host's time since the first burst.
    elapsed_us: u64,
    tolerance_percent: u8,
}

impl Clock {
    pub(super) const fn new(description: &Description, tick_ps: u32) -> Self {
        Self {
            rate_hz: description.rate_hz,
            tick_ps,
            interval: 1,
            ticks: None,
            now_us: 0,
            elapsed_us: 0,
            tolerance_percent: TOLERANCE_PERCENT,
        }
    }

    /// Takes the sensor's time at a time of the host, and the sample interval in 1/256 ticks.
    pub(super) fn note(&mut self, now_us: u32, ticks: u64, interval: u64) {
        match &mut self.ticks {
            Some((_, last)) => {
                *last = ticks;
                let elapsed_us = u64::from(now_us.wrapping_sub(self.now_us));
                self.elapsed_us = self.elapsed_us.saturating_add(elapsed_us);
            }
            None => self.ticks = Some((ticks, ticks)),
        }
        self.now_us = now_us;
        self.interval = interval.max(1);
    }

    /// Sets another tolerance of [`check`](Self::check), in per cent.
    pub const fn set_tolerance(&mut self, tolerance_percent: u8) {
        self.tolerance_percent = tolerance_percent;
    }

    /// The ticks since the first burst, and the host's time in µs, once they are long enough.
    fn elapsed(&self) -> Option<(u64, u64)> {
        let (first, last) = self.ticks?;
        let ticks = last.saturating_sub(first);
        let long = ticks.saturating_mul(256) >= self.interval.saturating_mul(JUDGED_AFTER);
        (long && self.elapsed_us > 0).then_some((ticks, self.elapsed_us))
    }

    /// How much faster than nominal the sensor's clock runs, in parts per million of the host's clock. `None` within
    /// the first 256 sample intervals.
    pub fn error_ppm(&self) -> Option<Real> {
        let (ticks, elapsed_us) = self.elapsed()?;
        // In integers, because the difference is small.
        let sensor_ps = u128::from(ticks) * u128::from(self.tick_ps);
        let host_ps = u128::from(elapsed_us) * 1_000_000;
        let off_ps = sensor_ps.abs_diff(host_ps) as Real;
        let off_ppm = off_ps / elapsed_us as Real;
        Some(if sensor_ps < host_ps {
            -off_ppm
        } else {
            off_ppm
        })
    }

    /// The largest error of [`error_ppm`](Self::error_ppm), in ppm, if the host's clock is right and it took the time
    /// of each burst exactly: one sample interval, by which the newest sample may be old. `None` within the
    /// first 256 sample intervals.
    pub fn uncertainty_ppm(&self) -> Option<Real> {
        let (ticks, _) = self.elapsed()?;
        Some(1e6 / 256.0 * self.interval as Real / ticks as Real)
    }

    /// The sensor's rate in samples per second of the host's clock. `None` within the first 256 sample
    /// intervals.
    pub fn measured_hz(&self) -> Option<Real> {
        let (ticks, elapsed_us) = self.elapsed()?;
        Some(256e6 * (ticks as Real / self.interval as Real) / elapsed_us as Real)
    }

    /// Checks that the measured rate agrees with the configured one. Within the first 256 sample intervals, the
    /// check succeeds.
    ///
    /// # Errors
    /// [`Error::RateContradicted`] if the measured rate is off by more than the tolerance of 5 %.
    pub fn check(&self) -> Result<(), Error> {
        let Some(measured_hz) = self.measured_hz() else {
            return Ok(());
        };
        let tolerance = real(self.tolerance_percent) / 100.0;
        let off = measured_hz - self.rate_hz;
        if off.max(-off) <= tolerance * self.rate_hz {
            return Ok(());
        }
        Err(Error::RateContradicted {
            configured_hz: self.rate_hz,
            measured_hz,
        })
    }
}
