//! A rate that jumps between two levels.

use super::{Random, Source, kernel::autocovariance};
use allanite::effect::{Effect, SampledShape};
use rand::RngExt;

/// The samples of a rate that jumps between two levels of opposite sign at independent times
/// (Machlup 1954).
pub(super) struct TwoLevels {
    rate: f64,
    /// The probability of an odd number of jumps between two samples.
    flip: f64,
}

impl TwoLevels {
    /// The magnitude of the levels is the root of the effect's variance. The probability of a flip,
    /// `(1 − r₁/r₀)/2`, follows from its autocovariance at lags of zero and one sample.
    pub(super) fn new(
        effect: &dyn Effect,
        shape: &SampledShape,
        coefficient: f64,
        random: &mut Random,
    ) -> Self {
        let [variance, next] = [0, 1].map(|lag| autocovariance(effect, shape, lag));
        let level = coefficient * variance.sqrt();
        Self {
            rate: if random.random_bool(0.5) {
                level
            } else {
                -level
            },
            flip: (0.5 * (variance - next) / variance).clamp(0.0, 0.5),
        }
    }
}

impl Source for TwoLevels {
    fn next(&mut self, random: &mut Random) -> f64 {
        if random.random_bool(self.flip) {
            self.rate = -self.rate;
        }
        self.rate
    }
}
