//! A coefficient, and what a record says about it.

use crate::{
    limits::ONE_SIDED_95,
    numerics::{
        math,
        nnls::Interval,
        real::{Real, real},
    },
    theory::effect::Effect,
};

/// What a record says about a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum State {
    /// The 95 % interval excludes zero.
    Measured,
    /// The 95 % interval includes zero, and `upper` is a one-sided 95 % bound.
    UpperBound,
    /// The record says nothing about the coefficient. Either other effects could take its place, or its
    /// bound says no more than that the effect cannot exceed the whole curve.
    NotObservable {
        /// The length of a record, in seconds, that would measure the coefficient if it were at its
        /// bound. `None` if no length up to 2^30 samples would.
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
    /// Twice the exponent of the second in the unit, which is rate unit · s^(half_seconds/2).
    pub half_seconds: i8,
    /// Best value. It is zero where the square is negative, which only unconstrained methods return.
    pub value: Real,
    /// Lower end of the 95 % interval; zero unless the coefficient is measured.
    pub lower: Real,
    /// Upper end of the 95 % interval, or the one-sided 95 % bound. It is infinite if the effect cannot
    /// be distinguished from others.
    pub upper: Real,
    /// Whether the coefficient is measured, bounded or not observable.
    pub state: State,
    /// The squared coefficient. The fit is linear in the squares.
    pub square: Real,
    /// Standard error of the square; infinite where `upper` is.
    pub square_error: Real,
}

impl Coefficient {
    /// Lets the interval of a measured coefficient hold another one too.
    pub(crate) fn widen(&mut self, lower: Real, upper: Real) {
        if self.state == State::Measured {
            self.lower = self.lower.min(lower);
            self.upper = self.upper.max(upper);
        }
    }

    /// A coefficient from its square and the interval of the square. The interval is `None` where the fit
    /// cannot tell the effect from others.
    pub(crate) fn new(effect: &dyn Effect, square: Real, interval: Option<Interval>) -> Self {
        let error = interval.map_or(Real::INFINITY, |interval| math::sqrt(interval.variance));
        let root = |square: Real| {
            if square > 0.0 {
                math::sqrt(square)
            } else {
                0.0
            }
        };
        let (state, lower, upper) = match interval {
            Some(interval) if interval.lower > 0.0 => {
                (State::Measured, interval.lower, interval.upper)
            }
            Some(interval) => {
                let bound = Self::one_sided_bound(square, interval.variance);
                (State::UpperBound, 0.0, bound)
            }
            None => (State::NotObservable { after_s: None }, 0.0, Real::INFINITY),
        };
        Self {
            name: effect.name(),
            symbol: effect.symbol(),
            half_seconds: effect.half_seconds(),
            value: root(square),
            lower: root(lower),
            upper: root(upper),
            state,
            square,
            square_error: error,
        }
    }

    /// The same coefficient for a curve whose variances are `unit` times as large.
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
        numerics::{
            real::{by_precision, double},
            test_random::Random,
        },
        theory::effect::{AngleRandomWalk, BiasInstability},
    };

    /// The relative tolerance for roots of squares, which covers the rounding errors of the squares.
    const ROUNDING: f64 = if cfg!(feature = "double") {
        1e-14
    } else {
        1e-6
    };

    fn normal(square: f64, variance: f64) -> Interval {
        Interval::normal(real(square), real(variance), 1.0)
    }

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
            let found = Coefficient::new(
                &AngleRandomWalk,
                real(square),
                Some(normal(square, error * error)),
            );
            let half = 1.959_964 * error;
            if (square / half - 1.0).abs() < 1e-4 {
                continue;
            }
            if square > half {
                assert_eq!(found.state, State::Measured);
                // Rounding errors of the difference are relative to its two terms.
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
    fn a_unit_of_the_variance_scales_squares_and_coefficients() {
        let unit = by_precision(1e-20, 1e-10);
        let plain = Coefficient::new(&AngleRandomWalk, 9.0, Some(normal(9.0, 4.0)));
        let scaled = plain.in_unit(unit);
        let variance = 4.0 * unit * unit;
        let interval = Interval::normal(9.0 * unit, variance, 1.0);
        let direct = Coefficient::new(&AngleRandomWalk, 9.0 * unit, Some(interval));
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
