//! The bulk path of the accumulator: it takes many counts at once and leads to the same state.

use super::{Accumulator, FIRST, MagnitudeObserver, RING};

/// The number of counts that are taken together.
pub(super) const BATCH: usize = 128;

/// The number of levels above 0 that complete blocks within a batch.
pub(super) const DEPTH: usize = BATCH.trailing_zeros() as usize;

/// The sample number from which on every level up to [`DEPTH`] has a full ring.
const FULL: u32 = (RING * BATCH) as u32;

/// The span of a window of angles. Within it, second differences are below 2^28 in magnitude, which 32
/// bits hold, and their squares add up to at most 2^63 in a batch.
const SPAN: u64 = 1 << 27;

/// Angles relative to a common base. Eight older ones come first, those of the batch follow.
type Offsets = [u32; RING + BATCH];

impl<const OCTAVES: usize> Accumulator<OCTAVES> {
    /// Adds counts. The state afterwards is the same as if they were pushed one by one, but it is
    /// reached sooner.
    pub fn push_slice(&mut self, counts: &[i32]) {
        self.push_slice_observed(counts, &mut ());
    }

    /// Adds counts, and shows an observer every difference that they complete, in any order.
    #[inline(always)]
    pub(crate) fn push_slice_observed(
        &mut self,
        counts: &[i32],
        observer: &mut impl MagnitudeObserver,
    ) {
        let mut rest = counts;
        let mut is_far = false;
        while !rest.is_empty() {
            let past = self.number as usize % BATCH;
            let ready = past == 0 && self.number >= FULL && self.number < u32::MAX - FULL;
            if ready
                && self.is_clear()
                && let Some((batch, after)) = rest.split_first_chunk()
                && self.push_any_batch(batch, &mut is_far, observer)
            {
                rest = after;
            } else {
                let (head, after) = rest.split_at(rest.len().min(BATCH - past));
                for &count in head {
                    self.push_observed(count, observer);
                }
                rest = after;
            }
        }
    }

    /// Adds a batch at a sample number that is a multiple of the batch's length and at least [`FULL`].
    /// If the angles are too far apart for 32 bits, it does nothing and returns `false`.
    fn push_batch(&mut self, counts: &[i32; BATCH], observer: &mut impl MagnitudeObserver) -> bool {
        let n = self.number;
        let base = self.angle.wrapping_sub(SPAN / 2);
        let mut offsets = [0; RING + BATCH];
        let mut bits = self.recall(0, n + 1, base, &mut offsets);
        let mut distance = SPAN / 2;
        for (offset, &count) in offsets[RING..].iter_mut().zip(counts) {
            distance = distance.wrapping_add_signed(i64::from(count));
            bits |= distance;
            *offset = distance as u32;
        }
        if bits >= SPAN {
            return false;
        }

        self.angle = base.wrapping_add(distance);
        self.number = n + BATCH as u32;
        self.short[0].add_low(squares::<1, BATCH>(&offsets, 0, observer));
        self.short[1].add_low(squares::<2, BATCH>(&offsets, 1, observer));
        if OCTAVES > FIRST {
            let squares = squares::<4, BATCH>(&offsets, FIRST, observer);
            self.levels[0].sum.add_low(squares);
        }
        self.store::<BATCH>(0, n + 1, base, &offsets);

        // Level 1 and those above still wait for the boundary at n, which is the last of the older
        // ones. They leave the last boundary of the batch to their next turn.
        self.take::<{ BATCH >> 1 }>((1, n), base, (&mut offsets, RING - 1), observer);
        self.take::<{ BATCH >> 2 }>((2, n), base, (&mut offsets, RING), observer);
        self.take::<{ BATCH >> 3 }>((3, n), base, (&mut offsets, RING), observer);
        self.take::<{ BATCH >> 4 }>((4, n), base, (&mut offsets, RING), observer);
        for level in 5..=DEPTH {
            if level + FIRST < OCTAVES
                && let Some(own) = self.levels.get_mut(level)
            {
                let boundaries = offsets[RING..RING + (BATCH >> 4)].iter();
                for (block, &offset) in
                    (n >> level..u32::MAX).zip(boundaries.step_by(1 << (level - 4)))
                {
                    let difference = own.push(block, base.wrapping_add(u64::from(offset)), 0);
                    if let Some(difference) = difference {
                        observer.observe(level + FIRST, difference);
                    }
                }
            }
        }
        self.observe_scheduled(observer);
        true
    }

