//! Decides whether a coefficient lies above or below a limit.

use crate::{
    coefficient::{Coefficient, State},
    limits::ONE_SIDED_95,
    math,
    real::{Real, consts::FRAC_1_SQRT_2, real},
};

/// The side of a limit on which a coefficient lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// The coefficient is below the limit.
    Below,
    /// The coefficient is above the limit.
    Above,
    /// The limit lies within the coefficient's interval.
    Open {
        /// The distance of the estimate above the limit, in standard errors; negative below the limit.
        standard_errors: Real,
    },
}

/// The largest relative standard error with which a square is called too large. A less certain square
/// may have absorbed the share of other coefficients, and its distribution is not known well enough.
/// Chosen by hand; `cargo xtask study self-test` gives the rate of errors with it.
const SURE: Real = 0.25;

/// The smallest distance between an estimate and a limit, in standard errors, at which the probability of a
/// wrong decision is at most `probability`.
pub(super) fn quantile(probability: Real) -> Real {
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
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

/// Decides with the quantiles of passing and failing. `beside` is the standard error of the square when the
/// coefficients of neighbouring slopes are free. If the fit holds a neighbour at zero that is not zero, this
/// coefficient absorbs its share, and the standard error of the fit is too small. `beside` allows for that.
pub(super) fn side(
    coefficient: &Coefficient,
    beside: Real,
    most: Real,
    pass: Real,
    fail: Real,
) -> Side {
    let limit = most * most;
    let open = |standard_errors| Side::Open { standard_errors };
    if let State::NotObservable { .. } = coefficient.state {
        return open(0.0);
    }
    let normal = (coefficient.square - limit) / error(coefficient);
    if coefficient.state == State::UpperBound {
        return if normal < -pass {
            Side::Below
        } else {
            open(normal)
        };
    }
    if coefficient.square > limit {
        let above = skewed(coefficient.square, beside, limit);
        return if above > fail && beside < SURE * coefficient.square {
            Side::Above
        } else {
            open(above)
        };
    }
    // The χ² distribution suits a coefficient that dominates its octaves, and the normal distribution suits
    // one that is a small part of them. Both must agree, so the one that is nearer to the limit decides.
    let nearer = normal.max(skewed(coefficient.square, coefficient.square_error, limit));
    if nearer < -pass {
        Side::Below
    } else {
        open(nearer)
    }
}

/// The standard error of the square. For an upper bound it is the larger of the fit's error and the error
/// that the bound implies.
fn error(coefficient: &Coefficient) -> Real {
    let bound = coefficient.upper * coefficient.upper - coefficient.square;
    match coefficient.state {
        State::UpperBound => (bound / real(ONE_SIDED_95)).max(coefficient.square_error),
        _ => coefficient.square_error,
    }
}

/// The distance of the square above the limit, in standard deviations, if the square is a mean of squares.
/// Such a mean is distributed as χ² with `2 (β/σ)²` degrees of freedom, whose cube root is nearly normal
/// (Wilson & Hilferty 1931).
fn skewed(square: Real, error: Real, limit: Real) -> Real {
    let relative = error / square;
    // This is 2/(9ν), with ν degrees of freedom.
    let variance = relative * relative / 9.0;
    let ratio = math::cbrt(square / limit);
    (ratio - (1.0 - variance)) / math::sqrt(variance)
}
