//! The course in a curve file, as its cosine transform.

use allanite::course::CosineTransform;
use serde::{Deserialize, Serialize};

/// The most power of a course, in Allan variances of one of its blocks. The means of 64 blocks differ from their mean by
/// the sum of at most 63 differences, so that a record without gaps has 2 · 64³ at most. Gaps may leave out a few of the
/// differences.
const MOST_POWER: f64 = 1e6;

/// The cosine transform of the means of a record's blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CourseDensities {
    /// Number of samples in a block, a power of two.
    pub block: u32,
    /// Number of blocks.
    pub blocks: u32,
    /// One-sided densities in rate units squared per hertz, from one half-wave in the record on: one less than blocks.
    pub densities: Vec<f64>,
}

impl CourseDensities {
    pub(super) fn of(course: &CosineTransform) -> Self {
        Self {
            block: course.block(),
            blocks: course.blocks(),
            densities: course.densities().to_vec(),
        }
    }

    pub(super) fn transform(&self, rate_hz: f64) -> Result<CosineTransform, allanite::Error> {
        let densities = self.densities.iter().copied();
        CosineTransform::new(rate_hz, self.block, self.blocks, densities)
    }

    /// Checks the numbers against each other and against their axis: its rate, its samples if it has no gap, and the
    /// Allan variance of an averaging factor.
    pub(super) fn check(
        &self,
        samples: Option<u64>,
        rate_hz: f64,
        variance: impl Fn(u32) -> Option<f64>,
    ) -> Result<(), String> {
        let here = |what: &str| Err(format!("course: {what}"));
        if let Err(error) = self.transform(rate_hz) {
            return here(&error.to_string());
        }
        let time = u64::from(self.block) * u64::from(self.blocks);
        if samples.is_some_and(|samples| time > samples) {
            return here("the blocks are longer than the record");
        }
        let power = self.densities.iter().sum::<f64>() * rate_hz / (2.0 * f64::from(self.block));
        if variance(self.block).is_some_and(|variance| power > MOST_POWER * variance) {
            return here("the densities contradict the octaves");
        }
        Ok(())
    }
}
