//! The accumulator: it turns counts into one exact sum of squares per octave of averaging time.

pub(crate) mod bridge;
mod bridged;
mod read;
mod slice;
#[cfg(target_pointer_width = "64")]
mod wide;

pub use crate::record::square_sum::SquareSum;
pub use bridge::Filling;
pub use bridged::{Bridged, CLASSES};
use bridged::{TOUCHED, span};

/// The number of angles that a level keeps: those at the last eight block boundaries.
const RING: usize = 8;

/// The number of octaves below the first level. Averaging factors 1 and 2 are read from the ring of
/// factor 4.
const FIRST: usize = 2;

/// The value from which `number` goes on when it is exhausted.
const LAP: u32 = 1 << 31;

/// The sum of the counts of a record of which it is not known.
pub(crate) const UNKNOWN: i64 = i64::MIN;

/// The sum of two sums, which is not known if one of them is not.
const fn added(one: i64, other: i64) -> i64 {
    if one == UNKNOWN || other == UNKNOWN {
        UNKNOWN
    } else {
        one.wrapping_add(other)
    }
}

/// Watches the differences that an accumulator completes.
pub(crate) trait Observer {
    /// A difference of octave `octave` is complete.
    fn observe(&mut self, octave: usize, difference: i64);
}

/// Watches differences of which only the magnitudes are known where many are completed at once.
pub(crate) trait MagnitudeObserver: Observer {
    /// Differences of octave `octave` with these magnitudes, below 2^31, are complete.
    fn observe_magnitudes(&mut self, octave: usize, magnitudes: &[u32]);
}

/// The observer that ignores every difference.
impl Observer for () {
    #[inline(always)]
    fn observe(&mut self, _: usize, _: i64) {}
}

impl MagnitudeObserver for () {
    #[inline(always)]
    fn observe_magnitudes(&mut self, _: usize, _: &[u32]) {}
}

/// What is kept for one block length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Level {
    /// Angles at the last block boundaries, with boundary `b` in slot `b % RING`. The angles wrap
    /// modulo 2^64, their differences do not.
    ring: [u64; RING],
    sum: SquareSum,
}

impl Level {
    const EMPTY: Self = Self {
        ring: [0; RING],
        sum: SquareSum::ZERO,
    };

    /// Takes the angle at boundary `block`, and returns the difference that it completes. Differences start at boundary
    /// `from` or later.
    #[inline(always)]
    fn push(&mut self, block: u32, angle: u64, from: u32) -> Option<i64> {
        let i = block as usize % RING;
        let (oldest, middle) = (self.ring[i], self.ring[i ^ 4]);
        self.ring[i] = angle;
        if block < from.wrapping_add(RING as u32) {
            return None;
        }
        let difference = second_difference(angle, middle, oldest);
        self.sum.add_square(difference);
        Some(difference)
    }
}

