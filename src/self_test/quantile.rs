//! The quantile of the normal distribution that decides whether a coefficient is above or below a limit.

use crate::numerics::{
    math,
    real::{Real, consts::FRAC_1_SQRT_2},
};

/// The halvings of the interval that leave a bit of its upper end.
const HALVINGS: u32 = Real::MANTISSA_DIGITS + 7;

/// The number of standard errors that a normal deviate exceeds with this probability.
pub(super) fn quantile(probability: Real) -> Real {
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if tail(middle) > probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The probability that a standard normal deviate exceeds `z`.
fn tail(z: Real) -> Real {
    0.5 * math::erfc(z * FRAC_1_SQRT_2)
}
