//! Records what a sensor's driver returns.

use super::{Error, Reading};
use crate::axis::{Axes, GatePart, MomentPart, SpectrumPart, TrackPart};

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, S, T>
    Axes<OCTAVES, COVARIATES, G, M, 3, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: TrackPart,
{
    /// Records the result of [`Imu::read`](super::Imu::read), so that no loss goes unnoticed. A sample is
    /// pushed, after a gap if samples were lost before it. An error becomes a gap. `covariates` returns the
    /// counts of the covariates at that sample. The result says whether there was a sample.
    ///
    /// ```
    /// use allanite::{Axes, sensor::{Error, Reading}};
    ///
    /// let mut axes = Axes::<8, 1, (), ()>::new();
    /// let temperature = |reading: &Reading| [reading.temperature.unwrap_or(0).into()];
    /// let reading = Reading { gyro: [3, -1, 0], temperature: Some(25), overrun: false };
    /// axes.record::<()>(&Ok(Some(reading)), temperature);
    /// axes.record::<()>(&Ok(None), temperature); // no sample was ready: nothing happens
    /// let failed = Err(Error::Bus { register: 0x43, error: "no acknowledge" });
    /// axes.record(&failed, temperature);
    /// assert_eq!(axes.losses(), 1);
    /// let [x, _, _] = axes.accumulators();
    /// assert_eq!((x.samples(), x.gaps()), (1, 1));
    /// ```
    pub fn record<E>(
        &mut self,
        outcome: &Result<Option<Reading>, Error<E>>,
        covariates: impl FnOnce(&Reading) -> [i32; COVARIATES],
    ) -> bool {
        match outcome {
            Ok(Some(reading)) => {
                if reading.overrun {
                    self.gap();
                }
                self.push((reading.gyro, covariates(reading)));
                true
            }
            Ok(None) => false,
            Err(_) => {
                self.gap();
                false
            }
        }
    }
}
