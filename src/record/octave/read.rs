//! What an accumulator says of its octaves, with what the schedule has put off.

use super::{Accumulator, FIRST, Level, OctaveSum, RING, bridged::span, second_difference};
use crate::record::square_sum::SquareSum;

/// The number of differences from which the variances of two records can be compared. That of white noise is known to 3 %
/// then.
const COMPARED: u64 = 4096;

impl OctaveSum {
    /// Whether the variance of this octave is about that of the same octave of another record: the larger one is below one
    /// and a half times the smaller one. True where either record has fewer than 4096 differences, or less than half a
    /// squared count for each, which follows from where between two counts the offset lies.
    pub fn is_like(&self, other: &Self) -> bool {
        let [ours, theirs] = [self, other].map(|octave| {
            let sum = octave.sum.to_u128()?.checked_mul(256)?;
            let mean = sum.checked_div(octave.differences.into())?;
            (octave.differences >= COMPARED && mean >= 128).then_some(mean)
        });
        let (Some(ours), Some(theirs)) = (ours, theirs) else {
            return true;
        };
        let (least, most) = (ours.min(theirs), ours.max(theirs));
        most.saturating_mul(2) < least.saturating_mul(3)
    }
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// Whether another record can be one of the same sensor, read with the same scale and filter: the noise of single samples
    /// is [like](OctaveSum::is_like) that of this one. [`merge`](Self::merge) does not ask, and a merged record of two
    /// sensors has the coefficients of neither.
    ///
    /// ```
    /// use allanite::Accumulator;
    ///
    /// let record = |size: i32, mut random: u32| {
    ///     let mut accumulator = Accumulator::<10>::new();
    ///     for _ in 0..10_000 {
    ///         random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    ///         accumulator.push((random >> 16) as i32 * size >> 10);
    ///     }
    ///     accumulator
    /// };
    /// assert!(record(7, 1).is_like(&record(7, 2)));
    /// assert!(!record(7, 1).is_like(&record(10, 2)));
    /// ```
    pub fn is_like(&self, other: &Self) -> bool {
        self.read(0).is_like(&other.read(0))
    }

    /// Octave `k`, of averaging factor `2^k`, as it is now. What the schedule has put off is included,
    /// and the state stays as it is. `None` from `OCTAVES` on.
    pub fn octave(&self, k: usize) -> Option<OctaveSum> {
        (k < OCTAVES).then(|| self.read(k))
    }

    /// All octaves as they are now, shortest averaging time first.
    pub fn octaves(&self) -> impl Iterator<Item = OctaveSum> + '_ {
        (0..OCTAVES).map(|k| self.read(k))
    }

    pub(super) fn read(&self, k: usize) -> OctaveSum {
        let level = k.saturating_sub(FIRST);
        let served = self.levels.get(level).unwrap_or(&Level::EMPTY);
        let mut sum = match self.short.get(k) {
            Some(short) => *short,
            None => served.sum,
        };
        if let Some(difference) = self.pending_difference(k) {
            sum.add_square(difference);
        }
        // Past the largest sample number, the octaves that may leave out differences have counted the ones before.
        let position = match self.from.get(k) {
            Some(_) => self.number.into(),
            None => self.position(),
        };
        let running = self.running(k, position.wrapping_shr(level as u32));
        OctaveSum {
            m: 1_u32.wrapping_shl(k as u32),
            differences: self.counted(k).saturating_add(running),
            sum,
        }
    }

    /// The number of differences of octave `k` that end at block `block` or before, and are not yet counted.
    pub(super) fn running(&self, k: usize, block: u64) -> u64 {
        let first = u64::from(self.from(k)).wrapping_add(span(k).into());
        block.saturating_add(1).saturating_sub(first)
    }

    /// The difference of octave `k` that is complete and still waits for its turn in the schedule.
    pub(crate) fn pending_difference(&self, k: usize) -> Option<i64> {
        let level = k.saturating_sub(FIRST);
        let served = self.levels.get(level)?;
        let block = self.number.wrapping_shr(level as u32);
        if !self.is_pending(level) || block < self.from(k).wrapping_add(RING as u32) {
            return None;
        }
        let i = block as usize % RING;
        let [middle, oldest] = [served.ring[i ^ 4], served.ring[i]];
        Some(second_difference(self.boundary(level), middle, oldest))
    }

    pub(super) fn sum_mut(&mut self, k: usize) -> &mut SquareSum {
        let level = k.checked_sub(FIRST);
        match level.and_then(|level| self.levels.get_mut(level)) {
            Some(level) => &mut level.sum,
            None => &mut self.short[k % FIRST],
        }
    }

    /// The number of differences in the segments before the last gap.
    pub(super) fn counted(&self, k: usize) -> u64 {
        self.differences.get(k).copied().unwrap_or(0)
    }

    pub(super) fn set_counted(&mut self, k: usize, differences: u64) {
        if let Some(counted) = self.differences.get_mut(k) {
            *counted = differences;
        }
    }

    /// Whether the level's newest boundary still waits for its turn in the schedule.
    fn is_pending(&self, level: usize) -> bool {
        let below = level.checked_sub(1);
        below.is_some_and(|below| self.number.wrapping_shr(below as u32) & 1 == 0)
    }

    /// The angle at the level's newest block boundary, taken from the nearest level below that has it.
    fn boundary(&self, level: usize) -> u64 {
        let holder = (0..=level)
            .rev()
            .find(|&l| !self.is_pending(l))
            .unwrap_or(0);
        // While levels are pending, the boundary is also the newest one of the level below.
        let block = self.number.wrapping_shr(holder as u32) as usize;
        let held = self.levels.get(holder).unwrap_or(&Level::EMPTY);
        held.ring[block % RING]
    }
}