/// An Allan accumulator with octave-spaced averaging times and quarter-overlapping differences, in
/// fixed memory. Octave `k` has the averaging factor `m = 2^k`, `k = 0 … OCTAVES − 1`.
///
/// The angle `θ_n` is the sum of the first `n` counts. Every octave sums the squares of
///
/// ```text
/// D_s = θ_{s+2m} − 2θ_{s+m} + θ_s,      s = 0, h, 2h, …,   h = max(1, m/4)
/// ```
///
/// From this sum follows `σ²(τ) = ½ mean D² / m²` in counts² (IEEE Std 952-1997, annex C). The overlap
/// is that of NIST SP 1065, 2008, eq. 11, thinned to a quarter of a cluster. This keeps 93 % of the
/// degrees of freedom on white noise, in constant memory.
///
/// # How it works
///
/// Level `L` keeps the angle at the last eight boundaries of blocks of `2^L` samples, and serves the
/// octave `m = 4 · 2^L`. Level 0 serves `m = 1` and `m = 2` as well. A level takes its new boundary
/// from the level below, half a block after the boundary was reached. So sample `n` updates level 0 and
/// exactly one other level, which the trailing zeros of `n` select. Ring positions, fill states and the
/// numbers of differences all follow from `n`.
///
/// # Cost
///
/// The accumulator uses integers only: a constant offset cancels exactly, host and target agree to the
/// bit, and the order in which records are [merged](Self::merge) does not matter.
///
/// On a Cortex-M4F [`push`](Self::push) takes 144 instructions per sample, whatever the number of
/// octaves and the position in the schedule, as long as no difference exceeds 31 bits. It takes at most
/// 270 with full-scale input. [`push_slice`](Self::push_slice) takes 116, built for size. The state
/// takes `176 + 96 · OCTAVES` bytes, which is 2480 for 24 octaves. `cargo xtask bench` measures this.
///
/// # Example
///
/// ```
/// use allanite::Accumulator;
///
/// let mut accumulator = Accumulator::<10>::new();
/// accumulator.push_slice(&[3, 1, -2, 4, 0, 7, 2, 2]);
/// accumulator.push(5);
/// // Nine counts have eight differences of neighbours.
/// assert_eq!(accumulator.octave(0).unwrap().differences, 8);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
// The fields are in this order so that what every sample touches lies at the same place for any
// `OCTAVES`.
#[repr(C)]
pub struct Accumulator<const OCTAVES: usize> {
    /// Samples since the last gap, as far as the schedule needs them. Past 2^32 the number goes on from
    /// 2^31, which has the same remainders.
    number: u32,
    /// How often `number` went on from 2^31.
    laps: u32,
    /// The sample number from which on a full ring has nothing to leave out in the octaves of level 0, less the ring's
    /// length.
    late: u32,
    /// For the octaves that leave out differences across short gaps, the block from which on their differences start.
    from: [u32; TOUCHED],
    /// The present angle, in counts.
    angle: u64,
    /// Sums of the octaves below the first level.
    short: [SquareSum; FIRST],
    /// Level `L` serves octave `L + FIRST`. The last `FIRST` levels are not used.
    levels: [Level; OCTAVES],
    /// The number of differences in the segments before the last gap.
    differences: [u64; OCTAVES],
    /// The number of samples in the segments before the last gap.
    earlier_samples: u64,
    /// The sum of the counts and of the filled values in the segments before the last gap, or [`UNKNOWN`].
    earlier_angle: i64,
    gaps: u64,
    /// The number of filled values since the last gap.
    filled: u32,
    /// What rounding left of the filled values.
    rest: u32,
    bridged: Bridged,
}

