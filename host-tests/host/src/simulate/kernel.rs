//! The autocovariance of an effect's rate, computed from the effect's kernel.

use allanite::effect::{Effect, SampledShape};

/// The autocovariance of the rate at a lag in samples, for a coefficient of one, up to a constant.
/// It is the second difference of the kernel over single samples, with the opposite sign.
pub(super) fn autocovariance(effect: &dyn Effect, shape: &SampledShape, lag: usize) -> f64 {
    let square = shape.interval_s * shape.interval_s;
    -effect.second_difference(lag as f64, 1.0, shape) / square
}
