use super::{Error, Reading};
use crate::Accumulator;

/// One accumulator an axis, so that no sample is lost in silence: whatever was lost becomes a
/// [gap](Accumulator::gap) of all three.
///
/// ```
/// use allanite::sensor::{Axes, Error, Reading};
///
/// let mut axes = Axes::<8>::new();
/// let reading = Reading { gyro: [3, -1, 0], temperature: None, overrun: false };
/// axes.record::<()>(&Ok(Some(reading)));
/// axes.record::<()>(&Ok(None)); // none waited: nothing happens
/// axes.record(&Err(Error::Bus { register: 0x43, error: "no acknowledge" }));
/// assert_eq!(axes.losses(), 1);
/// let [x, _, _] = axes.accumulators();
/// assert_eq!((x.samples(), x.gaps()), (1, 1));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axes<const OCTAVES: usize> {
    accumulators: [Accumulator<OCTAVES>; 3],
    losses: u64,
}

impl<const OCTAVES: usize> Axes<OCTAVES> {
    /// Three empty accumulators.
    pub const fn new() -> Self {
        Self {
            accumulators: [const { Accumulator::new() }; 3],
            losses: 0,
        }
    }

    /// Takes what [`Imu::read`](super::Imu::read) gave: a sample is pushed, an error is a gap.
    /// Whether a sample was pushed.
    pub fn record<E>(&mut self, outcome: &Result<Option<Reading>, Error<E>>) -> bool {
        match outcome {
            Ok(Some(reading)) => self.push(reading),
            Ok(None) => return false,
            Err(_) => self.lose(),
        }
        matches!(outcome, Ok(Some(_)))
    }

    /// Adds one sample, behind a gap if others were lost before it.
    pub fn push(&mut self, reading: &Reading) {
        if reading.overrun {
            self.lose();
        }
        for (accumulator, count) in self.accumulators.iter_mut().zip(reading.gyro) {
            accumulator.push(count);
        }
    }

    /// Samples were lost: a gap.
    pub fn lose(&mut self) {
        for accumulator in &mut self.accumulators {
            accumulator.gap();
        }
        self.losses = self.losses.saturating_add(1);
    }

    /// How often samples were lost: overruns, failed reads and calls of [`lose`](Self::lose).
    /// [`Accumulator::gaps`] counts less where several follow each other without a sample between.
    pub const fn losses(&self) -> u64 {
        self.losses
    }

    /// x, y and z.
    pub const fn accumulators(&self) -> &[Accumulator<OCTAVES>; 3] {
        &self.accumulators
    }
}

impl<const OCTAVES: usize> Default for Axes<OCTAVES> {
    fn default() -> Self {
        Self::new()
    }
}
