//! The sums of a record over time, in blocks of equal duration.

#[cfg(feature = "storage")]
mod stored;
mod sums;

pub(crate) use sums::Sums;

/// The number of blocks of a course.
pub const BLOCKS: usize = 64;

/// The longest block, in samples.
pub(crate) const LONGEST: u32 = 1 << 31;

/// The course of a record: 64 blocks of equal duration, in fixed memory for any length.
///
/// Every block sums the counts, the squared differences of neighbouring counts, and the counts of the covariates.
/// All sums are exact. When the blocks are full, pairs of them merge, and blocks are twice as long from then on. A
/// course of more than 64 samples therefore has 33 to 64 blocks, the last of which may not be full. It ends after
/// 2^37 samples, which is 4 years at 1 kHz; later samples are ignored.
///
/// Time is counted in samples. Lost samples whose number is known count as time ([`lost`](Self::lost)). A
/// [`gap`](Self::gap) of unknown length takes no time.
///
/// A course has no `merge`: a course is a time series, and another record has no place in it.
///
/// # Cost
///
/// The state takes `2096 + 520 · COVARIATES` bytes. On a Cortex-M4F without covariates, a sample takes 26 instructions
/// where `push` is inlined at opt-level 3, and 31 where it is called. These were counted in the assembly. The sample
/// that doubles the length of the blocks takes some 2000 more.
///
/// # Example
///
/// ```
/// use allanite::{Scale, course::Course};
///
/// let mut course = Course::<1>::new();
/// for n in 0..1000_i32 {
///     course.push(n % 7, [20]); // one axis and a temperature
/// }
/// // 63 blocks of 16 samples make 1008.
/// let scale = Scale::new(0.01, 100.0)?;
/// let blocks: Vec<_> = course.blocks(scale).collect();
/// assert_eq!((blocks.len(), blocks[62].samples), (63, 8));
/// assert_eq!(blocks[0].covariates, [20.0]);
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Course<const COVARIATES: usize = 0> {
    /// The last sample.
    before: i32,
    /// Whether the next sample has a difference: there is a sample before it and no gap in between.
    is_running: bool,
    /// The number of complete blocks, at most 63.
    complete: u8,
    /// Samples of time in the open block.
    filled: u32,
    /// The length of a block in samples, less 1.
    last_place: u32,
    /// The block that is being filled, or that has just been filled.
    open: Sums<COVARIATES>,
    blocks: [Sums<COVARIATES>; BLOCKS],
}

impl<const COVARIATES: usize> Course<COVARIATES> {
    /// An empty course.
    // All zero, so that a `static` is placed in `.bss`.
    pub const fn new() -> Self {
        Self {
            before: 0,
            is_running: false,
            complete: 0,
            filled: 0,
            last_place: 0,
            open: Sums::ZERO,
            blocks: [Sums::ZERO; BLOCKS],
        }
    }

    /// Adds one count, and one of every covariate.
    #[inline]
    pub fn push(&mut self, count: i32, covariates: [i32; COVARIATES]) {
        if self.filled > self.last_place && !self.open_next() {
            return;
        }
        self.filled = self.filled.wrapping_add(1);
        self.open.add(count, &covariates);
        if self.is_running {
            self.open.add_difference(count, self.before);
        } else {
            self.open.add_start();
            self.is_running = true;
        }
        self.before = count;
    }

    /// Marks a place where samples were lost, and it is not known how many. No difference spans this place, and no
    /// time passes.
    pub const fn gap(&mut self) {
        self.is_running = false;
        // It is not needed any more, and courses that agree in everything else are equal.
        self.before = 0;
    }

