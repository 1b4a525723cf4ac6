//! Batches of counts whose angles are too far apart for 32 bits, such as floats that were rounded far below their noise.
//!
//! The angles are kept in two halves, so that a vector holds four of them. The lower half is enough for a second
//! difference within ±2^31, and the upper half shows whether it is.

use super::{
    Accumulator, FIRST, MagnitudeObserver, RING,
    slice::{BATCH, DEPTH},
};
use crate::record::square_sum::SquareSum;

/// The number of bits by which the upper halves are shifted. The angles of a batch and the older ones that levels up to
/// 4 keep lie within 2^38 of each other, so that differences of the upper halves have 31 bits.
const SHIFT: u32 = 10;

/// Angles relative to a common base. Eight older ones come first, those of the batch follow.
struct Offsets {
    lower: [u32; RING + BATCH],
    upper: [i32; RING + BATCH],
}

impl Offsets {
    #[inline(always)]
    fn set(&mut self, i: usize, offset: i64) {
        self.lower[i] = offset as u32;
        self.upper[i] = (offset >> SHIFT) as i32;
    }

    #[inline(always)]
    fn get(&self, i: usize) -> i64 {
        const MASK: u32 = (1 << SHIFT) - 1;
        i64::from(self.upper[i]) << SHIFT | i64::from(self.lower[i] & MASK)
    }

    /// The sum of squared second differences at distance `LAG`, over the `COUNT` angles after the older ones; `None` if
    /// one of them may be beyond ±2^31.
    #[inline(always)]
    fn squares<const LAG: usize, const COUNT: usize>(
        &self,
        magnitudes: &mut [u32; COUNT],
    ) -> Option<u128> {
        let mut bits = 0;
        for (j, magnitude) in magnitudes.iter_mut().enumerate() {
            let i = RING + j;
            let [newest, middle, oldest] = [i, i - LAG, i - 2 * LAG].map(|i| self.lower[i]);
            let newest = newest.wrapping_sub(middle);
            let difference = newest.wrapping_sub(middle.wrapping_sub(oldest)) as i32;
            *magnitude = difference.unsigned_abs();
            let [newest, middle, oldest] = [i, i - LAG, i - 2 * LAG].map(|i| self.upper[i]);
            let newest = newest.wrapping_sub(middle);
            let upper = newest.wrapping_sub(middle.wrapping_sub(oldest));
            // Rounding makes this differ from the upper half of the difference by less than 2.
            bits |= (upper ^ (upper >> 31)).wrapping_add(3);
        }
        (bits < 1 << (31 - SHIFT)).then(|| sum_of_squares(magnitudes))
    }
}

