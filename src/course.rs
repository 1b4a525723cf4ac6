//! The course of a record over time: when the noise rose, when a burst or a step came, and whether the gyro
//! warmed up.
//!
//! An Allan curve forgets the order of the samples. A [`Course`] keeps it, in 64 blocks of equal duration that
//! double their length when they are full. [`events()`] tests the blocks against the covariance of a fitted model,
//! and [`analyse`] also subtracts from the curve what steps and a warm-up add to it, and fits the model again.
//!
//! | event | test |
//! |---|---|
//! | [noise change](What::NoiseChange) | the largest standardised ratio of the noise after and before, over all block boundaries |
//! | [bursts](What::Bursts) | the blocks whose noise exceeds that of their neighbourhood |
//! | [step](What::Step), [warm-up](What::WarmUp) | generalised least squares on differences of block means, with the model's covariance |
//!
//! The noise of a block is the mean square of the differences of neighbouring samples, which a slow drift does not
//! reach.

mod analysis;
mod baseline;
mod contrasts;
mod correction;
mod cosine;
mod event;
mod form;
mod noise;
mod response;
mod shifts;
mod slow_noise;
#[cfg(feature = "storage")]
mod stored;
mod sums;

pub use analysis::{Analysis, analyse, analyse_without, events};
pub use cosine::CosineTransform;
pub use event::{Event, Events, Largest, MAX_EVENTS, What};
pub use response::{allan_variance_of_step, allan_variance_of_warm_up};

use crate::{
    curve::Scale,
    list,
    real::{Real, real},
};
use heapless::Vec;
use sums::Sums;

/// The number of blocks of a course.
pub const BLOCKS: usize = 64;

/// The longest block, in samples.
const LONGEST: u32 = 1 << 31;

/// The course of a record: 64 blocks of equal duration, in fixed memory for any length.
///
/// Every block sums the counts, the squared differences of neighbouring counts, and the counts of the covariates.
/// All sums are exact. When the blocks are full, pairs of them merge, and blocks are twice as long from then on. A
/// course of more than 64 samples therefore has 33 to 64 blocks, the last of which may not be full. It ends after
/// 2^37 samples, which is 4 years at 1 kHz; later samples are ignored.
///
/// Time is counted in samples. Lost samples whose number is known count as time ([`missing`](Self::missing)). A
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

/// One block of a course.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Block<const COVARIATES: usize = 0> {
    /// Begin, in seconds since the first sample of the course.
    pub start_s: Real,
    /// Duration in seconds, missing samples included.
    pub duration_s: Real,
    /// The number of samples.
    pub samples: u32,
    /// Mean rate in rate units; NaN without samples.
    pub mean: Real,
    /// Mean square of the differences of neighbouring samples, in rate units squared; NaN without differences.
    /// Half of it is the Allan variance at one sample.
    pub mean_square_difference: Real,
    /// Means of the covariates, in counts; NaN without samples.
    pub covariates: [Real; COVARIATES],
}

/// What the tests know about a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// The number of the block, counted from 0.
    pub(crate) place: u32,
    /// The number of samples.
    pub(crate) samples: Real,
    /// The number of differences.
    pub(crate) differences: Real,
    /// The share of the block's full length that has passed.
    pub(crate) filled: Real,
    /// Mean rate less a constant that all blocks share, in rate units.
    pub(crate) mean: Real,
    /// Mean square of the differences, in rate units squared; zero without differences.
    pub(crate) square: Real,
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
    pub fn missing(&mut self, samples: u64) {
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
    fn sums(&self) -> impl Iterator<Item = (&Sums<COVARIATES>, u32)> {
        let complete = self.blocks.iter().take(usize::from(self.complete));
        let open = (self.filled > 0).then_some((&self.open, self.filled));
        complete.map(|sums| (sums, self.block_length())).chain(open)
    }

    /// The exact sum of the counts of every block, and that of the squared differences of neighbouring counts, in
    /// counts squared. A difference belongs to the block of its later sample.
    pub fn exact_sums(&self) -> impl Iterator<Item = (i64, u128)> {
        self.sums().map(|(sums, _)| (sums.counts(), sums.squares()))
    }

    /// The blocks, the earliest first. The last one may not be full.
    pub fn blocks(&self, scale: Scale) -> impl Iterator<Item = Block<COVARIATES>> {
        let interval_s = 1.0 / scale.rate_hz();
        let duration_s = real(self.block_length()) * interval_s;
        let unit = scale.rate_per_count();
        list::numbered(self.sums()).map(move |(b, (sums, time))| {
            let samples = sums.samples(time);
            // Without samples, a quotient would be a NaN whose sign depends on the core.
            let over = |sum: Real, number: u32| match number {
                0 => Real::NAN,
                _ => sum / real(number),
            };
            let mean = |sum: i64| over(sum as Real, samples);
            let square = over(sums.squares_real(), sums.differences(time));
            Block {
                start_s: real(b as u32) * duration_s,
                duration_s: real(time) * interval_s,
                samples,
                mean: mean(sums.counts()) * unit,
                mean_square_difference: square * unit * unit,
                covariates: sums.covariates().map(mean),
            }
        })
    }

    /// The blocks that hold samples, as the tests need them.
    pub(crate) fn levels(&self, scale: Scale) -> Vec<Level, BLOCKS> {
        let unit = scale.rate_per_count();
        let full = real(self.block_length());
        // The mean of the first block with samples is subtracted in integers, so that an offset takes no digits.
        let offset = self
            .sums()
            .map(|(sums, time)| sums.counts().checked_div(i64::from(sums.samples(time))));
        let offset = offset.flatten().next().unwrap_or(0);
        let levels = list::numbered(self.sums()).map(|(b, (sums, time))| {
            let samples = sums.samples(time);
            let differences = sums.differences(time);
            let rest = i64::from(samples).saturating_mul(offset);
            let rest = sums.counts().saturating_sub(rest);
            Level {
                place: b as u32,
                samples: real(samples),
                differences: real(differences),
                filled: real(time) / full,
                mean: rest as Real / real(samples.max(1)) * unit,
                square: sums.squares_real() / real(differences.max(1)) * unit * unit,
            }
        });
        list::fill(levels.filter(|level| level.samples > 0.0))
    }
}

impl Course {
    /// Adds counts. The state afterwards is the same as if they were pushed one by one, but it is reached sooner.
    pub fn push_slice(&mut self, counts: &[i32]) {
        let mut rest = counts;
        while let Some((&first, after)) = rest.split_first() {
            // This one opens a block, or begins a stretch, if need be. The others are within the same.
            self.push(first, []);
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

#[cfg(test)]
mod tests;
