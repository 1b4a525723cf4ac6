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
        /// where no length up to 2^30 samples would.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        effect::{AngleRandomWalk, BiasInstability},
        real::{by_precision, double},
        test_random::Random,
    };

    /// What roots of squares may differ by, in rounding errors of the square.
    const ROUNDING: f64 = if cfg!(feature = "double") {
        1e-14
    } else {
        1e-6
    };

    fn assert_close(found: Real, expected: f64) {
        let off = (double(found) - expected).abs();
        assert!(off <= ROUNDING * expected.abs(), "{found}, not {expected}");
    }

    #[test]
    fn a_coefficient_is_measured_where_its_square_exceeds_half_its_interval() {
        let mut random = Random::new(51);
        let mut measured = 0;
        for _ in 0..1000 {
            let (square, error) = (4.0 * random.signed(), 1.0 + random.signed());
            let found = Coefficient::new(&AngleRandomWalk, real(square), Some(real(error * error)));
            let half = 1.959_964 * error;
            if (square / half - 1.0).abs() < 1e-4 {
                continue;
            }
            if square > half {
                assert_eq!(found.state, State::Measured);
                // The difference has as many digits as the two have.
                let below = double(found.lower) * double(found.lower);
                assert!((below - (square - half)).abs() <= 4.0 * ROUNDING * square);
                assert_close(found.upper, libm::sqrt(square + half));
                measured += 1;
            } else {
                assert_eq!((found.state, found.lower), (State::UpperBound, 0.0));
                let bound = square.max(0.0) + 1.644_854 * error;
                assert_close(found.upper, libm::sqrt(bound));
            }
            assert_close(found.value, libm::sqrt(square.max(0.0)));
            assert_close(found.square_error, error);
            assert_eq!(found.square, real(square));
        }
        assert!((200..800).contains(&measured), "{measured}");
    }

    #[test]
    fn a_coefficient_without_a_variance_is_not_observable() {
        for square in [0.0, 3.0] {
            let found = Coefficient::new(&BiasInstability, square, None);
            assert_eq!(found.state, State::NotObservable { after_s: None });
            assert_eq!((found.lower, found.upper), (0.0, Real::INFINITY));
            assert_eq!(found.square_error, Real::INFINITY);
            assert_eq!((found.name, found.symbol), ("bias_instability", "B"));
        }
    }

    #[test]
    fn units_of_the_variance_scale_squares_and_their_roots() {
        let unit = by_precision(1e-20, 1e-10);
        let plain = Coefficient::new(&AngleRandomWalk, 9.0, Some(4.0));
        let scaled = plain.in_unit(unit);
        let direct = Coefficient::new(&AngleRandomWalk, 9.0 * unit, Some(4.0 * unit * unit));
        for (found, expected) in [
            (scaled.value, direct.value),
            (scaled.lower, direct.lower),
            (scaled.upper, direct.upper),
            (scaled.square, direct.square),
            (scaled.square_error, direct.square_error),
        ] {
            assert!((found / expected - 1.0).abs() <= by_precision(1e-14, 1e-6));
        }
        assert_eq!(scaled.state, plain.state);
    }
}
