//! The course of a record as it is read: its blocks with units, and their cosine transform.

mod change;
mod cosine;

pub use cosine::CosineTransform;

use crate::{
    curve::Scale,
    list,
    numerics::real::{Real, real},
    record::course::{BLOCKS, Course},
};
use heapless::Vec;

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

/// Whether a block has ended, and holds at least half of its samples.
pub(crate) fn is_complete(level: &Level, block_length: u32) -> bool {
    level.filled >= 1.0 && 2.0 * level.samples >= real(block_length)
}

impl<const COVARIATES: usize> Course<COVARIATES> {
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
