//! Coefficients with their intervals, bounds and tests against zero.

use super::{
    rounds::iterate,
    rows::Rows,
    tableau::Tableau,
    terms::{TERMS, Units, power, sqrt},
};
use crate::{
    fit::coefficient::{Coefficient, State},
    limits::{CHI_SQUARED_95, ONE_SIDED_95},
    numerics::real::{Real, real, single},
};

/// Name, symbol and twice the exponent of the second in the unit, of each term.
pub(super) const NAMES: [(&str, &str, i8); TERMS] = [
    ("quantization", "Q", 2),
    ("angle_random_walk", "N", 1),
    ("bias_instability", "B", 0),
    ("rate_random_walk", "K", -1),
    ("rate_ramp", "R", -2),
];

/// A coefficient is tested against zero if the lower end of its interval is below this share of it.
const NARROW: f32 = 0.7;

/// The rounds of a bound.
const BOUND_ROUNDS: u8 = 2;

/// The rounds of a test end when the relative change of the model is smaller than this.
const ROUGHLY: f32 = 0.03;

/// The normal deviate that is exceeded with the probability of [`ADEQUATE_P`](crate::fit::ADEQUATE_P).
const INADEQUATE: f32 = 2.326_348;

/// Turns squares of the fit into squared coefficients.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    /// The unit of the first term's square, and the averaging time by which it falls from term to term.
    first: Real,
    tau_s: Real,
}

impl Scale {
    pub(super) fn new(reference: Real, interval_s: Real, units: Units) -> Self {
        let tau_s = interval_s * real(power(units.middle()));
        Self {
            first: reference * tau_s * tau_s,
            tau_s,
        }
    }

    /// The unit of a term's square.
    pub(super) fn unit(self, term: usize) -> Real {
        (0..term).fold(self.first, |unit, _| unit / self.tau_s)
    }
}

/// The factor by which errors are widened if χ² is too large to be one of an adequate model. Its quantile is that of
/// Wilson & Hilferty (1931).
pub(super) fn birge_ratio(chi_squared: f32, degrees_of_freedom: usize) -> f32 {
    if degrees_of_freedom == 0 {
        return 1.0;
    }
    let degrees = degrees_of_freedom as f32;
    let share = 2.0 / (9.0 * degrees);
    let root = 1.0 - share + INADEQUATE * sqrt(share);
    let ratio = chi_squared / degrees;
    if ratio > root * root * root {
        sqrt(ratio)
    } else {
        1.0
    }
}

/// All coefficients. The tableau and the rows are those of the fit.
#[inline(never)]
pub(super) fn all<const K: usize>(
    rows: &mut Rows<'_, K>,
    tableau: &mut Tableau,
    squares: &[f32; TERMS],
    birge_ratio: f32,
    scale: Scale,
) -> [Coefficient; TERMS] {
    let fitted = *tableau;
    let mut found = [Estimate::NOTHING; TERMS];
    for (term, (found, &square)) in (0..TERMS).zip(found.iter_mut().zip(squares)) {
        *found = Estimate::of(&fitted, term, square, birge_ratio);
        if found.lower <= 0.0 && found.upper < f32::INFINITY {
            found.bound(rows, tableau, (fitted.free(), term), birge_ratio);
        }
    }
    if birge_ratio <= 1.0 {
        for (term, found) in (0..TERMS).zip(&mut found) {
            // Of squares, so that no root is needed.
            if found.lower > 0.0 && found.lower < NARROW * NARROW * found.square {
                *tableau = fitted;
                if may_be_zero(rows, tableau, term) {
                    (found.lower, found.state) = (0.0, State::UpperBound);
                }
            }
        }
    }
    // One after the other, because they would be copied from what makes an array.
    let of = |term: usize| {
        let found = found.get(term).unwrap_or(&Estimate::NOTHING);
        found.coefficient(term, scale)
    };
    [of(0), of(1), of(2), of(3), of(4)]
}

/// The root of a unit, which single precision may not hold: only its part from 1 to 4 is rounded.
pub(super) fn root_of(unit: Real) -> Real {
    let (mut part, mut scale) = (unit, 1.0);
    for _ in 0..600 {
        if part >= 4.0 {
            (part, scale) = (0.25 * part, 2.0 * scale);
        } else if part < 1.0 && part > 0.0 {
            (part, scale) = (4.0 * part, 0.5 * scale);
        } else {
            break;
        }
    }
    real(sqrt(single(part))) * scale
}

