//! The accumulator: it turns counts into one sum of powers per bin.

#[cfg(target_pointer_width = "64")]
use super::several::Several;
use super::{
    level::{Level, RADIX, RADIX_BITS},
    window::is_possible,
};

/// Sums the power spectral densities of a record, in fixed memory: `LEVELS` levels of segments of `P` blocks.
/// Level `i` takes blocks of `8^i` samples. The [module](super) gives the definition.
///
/// `P` is a power of two from 32 to 256. A target takes 64, so that each level has 28 bins.
///
/// # Two halves of the work
///
/// [`push`](Self::push) only stores a count, which suits an interrupt. [`advance`](Self::advance) does the
/// rest in the main loop: one call transforms at most one segment. The accumulator holds `P` counts until they
/// are worked on, so a main loop that calls `advance` until it returns `false` has to do so every `P` samples.
///
/// If it is late, the counts that find no room are left out, and [`lost`](Self::lost) is their number. The
/// place is treated as a [`gap`](Self::gap): no segment spans it, and the sums stay right. A gap ends a segment
/// at every level, so each loss costs the highest levels most. A few samples of known number that were lost before
/// they came here need no gap: go on with the values that [fill](crate::Accumulator::filling) their place, and
/// take off [what these change](super::Spectrum::without_bridges).
///
/// # How it works
///
/// Blocks are sums of integers, less the first count of the stretch. The first block of a segment is subtracted
/// from the others before they become floats. So a constant offset cancels exactly, and host and target agree
/// to the bit. Sums of blocks keep all their bits up to a range of 2^30 counts. Beyond it, the level drops the
/// lowest bits of its blocks, so that any input fits.
///
/// The sums are in single precision. From 2^20 segments on, where a bin scatters by 0.1 %, a level halves
/// its sums and their number: what came earlier then weighs less than what comes later, but no sum grows until
/// it takes up nothing more.
///
/// # Cost
///
/// The state takes `32 + 4 P + (8 P + 8) LEVELS` bytes, which is 3928 for `P = 64` and 7 levels. An empty
/// state is all zero, so that a `static` is placed in `.bss`.
///
/// # Example
///
/// ```
/// use allanite::{Scale, spectrum::{Spectrum, SpectrumAccumulator}};
///
/// let mut accumulator = SpectrumAccumulator::<64, 3>::new();
/// let mut random = 1_u32;
/// for _ in 0..10_000 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     accumulator.push((random >> 24) as i32); // in the interrupt
///     while accumulator.advance() {} // in the main loop
/// }
/// let spectrum: Spectrum<84> = accumulator.spectrum(Scale::new(1.0, 100.0)?);
/// // The third level has not yet the 16 segments that it needs.
/// assert_eq!(spectrum.bins().len(), 2 * 28);
/// // White noise of the variance 256²/12, over 50 Hz.
/// let bins = spectrum.bins().iter();
/// let mean = bins.map(|bin| bin.density).sum::<allanite::Real>() / 56.0;
/// assert!((mean / (256.0 * 256.0 / 12.0 / 50.0) - 1.0).abs() < 0.1);
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumAccumulator<const P: usize, const LEVELS: usize> {
    /// The samples since the last gap that were worked on.
    number: u64,
    /// The samples that found no room.
    lost: u64,
    /// The counts that wait to be worked on: `waiting` of them, from the slot `taken` on.
    counts: [i32; P],
    waiting: u32,
    taken: u32,
    /// The first count since the last gap.
    reference: i32,
    /// Bit `i` tells that level `i` has a segment to transform.
    due: u16,
    /// Whether samples were lost after those that wait.
    is_late: bool,
    levels: [Level<P>; LEVELS],
}

impl<const P: usize, const LEVELS: usize> SpectrumAccumulator<P, LEVELS> {
    /// The proof that no input overflows, which the compiler checks where the type is used.
    const BOUNDS: () = {
        assert!(
            is_possible(P),
            "the length of a segment is a power of two from 32 to 256"
        );
        assert!(LEVELS >= 1, "a spectrum needs a level");
        // A sum of counts, less the reference, is below 8^9 · 2^32 = 2^59.
        assert!(
            LEVELS <= 10,
            "a spectrum has at most 10 levels, so that nothing overflows"
        );
    };

