//! A measured coefficient with its uncertainty.

use crate::confidence::{ONE_SIDED_95, TWO_SIDED_95};
use allanite::storage::{CertifiedState, CertifiedTerm};

/// The square of a coefficient with its standard uncertainties.
///
/// A certificate has the 95 % interval by the likelihood ratio, which is longer on the side on which the record tells
/// less. So each side has a standard uncertainty of its own: the distance of the interval's end from the square, over
/// that of a normal variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The squared coefficient.
    pub square: f64,
    /// The standard uncertainty towards larger squares.
    pub above: f64,
    /// The standard uncertainty towards smaller squares.
    pub below: f64,
    /// The standard error of the square by propagation of errors.
    pub error: f64,
    /// Whether the interval of the coefficient excludes zero.
    pub is_measured: bool,
    /// Whether the record says more than that the effect cannot exceed the whole curve. If not, the upper end still bounds
    /// the coefficient for a comparison, and nothing is decided by it.
    pub is_observable: bool,
}

impl Measurement {
    /// The measurement of a term; `None` if the coefficient has no finite bound.
    pub fn of(term: &CertifiedTerm) -> Option<Self> {
        let [value, lower, upper] = [term.value, term.lower, term.upper].map(f64::from);
        let (is_measured, quantile) = match term.state {
            CertifiedState::Measured => (true, TWO_SIDED_95),
            CertifiedState::UpperBound | CertifiedState::NotObservable { .. } => {
                (false, ONE_SIDED_95)
            }
        };
        let is_observable = !matches!(term.state, CertifiedState::NotObservable { .. });
        let square = value * value;
        let above = (upper * upper - square) / quantile;
        let below = (square - lower * lower) / quantile;
        let error = f64::from(term.square_error);
        let is_known = [above, below, error].iter().all(|one| one.is_finite());
        is_known.then_some(Self {
            square,
            above: above.max(0.0),
            below: below.max(0.0),
            error,
            is_measured,
            is_observable,
        })
    }

    /// The best value of the coefficient.
    pub fn value(&self) -> f64 {
        self.square.sqrt()
    }

    /// The lower end of the coefficient's 95 % interval; zero if it is not measured.
    pub fn lower(&self) -> f64 {
        if self.is_measured {
            (self.square - TWO_SIDED_95 * self.below).max(0.0).sqrt()
        } else {
            0.0
        }
    }

    /// The upper end of the coefficient's 95 % interval, or its one-sided 95 % bound.
    pub fn upper(&self) -> f64 {
        let quantile = if self.is_measured {
            TWO_SIDED_95
        } else {
            ONE_SIDED_95
        };
        (self.square + quantile * self.above).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::{effect::AngleRandomWalk, storage::EffectCode};

    fn term(value: f32, lower: f32, upper: f32, state: CertifiedState) -> CertifiedTerm {
        CertifiedTerm {
            effect: EffectCode::of(&AngleRandomWalk),
            value,
            lower,
            upper,
            square_error: 0.25,
            state,
            shape: Default::default(),
        }
    }

    #[test]
    fn each_side_of_an_interval_has_its_own_uncertainty() {
        let measured = term(2.0, 1.0, 3.0, CertifiedState::Measured);
        let measured = Measurement::of(&measured).unwrap();
        assert_eq!((measured.square, measured.error), (4.0, 0.25));
        assert!((measured.above - 5.0 / 1.959_964).abs() < 1e-9);
        assert!((measured.below - 3.0 / 1.959_964).abs() < 1e-9);
        assert!((measured.lower() - 1.0).abs() < 1e-9 && (measured.upper() - 3.0).abs() < 1e-9);
        // The bound is one-sided.
        let bound = term(0.0, 0.0, 2.0, CertifiedState::UpperBound);
        let bound = Measurement::of(&bound).unwrap();
        assert!((bound.above - 4.0 / 1.644_854).abs() < 1e-5 && !bound.is_measured);
        assert_eq!((bound.value(), bound.lower()), (0.0, 0.0));
        assert!((bound.upper() - 2.0).abs() < 1e-9);
        assert!(bound.is_observable);
        let unknown = CertifiedState::NotObservable { after_s: None };
        let loose = Measurement::of(&term(0.0, 0.0, 2.0, unknown)).unwrap();
        assert!(!loose.is_observable && loose.above == bound.above);
        let nothing = term(0.0, 0.0, f32::INFINITY, unknown);
        assert_eq!(Measurement::of(&nothing), None);
    }
}
