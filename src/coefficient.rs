//! A coefficient, and what a record says of it.

use crate::{
    effect::Effect,
    limits::{ONE_SIDED_95, TWO_SIDED_95},
    math,
    real::{Real, real},
};

/// What a record says of a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum State {
    /// Its 95 % interval excludes zero.
    Measured,
    /// Zero is within its interval: `upper` bounds it, one-sided, at 95 %.
    UpperBound,
    /// The record says nothing of it: other effects could take its place, or its bound is no better
    /// than that it cannot exceed the whole curve.
    NotObservable {
        /// Length of a record, in seconds, that would measure it if it were at its bound; `None`
        /// where no length up to 2^29 samples would.
        after_s: Option<Real>,
    },
}

/// The coefficient of one effect, in the curve's rate unit and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Coefficient {
    /// The effect's name, such as `angle_random_walk`.
    pub name: &'static str,
    /// The coefficient's symbol, such as `N`.
    pub symbol: &'static str,
    /// The unit is rate unit · s^(half_seconds/2).
    pub half_seconds: i8,
    /// Best value; zero where the square is negative, which only unconstrained methods return.
    pub value: Real,
    /// Lower end of the 95 % interval; zero unless measured.
    pub lower: Real,
    /// Upper end of the 95 % interval, or the one-sided 95 % bound; infinite if the effect cannot
    /// be told from others.
    pub upper: Real,
    /// Whether it was measured.
    pub state: State,
    /// The squared coefficient, which is what the fit is linear in.
    pub square: Real,
    /// Standard error of the square; infinite as `upper`.
    pub square_error: Real,
}

impl Coefficient {
    /// A squared coefficient and its variance; `None` where the fit cannot tell the effect from
    /// others.
    pub(crate) fn new(effect: &dyn Effect, square: Real, variance: Option<Real>) -> Self {
        let error = variance.map_or(Real::INFINITY, math::sqrt);
        let root = |square: Real| {
            if square > 0.0 {
                math::sqrt(square)
            } else {
                0.0
            }
        };
        let half_width = real(TWO_SIDED_95) * error;
        let below = square - half_width;
        let (state, upper) = if below > 0.0 {
            (State::Measured, square + half_width)
        } else if error.is_finite() {
            (
                State::UpperBound,
                Self::one_sided_bound(square, error * error),
            )
        } else {
            (State::NotObservable { after_s: None }, Real::INFINITY)
        };
        Self {
            name: effect.name(),
            symbol: effect.symbol(),
            half_seconds: effect.half_seconds(),
            value: root(square),
            lower: root(below),
            upper: root(upper),
            state,
            square,
            square_error: error,
        }
    }

    /// That of a curve whose variances are so many times larger.
    pub(crate) fn in_unit(self, unit: Real) -> Self {
        let root = math::sqrt(unit);
        Self {
            value: self.value * root,
            lower: self.lower * root,
            upper: self.upper * root,
            square: self.square * unit,
            square_error: self.square_error * unit,
            ..self
        }
    }

    /// One-sided 95 % bound of a square that cannot be negative.
    pub(crate) fn one_sided_bound(square: Real, variance: Real) -> Real {
        square.max(0.0) + real(ONE_SIDED_95) * math::sqrt(variance)
    }
}
