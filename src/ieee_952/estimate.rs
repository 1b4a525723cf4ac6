//! Coefficients with their intervals, bounds and tests against zero.

use super::{
    rounds::{IsClear, is_certain, iterate},
    rows::Rows,
    tableau::Tableau,
    terms::{TERMS, Units, is_positive, positive, power, sqrt},
};
use crate::{
    fit::coefficient::{Coefficient, State},
    limits::{CHI_SQUARED_95, ONE_SIDED_95, TWO_SIDED_95},
    numerics::{
        math::short_sqrt,
        real::{Real, real},
    },
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

/// Turns what the fit finds into coefficients. Roots are kept, because their squares may be beyond the range of numbers.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    /// The root of the unit of the first term's square, and that of the averaging time by which it falls from term to term.
    first: Real,
    step: Real,
}

impl Scale {
    pub(super) fn new(reference: Real, interval_s: Real, units: Units) -> Self {
        let tau_s = interval_s * real(power(units.middle()));
        Self {
            first: short_sqrt(reference) * tau_s,
            step: short_sqrt(tau_s),
        }
    }

    /// The root of the unit of a term's square.
    pub(super) fn root(self, term: usize) -> Real {
        (0..term).fold(self.first, |root, _| root / self.step)
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
        let has_end = found.upper.to_bits() < f32::INFINITY.to_bits();
        if !is_positive(found.lower) && has_end {
            found.bound(rows, tableau, (fitted.free(), term), birge_ratio);
        }
    }
    let is_widened = 1.0 < birge_ratio;
    if !is_widened {
        for (term, found) in (0..TERMS).zip(&mut found) {
            // Of squares, so that no root is needed.
            if is_positive(found.lower) && found.lower < NARROW * NARROW * found.square {
                *tableau = fitted;
                if may_be_zero(rows, tableau, term) {
                    (found.lower, found.is_bound) = (0.0, true);
                }
            }
        }
    }
    coefficients(scale, &found)
}

/// The coefficients of all terms.
#[inline(always)]
pub(super) fn coefficients(scale: Scale, estimates: &[Estimate; TERMS]) -> [Coefficient; TERMS] {
    // One after the other, because they would be copied from what makes an array.
    let of = |term: usize| {
        let found = estimates.get(term).unwrap_or(&Estimate::NOTHING);
        found.coefficient(term, scale)
    };
    [of(0), of(1), of(2), of(3), of(4)]
}

/// A squared coefficient with its interval, in units of the fit.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    square: f32,
    lower: f32,
    upper: f32,
    error: f32,
    /// Whether `upper` is a bound that says something. A coefficient whose `lower` is above zero is measured.
    is_bound: bool,
}

impl Estimate {
    pub(super) const NOTHING: Self = Self {
        square: 0.0,
        lower: 0.0,
        upper: f32::INFINITY,
        error: f32::INFINITY,
        is_bound: false,
    };

    /// A square that may be negative, with its standard error.
    pub(super) fn normal(square: f32, error: f32) -> Self {
        let width = TWO_SIDED_95 as f32 * error;
        let lower = square - width;
        if is_positive(lower) {
            return Self {
                square,
                lower,
                upper: square + width,
                error,
                ..Self::NOTHING
            };
        }
        Self {
            square,
            lower: 0.0,
            upper: positive(square) + ONE_SIDED_95 as f32 * error,
            error,
            is_bound: true,
        }
    }

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
        if is_positive(lower) {
            return Self {
                square,
                lower,
                upper: beside.end(term, square, rise, true),
                error,
                ..Self::NOTHING
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
        if bound < self.square {
            bound = self.square;
        }
        self.is_bound = rows.all_above(term, bound);
        let is_widened = 1.0 < birge_ratio && self.is_bound && bound < widened;
        self.upper = if is_widened { widened } else { bound };
    }

    #[inline(never)]
    fn coefficient(&self, term: usize, scale: Scale) -> Coefficient {
        let (name, symbol, half_seconds) = NAMES.get(term).copied().unwrap_or(NAMES[0]);
        let root_of_unit = scale.root(term);
        let state = if is_positive(self.lower) {
            State::Measured
        } else if self.is_bound {
            State::UpperBound
        } else {
            State::NotObservable { after_s: None }
        };
        // The root of the product, whose factors may be far from one.
        let root = |square: f32| real(sqrt(square)) * root_of_unit;
        let squared = |square: f32| real(square) * root_of_unit * root_of_unit;
        Coefficient {
            name,
            symbol,
            half_seconds,
            value: root(self.square),
            lower: root(self.lower),
            upper: root(self.upper),
            state,
            square: squared(self.square),
            square_error: squared(self.error),
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
    let is_clear: IsClear<'_, K> = &|_, tableau, _| is_certain(tableau, term);
    if iterate(rows, tableau, start, ROUGHLY, [guess, held], is_clear).is_none() {
        return false;
    }
    let fall = tableau.solve(0, 0);
    !(tableau.has(term) && fall > CHI_SQUARED_95 as f32)
}