/// The sum of squares of numbers below 2^31, of which there are a multiple of four.
#[inline(never)]
fn sum_of_squares(magnitudes: &[u32]) -> u128 {
    let (half, other_half) = magnitudes.split_at(magnitudes.len() / 2);
    let (a, b) = half.split_at(half.len() / 2);
    let (c, d) = other_half.split_at(half.len() / 2);
    let square = |&magnitude: &u32| u64::from(magnitude) * u64::from(magnitude);
    let (mut lower, mut upper) = (0_u64, 0_u64);
    for (((a, b), c), d) in a.iter().zip(b).zip(c).zip(d) {
        // Four squares have 64 bits. The sum of more of them may have more, so that its halves are added apart.
        let [one, other] = [square(a) + square(b), square(c) + square(d)];
        let squares = one.wrapping_add(other);
        lower = lower.wrapping_add(squares & 0xFFFF_FFFF);
        upper = upper.wrapping_add(squares >> 32);
    }
    (u128::from(upper) << 32).wrapping_add(lower.into())
}

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// Adds a batch as `push_batch` does. If differences at the lowest distances are beyond 32 bits, it does nothing and
    /// returns `false`.
    #[inline(never)]
    pub(super) fn push_wide_batch(
        &mut self,
        counts: &[i32; BATCH],
        observer: &mut impl MagnitudeObserver,
    ) -> bool {
        let n = self.number;
        let base = self.angle;
        let mut offsets = Offsets {
            lower: [0; RING + BATCH],
            upper: [0; RING + BATCH],
        };
        // The angle at n is in slot 0 already, and the oldest one behind it.
        self.recall_wide::<1>(0, base, &mut offsets);
        let mut distance = 0_i64;
        for (j, &count) in counts.iter().enumerate() {
            distance = distance.wrapping_add(count.into());
            offsets.set(RING + j, distance);
        }
        let mut magnitudes = [[0; BATCH]; FIRST + 1];
        let [one, two, four] = &mut magnitudes;
        let squares = [
            offsets.squares::<1, BATCH>(one),
            offsets.squares::<2, BATCH>(two),
            offsets.squares::<4, BATCH>(four),
        ];
        let [Some(single), Some(double), Some(fourfold)] = squares else {
            return false;
        };
        for (octave, magnitudes) in magnitudes.iter().enumerate().take(OCTAVES) {
            observer.observe_magnitudes(octave, magnitudes);
        }
        self.angle = base.wrapping_add_signed(distance);
        self.number = n + BATCH as u32;
        self.short[0].add_sum(&SquareSum::from(single));
        self.short[1].add_sum(&SquareSum::from(double));
        if OCTAVES > FIRST {
            self.levels[0].sum.add_sum(&SquareSum::from(fourfold));
        }
        self.store_wide::<1, BATCH>(0, base, &offsets);

        // As in `push_batch`.
        self.take_wide::<{ BATCH >> 1 }>((1, n), base, (&mut offsets, RING - 1), observer);
        self.take_wide::<{ BATCH >> 2 }>((2, n), base, (&mut offsets, RING), observer);
        self.take_wide::<{ BATCH >> 3 }>((3, n), base, (&mut offsets, RING), observer);
        self.take_wide::<{ BATCH >> 4 }>((4, n), base, (&mut offsets, RING), observer);
        for level in 5..=DEPTH {
            if level + FIRST < OCTAVES
                && let Some(own) = self.levels.get_mut(level)
            {
                let boundaries = (RING..RING + (BATCH >> 4)).step_by(1 << (level - 4));
                for (block, i) in (n >> level..u32::MAX).zip(boundaries) {
                    let difference = own.push(block, base.wrapping_add_signed(offsets.get(i)), 0);
                    if let Some(difference) = difference {
                        observer.observe(level + FIRST, difference);
                    }
                }
            }
        }
        self.observe_scheduled(observer);
        true
    }

    /// Hands the level `COUNT` boundaries: every other one of those that the level below took.
    #[inline(always)]
    fn take_wide<const COUNT: usize>(
        &mut self,
        (level, n): (usize, u32),
        base: u64,
        (offsets, from): (&mut Offsets, usize),
        observer: &mut impl MagnitudeObserver,
    ) {
        for j in 0..COUNT {
            offsets.lower[RING + j] = offsets.lower[from + 2 * j];
            offsets.upper[RING + j] = offsets.upper[from + 2 * j];
        }
        if level + FIRST >= OCTAVES {
            return;
        }
        let block = n >> level;
        self.recall_wide::<0>(level, base, offsets);
        let mut magnitudes = [0; COUNT];
        if let Some(squares) = offsets.squares::<4, COUNT>(&mut magnitudes) {
            observer.observe_magnitudes(level + FIRST, &magnitudes);
            self.levels[level].sum.add_sum(&SquareSum::from(squares));
            self.store_wide::<0, COUNT>(level, base, offsets);
        } else {
            for (block, i) in (block..).zip(RING..RING + COUNT) {
                let angle = base.wrapping_add_signed(offsets.get(i));
                if let Some(difference) = self.levels[level].push(block, angle, 0) {
                    observer.observe(level + FIRST, difference);
                }
            }
        }
    }

    /// Puts the boundaries that the level's ring holds in front of the offsets. The oldest one is in slot `OLDEST`, which
    /// is known because a batch begins at a multiple of its length.
    #[inline(always)]
    fn recall_wide<const OLDEST: usize>(&self, level: usize, base: u64, offsets: &mut Offsets) {
        for i in 0..RING {
            let distance = self.levels[level].ring[(OLDEST + i) % RING].wrapping_sub(base);
            offsets.set(i, distance as i64);
        }
    }

    /// Puts the last of `COUNT` new boundaries into the level's ring.
    #[inline(always)]
    fn store_wide<const OLDEST: usize, const COUNT: usize>(
        &mut self,
        level: usize,
        base: u64,
        offsets: &Offsets,
    ) {
        const { assert!(COUNT.is_multiple_of(RING)) };
        for i in 0..RING {
            self.levels[level].ring[(OLDEST + i) % RING] =
                base.wrapping_add_signed(offsets.get(COUNT + i));
        }
    }
}