    /// Adds a batch in the way that suits it. If none does, it does nothing and returns `false`. `is_far` says whether
    /// the last batch had angles that are too far apart for 32 bits, so that this one probably has them, too.
    #[inline(always)]
    fn push_any_batch(
        &mut self,
        counts: &[i32; BATCH],
        is_far: &mut bool,
        observer: &mut impl MagnitudeObserver,
    ) -> bool {
        if !*is_far && self.push_batch(counts, observer) {
            return true;
        }
        #[cfg(target_pointer_width = "64")]
        {
            *is_far = self.push_wide_batch(counts, observer);
        }
        *is_far
    }

    /// Hands the level `COUNT` boundaries: every other one of those that the level below took.
    #[inline(always)]
    fn take<const COUNT: usize>(
        &mut self,
        (level, n): (usize, u32),
        base: u64,
        (offsets, from): (&mut Offsets, usize),
        observer: &mut impl MagnitudeObserver,
    ) {
        for j in 0..COUNT {
            offsets[RING + j] = offsets[from + 2 * j];
        }
        if level + FIRST >= OCTAVES {
            return;
        }
        let block = n >> level;
        if self.recall(level, block, base, offsets) < SPAN {
            let squares = squares::<4, COUNT>(offsets, level + FIRST, observer);
            self.levels[level].sum.add_low(squares);
            self.store::<COUNT>(level, block, base, offsets);
        } else {
            for (block, &offset) in (block..).zip(&offsets[RING..RING + COUNT]) {
                let angle = base.wrapping_add(u64::from(offset));
                if let Some(difference) = self.levels[level].push(block, angle, 0) {
                    observer.observe(level + FIRST, difference);
                }
            }
        }
    }

    /// Updates the level whose turn it is at the end of a batch.
    #[inline(always)]
    pub(super) fn observe_scheduled(&mut self, observer: &mut impl MagnitudeObserver) {
        if let Some((octave, difference)) = self.complete_scheduled(self.number) {
            observer.observe(octave, difference);
        }
    }

    /// Puts the boundaries before `block`, which the level's ring holds, in front of the offsets.
    /// Returns all bits that are set in any of their distances from the base.
    #[inline(always)]
    fn recall(&self, level: usize, block: u32, base: u64, offsets: &mut Offsets) -> u64 {
        let mut bits = 0;
        for (offset, b) in offsets[..RING].iter_mut().zip(block..) {
            let distance = self.levels[level].ring[b as usize % RING].wrapping_sub(base);
            bits |= distance;
            *offset = distance as u32;
        }
        bits
    }

    /// Puts the last of `COUNT` new boundaries into the level's ring. The first of the new boundaries
    /// is `block`.
    #[inline(always)]
    fn store<const COUNT: usize>(
        &mut self,
        level: usize,
        block: u32,
        base: u64,
        offsets: &Offsets,
    ) {
        const { assert!(COUNT.is_multiple_of(RING)) };
        for (b, &offset) in (block..).zip(&offsets[COUNT..COUNT + RING]) {
            self.levels[level].ring[b as usize % RING] = base.wrapping_add(u64::from(offset));
        }
    }
}

/// The sum of squared second differences at distance `LAG`, over the `COUNT` angles after the older
/// ones.
#[inline(always)]
fn squares<const LAG: usize, const COUNT: usize>(
    offsets: &Offsets,
    octave: usize,
    observer: &mut impl MagnitudeObserver,
) -> u64 {
    let mut magnitudes = [0; COUNT];
    for (j, magnitude) in magnitudes.iter_mut().enumerate() {
        let i = RING + j;
        let middle = offsets[i - LAG];
        let newest = offsets[i].wrapping_sub(middle);
        let oldest = middle.wrapping_sub(offsets[i - 2 * LAG]);
        *magnitude = (newest.wrapping_sub(oldest) as i32).unsigned_abs();
    }
    observer.observe_magnitudes(octave, &magnitudes);
    sum_of_squares(&magnitudes)
}

/// This is not inlined: a compiler that knows the length unrolls the loop instead of vectorising it.
#[inline(never)]
fn sum_of_squares(magnitudes: &[u32]) -> u64 {
    let square = |&magnitude: &u32| u64::from(magnitude) * u64::from(magnitude);
    // The sum stays below 2^63, as [`SPAN`] says.
    magnitudes.iter().map(square).fold(0, u64::wrapping_add)
}
