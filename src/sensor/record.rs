//! From what a sensor's driver returns to what is kept of the record.

use super::{Error, Reading};
use crate::axis::{Axes, GatePart, MomentPart};

impl<const OCTAVES: usize, const COVARIATES: usize, G, M> Axes<OCTAVES, COVARIATES, G, M>
where
    G: GatePart,
    M: MomentPart,
{
    /// Takes what [`Imu::read`](super::Imu::read) returned, so that no sample is lost in silence: a sample
    /// is pushed, behind a gap if others were lost before it, and an error is a gap. `covariates` are the
    /// counts beside a sample. Returns whether there was a sample.
    ///
    /// ```
    /// use allanite::{Axes, sensor::{Error, Reading}};
    ///
    /// let mut axes = Axes::<8, 1, (), ()>::new();
    /// let temperature = |reading: &Reading| [reading.temperature.unwrap_or(0).into()];
    /// let reading = Reading { gyro: [3, -1, 0], temperature: Some(25), overrun: false };
    /// axes.record::<()>(&Ok(Some(reading)), temperature);
    /// axes.record::<()>(&Ok(None), temperature); // none waited: nothing happens
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