    /// Counts samples that were lost at this place. Their time passes, and no difference spans them. Does nothing
    /// for 0 samples.
    pub fn lost(&mut self, samples: u64) {
        let mut left = samples;
        while left > 0 {
            self.gap();
            if self.filled > self.last_place && !self.open_next() {
                return;
            }
            let room = self.block_length().saturating_sub(self.filled);
            let taken = u32::try_from(left).unwrap_or(u32::MAX).min(room);
            self.filled = self.filled.saturating_add(taken);
            self.open.add_missing(taken);
            left = left.saturating_sub(u64::from(taken));
        }
    }

    /// Stores the full block and opens the next one. Returns `false` if the course has ended.
    #[cold]
    #[inline(never)]
    fn open_next(&mut self) -> bool {
        let complete = usize::from(self.complete);
        let is_last = complete.saturating_add(1) >= BLOCKS;
        if is_last && self.block_length() >= LONGEST {
            return false;
        }
        if let Some(block) = self.blocks.get_mut(complete) {
            *block = self.open;
        }
        self.complete = self.complete.saturating_add(1);
        self.open = Sums::ZERO;
        self.filled = 0;
        if is_last {
            self.merge_pairs();
        }
        true
    }

    /// Merges pairs of blocks, which doubles their length.
    fn merge_pairs(&mut self) {
        let mut pairs = [Sums::ZERO; BLOCKS / 2];
        for (merged, pair) in pairs.iter_mut().zip(self.blocks.chunks_exact(2)) {
            if let [first, second] = pair {
                *merged = first.merged(second);
            }
        }
        self.blocks = [Sums::ZERO; BLOCKS];
        for (block, merged) in self.blocks.iter_mut().zip(pairs) {
            *block = merged;
        }
        self.complete = (BLOCKS / 2) as u8;
        self.last_place = self.last_place.wrapping_mul(2).wrapping_add(1);
    }

    /// Forgets everything.
    pub const fn reset(&mut self) {
        *self = Self::new();
    }

    /// The length of a block, in samples: a power of two.
    pub const fn block_length(&self) -> u32 {
        self.last_place.saturating_add(1)
    }

    /// The time that has passed, in samples: those that were pushed and those that are known to be missing.
    pub const fn time(&self) -> u64 {
        self.complete as u64 * self.block_length() as u64 + self.filled as u64
    }

    /// The sums of every block, each with the samples of time that it spans.
    pub(crate) fn sums(&self) -> impl Iterator<Item = (&Sums<COVARIATES>, u32)> {
        let complete = self.blocks.iter().take(usize::from(self.complete));
        let open = (self.filled > 0).then_some((&self.open, self.filled));
        complete.map(|sums| (sums, self.block_length())).chain(open)
    }

    /// The exact sum of the counts of every block, and that of the squared differences of neighbouring counts, in
    /// counts squared. A difference belongs to the block of its later sample.
    pub fn exact_sums(&self) -> impl Iterator<Item = (i64, u128)> {
        self.sums().map(|(sums, _)| (sums.counts(), sums.squares()))
    }
}

impl Course {
    /// Adds counts. The state afterwards is the same as if they were pushed one by one, but it is reached sooner.
    pub fn push_slice(&mut self, counts: &[i32]) {
        self.push_counts(counts);
    }
}

impl<const COVARIATES: usize> Course<COVARIATES> {
    /// Adds counts whose covariates are zero.
    pub(crate) fn push_counts(&mut self, counts: &[i32]) {
        let mut rest = counts;
        while let Some((&first, after)) = rest.split_first() {
            // This one opens a block, or begins a stretch, if need be. The others are within the same.
            self.push(first, [0; COVARIATES]);
            let room = self.block_length().saturating_sub(self.filled) as usize;
            let (within, after) = after.split_at(room.min(after.len()));
            self.filled = self.filled.wrapping_add(within.len() as u32);
            self.open.add_slice(within, self.before);
            self.before = within.last().copied().unwrap_or(self.before);
            rest = after;
        }
    }
}

impl<const COVARIATES: usize> Default for Course<COVARIATES> {
    fn default() -> Self {
        Self::new()
    }
}
