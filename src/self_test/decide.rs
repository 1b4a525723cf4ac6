//! Whether a coefficient lies above or below a limit.

use crate::{
    coefficient::{Coefficient, State},
    limits::ONE_SIDED_95,
    math,
    real::{Real, consts::FRAC_1_SQRT_2, real},
};

/// Where a limit stands beside an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// The limit is kept.
    Below,
    /// It is not.
    Above,
    /// It is within the interval: `standard_errors` apart, with sign.
    Open {
        /// How far the estimate lies above the limit, in standard errors.
        standard_errors: Real,
    },
}

/// A square less sure than this share of itself is not called too large: it may have taken over what others
/// have, and its distribution is known too little.
const SURE: Real = 0.25;

/// The least standard errors that an estimate and a limit must be apart for a probability.
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

/// Probability of a normal deviate above `z`.
fn tail(z: Real) -> Real {
    0.5 * math::erfc(z * FRAC_1_SQRT_2)
}

/// Decides with the quantiles of passing and failing. `beside` is the standard error of the square with the
/// coefficients of neighbouring slopes free: where the fit holds one at zero that is not, this one has its
/// share, and is surer of it than it should be.
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
    // Of a sum of squares the one is right, of a small part of others' the other: both must agree.
    let nearer = normal.max(skewed(coefficient.square, coefficient.square_error, limit));
    if nearer < -pass {
        Side::Below
    } else {
        open(nearer)
    }
}

/// Standard error of the square; of one that is only bounded, that of its bound, where it may scatter
/// more.
fn error(coefficient: &Coefficient) -> Real {
    let bound = coefficient.upper * coefficient.upper - coefficient.square;
    match coefficient.state {
        State::UpperBound => (bound / real(ONE_SIDED_95)).max(coefficient.square_error),
        _ => coefficient.square_error,
    }
}

/// The square taken for a mean of squares: it is distributed as χ² with `2 (β/σ)²` degrees of freedom,
/// whose cube root is nearly normal (Wilson & Hilferty 1931).
fn skewed(square: Real, error: Real, limit: Real) -> Real {
    let relative = error / square;
    // 2/(9ν).
    let variance = relative * relative / 9.0;
    let ratio = math::cbrt(square / limit);
    (ratio - (1.0 - variance)) / math::sqrt(variance)
}
