//! What a logger does to samples: it repeats them, holds values for a while, clips them, or cuts out a band.
//!
//! A [`SampleFaults`] watches an axis. It is apart from [`Integrity`](crate::integrity::Integrity), so that a device that does not ask
//! for it pays nothing. A [`JointRepeats`] is what is kept of the three axes of a sensor together. `evidence` judges both.

pub(crate) mod ends;
mod hole;
mod slice;
mod spread;
pub(crate) mod steps;
pub(crate) mod zero_runs;

pub(crate) use hole::Hole;

use ends::End;
use spread::Spread;
use steps::Steps;
use zero_runs::ZeroRuns;

/// Counts, in fixed memory and integers, what shows that a logger repeated, held, clipped or cut out samples of one
/// axis.
///
/// Beside the repeats are counted the differences of one, two and three steps, from which the number of repeats by
/// chance follows, the lengths of runs of repeats, the values at both ends of the range and next to them, and zeros and
/// the values next to them. A sample takes some ten comparisons and additions. The state takes at most 512 bytes.
///
/// ```
/// use allanite::{faults::SampleFaults, integrity::Reason};
///
/// // A sensor of 400 Hz, read at 500 Hz.
/// let (mut faults, mut random) = (SampleFaults::new(), 1_u32);
/// for n in 0..20_000 {
///     if n % 5 != 0 {
///         random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     }
///     faults.push((random >> 8) as i32);
/// }
/// let Some(Reason::Repeated { changes, samples, .. }) = faults.verdict(None) else { panic!() };
/// assert!((samples * 4).abs_diff(changes * 5) < 50);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SampleFaults {
    pub(crate) zero: i32,
    last: Option<i32>,
    pub(crate) samples: u64,
    pub(crate) steps: Steps,
    pub(crate) runs: ZeroRuns,
    pub(crate) ends: [End; 2],
    pub(crate) hole: Hole,
    pub(crate) spread: Spread,
}

impl SampleFaults {
    /// No samples yet.
    pub const fn new() -> Self {
        Self::with_zero(0)
    }

    /// No samples yet, of counts whose zero is this one.
    pub const fn with_zero(zero: i32) -> Self {
        Self {
            zero,
            last: None,
            samples: 0,
            steps: Steps::NEW,
            runs: ZeroRuns::NEW,
            ends: [End::NEW, End::NEW],
            hole: Hole::NEW,
            spread: Spread::NEW,
        }
    }

    /// Adds a count. Returns how many steps it is away from the one before, for [`Reads::push_steps`](super::reads::Reads::push_steps): 0 if it repeats
    /// it, and 4 from four steps on. `None` behind a gap.
    #[inline]
    pub fn push(&mut self, count: i32) -> Option<u8> {
        self.samples = self.samples.saturating_add(1);
        let class = self.last.map(|last| self.steps.push(count.abs_diff(last)));
        self.last = Some(count);
        let repeats = class == Some(0);
        self.runs.push(repeats);
        self.spread.push(count);
        self.hole
            .push(count.abs_diff(self.zero), repeats, &self.steps);
        let [high, low] = &mut self.ends;
        let count = i64::from(count);
        for (end, value) in [(high, count), (low, -count)] {
            end.push(value, repeats, |distance| self.steps.class(distance));
        }
        class
    }

    /// Marks a place where the next sample does not adjoin the one before.
    pub fn gap(&mut self) {
        self.last = None;
        self.runs.push(false);
    }
}

impl Default for SampleFaults {
    /// No samples yet.
    fn default() -> Self {
        Self::new()
    }
}

/// Counts which of the three axes of a sensor repeat at the same time: a part of [`Reads`](super::reads::Reads). That one axis repeats
/// says little where counts are coarse; that three do at once says much.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct JointRepeats {
    /// The number of samples in which the axes repeat whose bits are set in the place.
    pub(crate) cells: [u64; 8],
    /// The number of samples in which two axes repeat and the third one moves by one step, and by two.
    pub(crate) third: [u64; 2],
    /// Runs of samples in which all axes repeat.
    pub(crate) runs: ZeroRuns,
    /// Of some samples, the number of axes that are as they were one sample before, and two before.
    pub(crate) returned: [u32; 2],
}

impl JointRepeats {
    pub(super) const NEW: Self = Self {
        cells: [0; 8],
        third: [0; 2],
        runs: ZeroRuns::NEW,
        returned: [0; 2],
    };

    /// Adds the steps of a sample in which an axis repeats: 0 for an axis that does, and how many steps another one moves. Returns
    /// whether all axes repeat.
    pub(super) fn push(&mut self, [x, y, z]: [u8; 3]) -> bool {
        let cell = usize::from(x == 0) | usize::from(y == 0) << 1 | usize::from(z == 0) << 2;
        if let Some(cell) = self.cells.get_mut(cell) {
            *cell = cell.saturating_add(1);
        }
        self.runs.push(cell == 7);
        if cell.count_ones() == 2 {
            // Only the axis that does not repeat contributes.
            let third = x.wrapping_add(y).wrapping_add(z).wrapping_sub(1);
            if let Some(third) = self.third.get_mut(usize::from(third)) {
                *third = third.saturating_add(1);
            }
        }
        cell == 7
    }

    /// The next sample does not go on with a run.
    pub(super) fn end_run(&mut self) {
        self.runs.push(false);
    }

    /// Compares the axes with what they were one sample before, and two before.
    pub(super) fn compare(&mut self, counts: [i32; 3], last: [i32; 3], before: [i32; 3]) {
        let equal = |[x, y, z]: [i32; 3], [x1, y1, z1]: [i32; 3]| {
            u32::from(x == x1)
                .wrapping_add(u32::from(y == y1))
                .wrapping_add(u32::from(z == z1))
        };
        let [one, two] = &mut self.returned;
        *one = one.saturating_add(equal(counts, last));
        *two = two.saturating_add(equal(counts, before));
    }

    /// The same, of so many pairs of neighbours: with the samples in which no axis repeats.
    pub(super) fn of(&self, pairs: u64) -> Self {
        let mut whole = self.clone();
        let [none, others @ ..] = &mut whole.cells;
        let others = others
            .iter()
            .fold(0, |sum: u64, cell| sum.saturating_add(*cell));
        *none = pairs.saturating_sub(others);
        whole
    }

    /// Adds what was counted in another record.
    pub(super) fn merge(&mut self, other: &Self) {
        let pairs = self.cells.iter_mut().zip(&other.cells);
        for (own, other) in pairs.chain(self.third.iter_mut().zip(&other.third)) {
            *own = own.saturating_add(*other);
        }
        self.runs.merge(&other.runs);
        for (own, other) in self.returned.iter_mut().zip(&other.returned) {
            *own = own.saturating_add(*other);
        }
    }
}

#[cfg(test)]
mod tests;