    /// An empty accumulator.
    pub const fn new() -> Self {
        const { Self::BOUNDS };
        Self {
            number: 0,
            lost: 0,
            counts: [0; P],
            waiting: 0,
            taken: 0,
            reference: 0,
            due: 0,
            is_late: false,
            levels: [Level::EMPTY; LEVELS],
        }
    }

    /// Stores one count for [`advance`](Self::advance). If there is no room, the count is [`lost`](Self::lost).
    #[inline]
    pub fn push(&mut self, count: i32) {
        let waiting = self.waiting;
        if waiting >= P as u32 || self.is_late {
            self.lose();
            return;
        }
        self.counts[self.taken.wrapping_add(waiting) as usize % P] = count;
        self.waiting = waiting.wrapping_add(1);
    }

    #[cold]
    #[inline(never)]
    fn lose(&mut self) {
        // What comes later must not join what came earlier. So nothing is stored until the gap is made.
        self.is_late = true;
        self.lost = self.lost.saturating_add(1);
    }

    /// Adds counts, and does all the work of them and of those that wait. None is lost.
    pub fn push_slice(&mut self, counts: &[i32]) {
        self.finish();
        #[cfg(target_pointer_width = "64")]
        let mut waiting = None;
        let mut rest = counts;
        while let Some(&first) = rest.first() {
            if self.number == 0 {
                self.reference = first;
            }
            // Up to the end of a block of the second level, as in `take`.
            let (reference, number) = (self.reference, self.number as u32);
            let room = (RADIX as u32).wrapping_sub(number % RADIX as u32) as usize;
            let (taken, after) = rest.split_at(room.min(rest.len()));
            if let Some(lowest) = self.levels.first_mut() {
                lowest.push_counts(number, taken, reference);
            }
            self.number = self.number.wrapping_add(taken.len() as u64);
            if taken.len() == room {
                self.complete();
                #[cfg(target_pointer_width = "64")]
                while let Some((level, block_bits, end)) = self.next_due() {
                    let several = waiting.get_or_insert_with(Several::new);
                    several.push(&mut self.levels, level, block_bits, end);
                }
                #[cfg(not(target_pointer_width = "64"))]
                while self.due != 0 {
                    self.transform();
                }
            }
            rest = after;
        }
        #[cfg(target_pointer_width = "64")]
        if let Some(several) = &mut waiting {
            several.finish(&mut self.levels);
        }
        self.pass_by(counts);
    }

    /// Leaves the room for counts as if these had waited in it.
    fn pass_by(&mut self, counts: &[i32]) {
        let (skipped, last) = counts.split_at(counts.len().saturating_sub(P));
        let first = (self.taken as usize).wrapping_add(skipped.len());
        for (i, &count) in (first..usize::MAX).zip(last) {
            self.counts[i % P] = count;
        }
        self.taken = (first.wrapping_add(last.len()) % P) as u32;
    }

    /// Does a part of the pending work, and returns whether there is more. A call transforms at most one
    /// segment.
    pub fn advance(&mut self) -> bool {
        while self.due == 0 && self.waiting > 0 {
            self.take();
        }
        if self.waiting == 0 && self.is_late && self.due == 0 {
            self.is_late = false;
            self.end();
        }
        if self.due == 0 {
            return false;
        }
        self.transform();
        self.due > 0 || self.waiting > 0 || self.is_late
    }

    /// Does all the work that waits.
    fn finish(&mut self) {
        while self.advance() {}
    }

    /// Takes counts that wait, up to the end of a block of the second level, into the blocks of every level. At least
    /// one count waits, and no segment.
    // Several counts at once, because what has to be decided for each of them costs more than to keep it.
    #[inline]
    fn take(&mut self) {
        let from = self.taken;
        if self.number == 0 {
            self.reference = self.counts[from as usize % P];
        }
        let (reference, number) = (self.reference, self.number as u32);
        let room = (RADIX as u32).wrapping_sub(number % RADIX as u32);
        let taken = self.waiting.min(room);
        if let Some(lowest) = self.levels.first_mut() {
            for i in 0..taken {
                let count = self.counts[from.wrapping_add(i) as usize % P];
                lowest.push_count(number.wrapping_add(i), count, reference);
            }
        }
        self.taken = from.wrapping_add(taken) % P as u32;
        self.waiting = self.waiting.wrapping_sub(taken);
        self.number = self.number.wrapping_add(u64::from(taken));
        if taken == room {
            self.complete();
        }
    }

