//! The χ² distribution, for whole degrees of freedom.

use crate::{
    math,
    real::{Real, consts::PI},
};

/// Probability that χ² with `degrees_of_freedom` exceeds `x`.
///
/// A finite sum (Abramowitz & Stegun 1964, eqs. 26.4.4 and 26.4.5): accurate to 1e-13 of the value
/// down to the smallest numbers, for up to some hundred degrees of freedom. 1 for `x ≤ 0`; NaN
/// without degrees of freedom, or if `x` is NaN.
///
/// ```
/// // The 95 % quantile of χ² with 11 degrees of freedom.
/// assert!((allanite::chi_squared_tail(19.675, 11) - 0.05).abs() < 1e-5);
/// ```
pub fn chi_squared_tail(x: Real, degrees_of_freedom: usize) -> Real {
    if degrees_of_freedom == 0 || x.is_nan() {
        return Real::NAN;
    }
    if x <= 0.0 {
        return 1.0;
    }
    if x == Real::INFINITY {
        return 0.0;
    }
    let half = 0.5 * x;
    // Half of the exponential comes last, so that no term is lost that the sum can lift again.
    let decay = math::exp(-0.5 * half);
    // Terms x^r e^(−x/2) / (r!! …): whole powers of x/2 for even degrees, half ones for odd.
    let odd = degrees_of_freedom % 2 == 1;
    let mut sum = 0.0;
    let mut term = if odd {
        2.0 * math::sqrt(half / PI) * decay
    } else {
        decay
    };
    let mut divisor = if odd { 1.5 } else { 1.0 };
    for _ in 0..degrees_of_freedom / 2 {
        sum += term;
        term *= half / divisor;
        divisor += 1.0;
    }
    let first = if odd {
        math::erfc(math::sqrt(half))
    } else {
        0.0
    };
    // Beyond all doubles, where the terms may be too.
    if decay == 0.0 {
        return 0.0;
    }
    (first + sum * decay).min(1.0)
}
