//! The χ² distribution for whole degrees of freedom.

use crate::numerics::{
    math,
    real::{Real, consts::PI},
};

/// Probability that χ² with `degrees_of_freedom` exceeds `x`.
///
/// The probability is a finite sum (Abramowitz & Stegun 1964, eqs. 26.4.4 and 26.4.5). In double
/// precision it is accurate to 1e-13 of the value down to the smallest numbers, for up to some hundred
/// degrees of freedom. It is 1 for `x ≤ 0`. It is NaN for zero degrees of freedom, or if `x` is NaN.
///
/// ```
/// // This is the 95 % quantile of χ² with 11 degrees of freedom.
/// assert!((allanite::fit::chi_squared_tail(19.675, 11) - 0.05).abs() < 1e-5);
/// ```
pub fn chi_squared_tail(x: Real, degrees_of_freedom: usize) -> Real {
    if degrees_of_freedom == 0 || x.is_nan() {
        return Real::NAN;
    }
    let (is_positive, is_finite) = (0.0 < x, x < Real::INFINITY);
    if !is_positive {
        return 1.0;
    }
    if !is_finite {
        return 0.0;
    }
    let half = 0.5 * x;
    // The factor e^(−x/2) is split into two equal factors. The second one comes last, so that no term
    // underflows that the sum would lift again.
    let decay = math::exp(-0.5 * half);
    // The terms are x^r e^(−x/2) / (r!! …), with whole powers of x/2 for an even number of degrees of
    // freedom and half-integer powers for an odd one.
    let odd = degrees_of_freedom % 2 == 1;
    let mut sum = 0.0;
    let mut term = if odd {
        2.0 * math::short_sqrt(half / PI) * decay
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
        math::erfc(math::short_sqrt(half))
    } else {
        0.0
    };
    // Here the probability is below the smallest number, and the terms may have overflowed.
    if decay == 0.0 {
        return 0.0;
    }
    // What rounding adds is taken off without `min`, which minds numbers that are none.
    let tail = first + sum * decay;
    if 1.0 < tail { 1.0 } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::{by_precision, double, real};

    /// The integral of the density from `x` on, relative to the integral of the whole density.
    /// Simpson's rule takes it in the square root of χ².
    fn integrated(x: f64, degrees: usize) -> f64 {
        const STEPS: u32 = 4000;
        // With x = u², the density is u^(n − 1) e^(−u²/2) du.
        let density = |u: f64| libm::exp(-0.5 * u * u + (degrees as f64 - 1.0) * libm::log(u));
        let integral = |from: f64, to: f64| {
            let step = (to - from) / f64::from(STEPS);
            let weight = |i| match i {
                0 | STEPS => 1.0,
                _ => f64::from(2 + 2 * (i % 2)),
            };
            let terms = (0..=STEPS).map(|i| weight(i) * density(from + f64::from(i) * step));
            terms.sum::<f64>() * step / 3.0
        };
        let (root, far) = (libm::sqrt(x), 20.0 + libm::sqrt(degrees as f64));
        let below = integral(1e-9, root);
        let above = integral(root, far);
        above / (above + below)
    }

    #[test]
    fn tails_are_integrals_of_the_density() {
        let digits = double(by_precision(1e-9, 3e-6));
        for degrees in 1..=40 {
            for step in 1..20 {
                let x = 0.2 * f64::from(step) * degrees as f64;
                let (found, expected) = (
                    double(chi_squared_tail(real(x), degrees)),
                    integrated(x, degrees),
                );
                // The rounding of x in single precision changes the exponent x/2, so that the relative
                // error grows with x.
                let most = digits * (1.0 + 0.5 * x) * expected + 1e-30;
                assert!(
                    (found - expected).abs() <= most,
                    "χ²({degrees}) > {x}: {found:e}, not {expected:e}"
                );
            }
        }
    }

    #[test]
    fn the_tail_is_defined_at_zero_infinity_nan_and_zero_degrees() {
        for degrees in [1, 2, 11, 30] {
            for x in [0.0, -0.0, -1.0, Real::NEG_INFINITY] {
                assert_eq!(chi_squared_tail(x, degrees), 1.0);
            }
            for x in [Real::INFINITY, Real::MAX, 1e5] {
                assert_eq!(chi_squared_tail(x, degrees), 0.0);
            }
            assert!(chi_squared_tail(Real::NAN, degrees).is_nan());
            assert!(chi_squared_tail(Real::MIN_POSITIVE, degrees) <= 1.0);
        }
        for x in [-1.0, 0.0, 1.0, Real::INFINITY, Real::NAN] {
            assert!(chi_squared_tail(x, 0).is_nan());
        }
    }
}