    /// Makes the blocks of the higher levels that end with the last count, and notes the segments that do.
    #[inline]
    fn complete(&mut self) {
        let Some((mut level, higher)) = self.levels.split_first_mut() else {
            return;
        };
        let ends_segment = |blocks: u64| blocks.is_multiple_of(P as u64 / 2) && blocks >= P as u64;
        let mut blocks = self.number;
        let mut level_bit = 1_u16;
        self.due |= if ends_segment(blocks) { level_bit } else { 0 };
        for next in higher {
            if !blocks.is_multiple_of(RADIX as u64) {
                return;
            }
            let sum = level.last((blocks as u32).wrapping_sub(1));
            blocks >>= RADIX_BITS;
            level_bit = level_bit.wrapping_shl(1);
            next.push((blocks as u32).wrapping_sub(1), sum);
            self.due |= if ends_segment(blocks) { level_bit } else { 0 };
            level = next;
        }
    }

    /// Transforms the segment of the lowest level that has one.
    fn transform(&mut self) {
        if let Some((i, block_bits, end)) = self.next_due()
            && let Some(level) = self.levels.get_mut(i)
        {
            level.add_segment(end, block_bits);
        }
    }

    /// The lowest level that has a segment to transform, the number of bits in the length of its blocks, and the block
    /// that the segment ends before. The segment counts as transformed.
    #[inline(always)]
    fn next_due(&mut self) -> Option<(usize, u32, u32)> {
        if self.due == 0 {
            return None;
        }
        let i = self.due.trailing_zeros();
        // The lowest bit is no longer set.
        self.due &= self.due.wrapping_sub(1);
        let block_bits = RADIX_BITS.wrapping_mul(i);
        let end = self.number.wrapping_shr(block_bits) as u32;
        Some((i as usize, block_bits, end))
    }

    /// Marks a place where samples were lost or the gyro was disturbed. No block and no segment spans this
    /// place. What was summed stays. A call first does all the work that waits.
    pub fn gap(&mut self) {
        self.finish();
        self.end();
    }

    /// Forgets what is not yet in a segment.
    fn end(&mut self) {
        self.number = 0;
        self.reference = 0;
        self.taken = 0;
        self.counts = [0; P];
        for level in &mut self.levels {
            level.end();
        }
    }

    /// Adds another record of the same sensor, as if a gap lay between the two.
    pub fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        other.gap();
        self.gap();
        for (own, other) in self.levels.iter_mut().zip(&other.levels) {
            own.merge(other);
        }
        self.lost = self.lost.saturating_add(other.lost);
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// The number of counts that wait to be worked on.
    pub(crate) const fn waiting(&self) -> u32 {
        self.waiting
    }

    /// The levels to restore, and the number of samples that were lost.
    #[cfg(feature = "storage")]
    pub(super) fn start_with(&mut self, lost: u64) -> &mut [Level<P>; LEVELS] {
        self.lost = lost;
        &mut self.levels
    }

    /// The number of samples that found no room, because [`advance`](Self::advance) was called too late.
    pub const fn lost(&self) -> u64 {
        self.lost
    }

    /// What is kept for every block length, with the number of bits in that length, shortest blocks first.
    pub(super) fn levels(&self) -> impl Iterator<Item = (u32, &Level<P>)> {
        let bits = (0..u32::MAX).map(|i| RADIX_BITS.wrapping_mul(i));
        bits.zip(&self.levels)
    }
}

// All sums are numbers, and not NaN.
impl<const P: usize, const LEVELS: usize> Eq for SpectrumAccumulator<P, LEVELS> {}

impl<const P: usize, const LEVELS: usize> Default for SpectrumAccumulator<P, LEVELS> {
    fn default() -> Self {
        Self::new()
    }
}