/// A squared coefficient with its interval, in units of the fit.
#[derive(Clone, Copy)]
struct Estimate {
    square: f32,
    lower: f32,
    upper: f32,
    error: f32,
    state: State,
}

impl Estimate {
    const NOTHING: Self = Self {
        square: 0.0,
        lower: 0.0,
        upper: f32::INFINITY,
        error: f32::INFINITY,
        state: State::NotObservable { after_s: None },
    };

    /// The interval by the likelihood ratio.
    #[inline(never)]
    fn of(tableau: &Tableau, term: usize, square: f32, birge_ratio: f32) -> Self {
        let mut beside = *tableau;
        beside.hold(term);
        let Some(variance) = beside.variance(term) else {
            return Self {
                square,
                ..Self::NOTHING
            };
        };
        let error = sqrt(variance) * birge_ratio;
        let rise = CHI_SQUARED_95 as f32 * birge_ratio * birge_ratio;
        let lower = beside.end(term, square, rise, false);
        if lower > 0.0 {
            return Self {
                square,
                lower,
                upper: beside.end(term, square, rise, true),
                error,
                state: State::Measured,
            };
        }
        Self {
            square,
            upper: square + ONE_SIDED_95 as f32 * error,
            error,
            ..Self::NOTHING
        }
    }

    /// The bound with the scatter that the curve has at the bound. Whether it says anything does not depend on how well the
    /// terms explain the curve.
    #[inline(never)]
    fn bound<const K: usize>(
        &mut self,
        rows: &mut Rows<'_, K>,
        tableau: &mut Tableau,
        (guess, term): (u8, usize),
        birge_ratio: f32,
    ) {
        let widened = self.upper;
        let mut bound = self.square + (widened - self.square) / birge_ratio;
        for _ in 0..BOUND_ROUNDS {
            rows.set_equations(Some((term, bound)), tableau);
            tableau.solve(guess, 0);
            let square = tableau.squares().get(term).copied().unwrap_or(0.0);
            tableau.hold(term);
            let Some(variance) = tableau.variance(term) else {
                break;
            };
            bound = square + ONE_SIDED_95 as f32 * sqrt(variance);
        }
        bound = if bound > self.square {
            bound
        } else {
            self.square
        };
        if rows.all_above(term, bound) {
            self.state = State::UpperBound;
        }
        self.upper = bound;
        if birge_ratio > 1.0 && self.state == State::UpperBound && widened > bound {
            self.upper = widened;
        }
    }

    #[inline(never)]
    fn coefficient(&self, term: usize, scale: Scale) -> Coefficient {
        let (name, symbol, half_seconds) = NAMES.get(term).copied().unwrap_or(NAMES[0]);
        let unit = scale.unit(term);
        let root_of_unit = root_of(unit);
        // The root of the product, whose factors may be far from one.
        let root = |square: f32| real(sqrt(square)) * root_of_unit;
        Coefficient {
            name,
            symbol,
            half_seconds,
            value: root(self.square),
            lower: root(self.lower),
            upper: root(self.upper),
            state: self.state,
            square: real(self.square) * unit,
            square_error: real(self.error) * unit,
        }
    }
}

/// Whether a coefficient may be zero: the likelihood ratio with the covariance that the curve has if it is zero. The tableau is
/// that of the fit.
#[inline(never)]
fn may_be_zero<const K: usize>(rows: &mut Rows<'_, K>, tableau: &mut Tableau, term: usize) -> bool {
    let held = 1_u8.wrapping_shl(term as u32);
    let guess = tableau.free();
    tableau.hold(term);
    tableau.solve(0, held);
    let start = tableau.squares();
    let rounds = iterate(rows, tableau, start, ROUGHLY, &|tableau| {
        tableau.solve(guess, held);
    });
    if rounds.is_none() {
        return false;
    }
    let fall = tableau.solve(0, 0);
    !(tableau.has(term) && fall > CHI_SQUARED_95 as f32)
}
