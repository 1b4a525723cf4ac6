//! Deviance residuals of variances (McCullagh & Nelder 1989, ch. 2.4).
//!
//! χ² by the covariance of a model hardly sees a model that is too high: a variance that is nearly zero lies one relative
//! standard error √(2/ν) below it, and no more. The deviance `ν (x − 1 − ln x)` of a variance with ν degrees of freedom that is
//! `x` times its model grows without limit on both sides, and its signed root is nearly normal.

use super::{chi_squared::chi_squared_tail, math::root, real::Real};
use crate::limits;
use core::f32::consts::LN_2;

/// The probability of a deviance below which it judges the model, a tenth of that at which a model is not adequate: true models
/// are called inadequate in hardly more records than by χ² alone.
const LEAST_P: Real = 0.1 * limits::ADEQUATE_P as Real;

/// The factor between the two.
const DOUBT: Real = 10.0;

/// What a model is judged by: χ² of its residuals, or the deviance where no chance explains it; and the probability of a larger
/// one.
///
/// χ² compares models of one curve badly, because each has the covariance of its own: where a model that is far from the curve
/// gets one effect more, the errors of some rows fall, and χ² may rise. The deviance falls.
pub(crate) fn judged(chi_squared: Real, deviance: Real, degrees_of_freedom: usize) -> (Real, Real) {
    let by_deviance = chi_squared_tail(deviance, degrees_of_freedom);
    if by_deviance < LEAST_P {
        (deviance, DOUBT * by_deviance)
    } else {
        (
            chi_squared,
            chi_squared_tail(chi_squared, degrees_of_freedom),
        )
    }
}

/// The probability of the one that judged.
pub(crate) fn p_value(judged: Real, deviance: Real, degrees_of_freedom: usize) -> Real {
    let tail = chi_squared_tail(judged, degrees_of_freedom);
    if judged.to_bits() == deviance.to_bits() {
        (DOUBT * tail).min(1.0)
    } else {
        tail
    }
}

/// A variance that is a smaller share of the model counts as this one.
const LEAST: f32 = 1e-6;

/// Nearer to one, the difference of `x − 1` and the logarithm would lose its digits, and its series is taken.
const NEAR: f32 = 0.06;

/// The deviance residual of a variance that is `ratio` times its model, where it has this relative standard error.
pub(crate) fn deviance_residual(ratio: f32, relative_error: f32) -> f32 {
    let excess = ratio.max(LEAST) - 1.0;
    let half = if excess.abs() < NEAR {
        excess * excess * (0.5 - excess * (1.0 / 3.0 - excess * (0.25 - 0.2 * excess)))
    } else {
        excess - log(1.0 + excess)
    };
    // With ν = 2 / relative_error², the mean of the roots is −√(2/(9ν))/2.
    let size = root(2.0 * half) / relative_error;
    let mean = relative_error / 6.0;
    if excess < 0.0 {
        mean - size
    } else {
        mean + size
    }
}

/// The natural logarithm of a normal number above zero, accurate to 3e-7. That of libm needs a table.
fn log(x: f32) -> f32 {
    // The mantissa is between √½ and √2, where a few terms of the series of the inverse hyperbolic tangent are enough.
    const SQRT_HALF: u32 = core::f32::consts::FRAC_1_SQRT_2.to_bits();
    const ONE: u32 = 1.0_f32.to_bits();
    let beyond = x.to_bits().wrapping_sub(SQRT_HALF);
    let exponent = (beyond as i32).wrapping_shr(23);
    let mantissa = f32::from_bits((beyond & 0x7F_FFFF).wrapping_add(SQRT_HALF));
    debug_assert!(ONE.wrapping_sub(SQRT_HALF) < 1 << 23);
    let t = (mantissa - 1.0) / (mantissa + 1.0);
    let square = t * t;
    let series = 1.0 + square * (1.0 / 3.0 + square * (0.2 + square / 7.0));
    exponent as f32 * LN_2 + 2.0 * t * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_those_of_the_standard_library() {
        let mut x = 1e-7_f32;
        while x < 1e7 {
            let exact = libm::log(f64::from(x));
            let found = f64::from(log(x));
            assert!((found - exact).abs() < 3e-7 * exact.abs().max(1.0), "{x}");
            x *= 1.013;
        }
    }

    #[test]
    fn the_series_meets_the_logarithm() {
        for side in [1.0 - NEAR, 1.0 + NEAR] {
            let [below, above] = [0.9999, 1.0001].map(|factor| {
                let ratio = 1.0 + (side - 1.0) * factor;
                f64::from(deviance_residual(ratio, 0.01))
            });
            assert!((below - above).abs() < 5e-3, "{below} {above}");
        }
    }
}
