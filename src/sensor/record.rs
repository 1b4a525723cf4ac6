//! Records what a sensor's driver returns.

use super::{Burst, Error, Loss, Malformed, Reading};
use crate::record::axis::{Axes, CoursePart, GatePart, MomentPart, SpectrumPart};

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, S, T>
    Axes<OCTAVES, COVARIATES, G, M, 3, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    /// Records the result of [`Imu::read`](super::Imu::read), so that no loss goes unnoticed. A sample is
    /// pushed, after a gap if samples were lost before it. An error becomes a gap. `covariates` returns the
    /// counts of the covariates at that sample. The result says whether there was a sample.
    ///
    /// ```
    /// use allanite::{Axes, sensor::{Error, Loss, Reading}};
    ///
    /// let mut axes = Axes::<8, 1, (), ()>::new();
    /// let temperature = |reading: &Reading| [reading.temperature.unwrap_or(0).into()];
    /// let (gyro, loss) = ([3, -1, 0], Loss::Nothing);
    /// let reading = Reading { gyro, temperature: Some(25), loss, ticks: None };
    /// axes.record_outcome::<()>(&Ok(Some(reading)), temperature);
    /// axes.record_outcome::<()>(&Ok(None), temperature); // no sample was ready: nothing happens
    /// let failed = Err(Error::Bus { register: 0x43, error: "no acknowledge" });
    /// axes.record_outcome(&failed, temperature);
    /// assert_eq!(axes.losses(), 1);
    /// let [x, _, _] = axes.accumulators();
    /// assert_eq!((x.samples(), x.gaps()), (1, 1));
    /// ```
    pub fn record_outcome<E>(
        &mut self,
        outcome: &Result<Option<Reading>, Error<E>>,
        covariates: impl FnOnce(&Reading) -> [i32; COVARIATES],
    ) -> bool {
        match outcome {
            Ok(Some(reading)) => {
                self.record_reading(reading, covariates);
                true
            }
            Ok(None) => false,
            Err(_) => {
                self.gap();
                false
            }
        }
    }

    /// Records a burst of [`FifoImu::read`](super::FifoImu::read) and returns the number of its samples. Samples that
    /// were lost before one become a gap of as many samples, or one of unknown length.
    ///
    /// An error of `read` need not be recorded: the next burst says what was lost.
    ///
    /// # Errors
    /// [`Malformed`] if a part of the burst made no sense. The samples before that part are recorded.
    pub fn record_burst(
        &mut self,
        burst: Burst<'_>,
        mut covariates: impl FnMut(&Reading) -> [i32; COVARIATES],
    ) -> Result<u32, Malformed> {
        let mut samples = 0_u32;
        for reading in burst {
            self.record_reading(&reading?, &mut covariates);
            samples = samples.saturating_add(1);
        }
        Ok(samples)
    }

    fn record_reading(
        &mut self,
        reading: &Reading,
        covariates: impl FnOnce(&Reading) -> [i32; COVARIATES],
    ) {
        match reading.loss {
            Loss::Nothing => {}
            Loss::Samples(samples) => self.lost(samples.into()),
            Loss::Unknown => self.gap(),
        }
        self.push((reading.gyro, covariates(reading)));
    }
}