/// What the accumulator knows about one octave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OctaveSum {
    /// Averaging factor: samples in a cluster.
    pub m: u32,
    /// The number of differences of adjacent clusters that were summed.
    pub differences: u64,
    /// The sum Σ D², in counts².
    pub sum: SquareSum,
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// The proof that no input overflows, which the compiler checks where the type is used: a
    /// difference fits `i64`. [`SquareSum`] bounds the sums. An Allan curve needs at least two octaves.
    const BOUNDS: () = {
        assert!(OCTAVES >= 2, "an Allan curve needs two octaves or more");
        assert!(
            OCTAVES <= 30,
            "an accumulator has at most 30 octaves, so that nothing overflows"
        );
        // |D| ≤ m (2^32 − 1) < 2^(OCTAVES − 1 + 32), two bits below i64's sign.
        assert!(OCTAVES - 1 + 32 < 62 + 1);
    };

    /// An empty accumulator.
    pub const fn new() -> Self {
        const { Self::BOUNDS };
        Self {
            number: 0,
            laps: 0,
            late: 0,
            from: [0; TOUCHED],
            angle: 0,
            short: [SquareSum::ZERO; FIRST],
            levels: [Level::EMPTY; OCTAVES],
            differences: [0; OCTAVES],
            earlier_samples: 0,
            earlier_angle: 0,
            gaps: 0,
            filled: 0,
            rest: 0,
            bridged: Bridged::NONE,
        }
    }

    /// Adds one count.
    #[inline]
    pub fn push(&mut self, count: i32) {
        self.push_observed(count, &mut ());
    }

    /// Adds one count, and shows an observer every difference that the count completes: one in each of
    /// the octaves 0, 1 and 2, and one in at most one other octave. Accumulators that take the same
    /// samples and gaps complete the same octaves at the same sample, so that their differences can be
    /// multiplied.
    #[inline(always)]
    pub(crate) fn push_observed(&mut self, count: i32, observer: &mut impl Observer) {
        let n = self.next_number();
        let i = n as usize % RING;
        let before = self.angle;
        let angle = before.wrapping_add_signed(i64::from(count));
        self.angle = angle;

        let base = &mut self.levels[0];
        let two_before = base.ring[i.wrapping_sub(2) % RING];
        if n >= self.late.wrapping_add(RING as u32) {
            let difference = second_difference(angle, before, two_before);
            self.short[0].add_square(difference);
            observer.observe(0, difference);
            let four_before = base.ring[i ^ 4];
            let difference = second_difference(angle, two_before, four_before);
            self.short[1].add_square(difference);
            observer.observe(1, difference);
            if OCTAVES > FIRST {
                let eight_before = base.ring[i];
                let difference = second_difference(angle, four_before, eight_before);
                base.sum.add_square(difference);
                observer.observe(FIRST, difference);
            }
            base.ring[i] = angle;
        } else {
            self.push_early(before, two_before, observer);
        }
        if let Some((octave, difference)) = self.complete_scheduled(n) {
            observer.observe(octave, difference);
        }
    }

    /// Does the work of [`push`](Self::push) while the ring is not yet full or holds filled values, and checks which
    /// differences exist.
    #[cold]
    #[inline(never)]
    fn push_early(&mut self, before: u64, two_before: u64, observer: &mut impl Observer) {
        let angle = self.angle;
        let i = self.number as usize % RING;
        let base = &mut self.levels[0];
        let (four_before, eight_before) = (base.ring[i ^ 4], base.ring[i]);
        base.ring[i] = angle;
        if self.exists(0) {
            let difference = second_difference(angle, before, two_before);
            self.short[0].add_square(difference);
            observer.observe(0, difference);
        }
        if self.exists(1) {
            let difference = second_difference(angle, two_before, four_before);
            self.short[1].add_square(difference);
            observer.observe(1, difference);
        }
        if OCTAVES > FIRST && self.exists(FIRST) {
            let difference = second_difference(angle, four_before, eight_before);
            self.levels[0].sum.add_square(difference);
            observer.observe(FIRST, difference);
        }
    }

    /// Whether the present sample completes a difference of an octave of level 0.
    fn exists(&self, k: usize) -> bool {
        self.number >= self.from(k).wrapping_add(span(k))
    }

    #[inline(always)]
    fn next_number(&mut self) -> u32 {
        let next = self.number.wrapping_add(1);
        self.number = next;
        if next == 0 { self.lap() } else { next }
    }

    #[cold]
    #[inline(never)]
    fn lap(&mut self) -> u32 {
        self.lap_touched();
        self.laps = self.laps.wrapping_add(1);
        self.number = LAP;
        LAP
    }

    /// Updates the one level above 0 whose turn it is at sample `n`. Level `L` has its turn half a
    /// block after each of its block boundaries, when level `L − 1` has long passed them. Returns the
    /// level's octave and the difference that this completes.
    #[inline(always)]
    fn complete_scheduled(&mut self, n: u32) -> Option<(usize, i64)> {
        let level = n.trailing_zeros() as usize + 1;
        if level + FIRST >= OCTAVES {
            return None;
        }
        // The boundary lies at n − 2^(level−1). These are its number at this level and its angle at the
        // one below.
        let block = n >> level;
        let new = self.levels[level - 1].ring[(2 * block) as usize % RING];
        let from = self.from(level + FIRST);
        let difference = self.levels[level].push(block, new, from)?;
        Some((level + FIRST, difference))
    }

    /// Marks a place where samples were lost or the gyro was disturbed. No difference spans this place.
    /// What was summed stays. A call passes over all octaves once.
    pub fn gap(&mut self) {
        if self.number == 0 {
            return;
        }
        for k in 0..OCTAVES {
            let octave = self.read(k);
            *self.sum_mut(k) = octave.sum;
            self.set_counted(k, octave.differences);
        }
        self.earlier_angle = self.total();
        self.earlier_samples = self.samples();
        self.number = 0;
        self.laps = 0;
        (self.late, self.from) = (0, [0; TOUCHED]);
        (self.filled, self.rest) = (0, 0);
        self.angle = 0;
        for level in &mut self.levels {
            level.ring = Level::EMPTY.ring;
        }
        self.gaps = self.gaps.saturating_add(1);
    }

    /// Adds another record of the same sensor, as if a gap lay between the two. [`is_like`](Self::is_like)
    /// checks whether it can be one.
    pub fn merge(&mut self, other: &Self) {
        if other.samples() == 0 {
            return;
        }
        self.gap();
        for k in 0..OCTAVES {
            let octave = other.read(k);
            self.sum_mut(k).add_sum(&octave.sum);
            let counted = self.counted(k).saturating_add(octave.differences);
            self.set_counted(k, counted);
        }
        self.earlier_angle = added(self.earlier_angle, other.total());
        self.earlier_samples = self.earlier_samples.saturating_add(other.samples());
        self.bridged.merge(&other.bridged);
        let ends = other.gaps.saturating_add(u64::from(other.number > 0));
        self.gaps = self.gaps.saturating_add(ends);
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// The number of samples so far, without those that were lost.
    pub const fn samples(&self) -> u64 {
        let running = self.position().saturating_sub(self.filled as u64);
        self.earlier_samples.saturating_add(running)
    }

    /// Sets the sum of all counts and filled values of a record that was rebuilt.
    #[cfg(feature = "storage")]
    pub(crate) const fn set_total(&mut self, total: i64) {
        self.earlier_angle = total;
    }

    /// The sum of all counts and filled values, or [`UNKNOWN`].
    pub(crate) const fn total(&self) -> i64 {
        added(self.earlier_angle, self.angle as i64)
    }

    /// The sum and the number of all counts and filled values; `None` without samples, for 2³² samples and more, whose sum may
    /// exceed 64 bits, and for a record from a snapshot that does not hold it.
    pub(crate) fn summed(&self) -> Option<(i64, u32)> {
        let values = self.samples().saturating_add(self.bridged.lost());
        let values = u32::try_from(values).ok().filter(|&values| values > 0)?;
        Some((self.total(), values)).filter(|&(total, _)| total != UNKNOWN)
    }

    /// The number of samples and filled values since the last gap.
    const fn position(&self) -> u64 {
        self.number as u64 + ((self.laps as u64) << 31)
    }

    /// The number of contiguous stretches that have ended so far. A call of [`gap`](Self::gap) ends a
    /// stretch if there were samples before it, and so does every merged record.
    pub const fn gaps(&self) -> u64 {
        self.gaps
    }

    /// The number of [`gaps`](Self::gaps) that there would be after a gap at this moment.
    #[cfg(feature = "storage")]
    pub(crate) fn ended_gaps(&self) -> u64 {
        self.gaps.saturating_add(u64::from(self.number > 0))
    }

    /// The state after a gap, rebuilt from what was read of it.
    #[cfg(feature = "storage")]
    pub(crate) fn ended(
        (samples, total): (u64, i64),
        gaps: u64,
        octaves: impl IntoIterator<Item = OctaveSum>,
    ) -> Self {
        let mut accumulator = Self::new();
        for (k, octave) in octaves.into_iter().take(OCTAVES).enumerate() {
            *accumulator.sum_mut(k) = octave.sum;
            accumulator.set_counted(k, octave.differences);
        }
        accumulator.earlier_samples = samples;
        accumulator.earlier_angle = total;
        accumulator.gaps = gaps;
        accumulator
    }
}

impl<const OCTAVES: usize> Default for Accumulator<OCTAVES> {
    fn default() -> Self {
        Self::new()
    }
}

/// `newest − 2 middle + oldest`, which is the difference of two adjacent cluster sums. It is exact
/// although the angles wrap.
#[inline(always)]
fn second_difference(newest: u64, middle: u64, oldest: u64) -> i64 {
    newest
        .wrapping_sub(middle)
        .wrapping_sub(middle.wrapping_sub(oldest)) as i64
}
