//! Whether a device keeps a limit, and the guard band that the uncertainty of its measurement demands.

use super::{Measurement, quantile_above};
use statrs::distribution::{ContinuousCDF as _, Normal};

/// A device beside a limit, by the rule of guarded acceptance and guarded rejection (JCGM 106:2012, 8.3), the best decision
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Decision {
    /// The probability that the coefficient is above the limit is at most the risk.
    Passed,
    /// The record is too short to tell, or the coefficient is not observable.
    Guarded,
    /// No model explains the record, so that no interval says anything about a limit.
    Misfit,
    /// Something happened during the record, so that its coefficients stand for a mixture.
    NotStationary,
    /// The record is not one of a gyro at rest.
    Invalid,
    /// The probability that the coefficient is within the limit is at most the risk.
    Failed,
}

impl Measurement {
    /// The probability that the coefficient is at most `limit`, `Φ((limit² − square)/u)` (JCGM 106:2012, section 7.3, for
    /// squares). It rests on this measurement, and not on which values the other devices of the lot have.
    ///
    /// Below the limit, `u` is the uncertainty towards larger squares, or the `error` that a device at the limit would have
    /// if that is larger. Above it, `u` is the uncertainty towards smaller squares.
    pub fn conformity(&self, limit: f64, error: f64) -> f64 {
        let distance = limit * limit - self.square;
        let uncertainty = if distance >= 0.0 {
            self.above.max(error)
        } else {
            self.below
        };
        if uncertainty > 0.0 {
            Normal::standard().cdf(distance / uncertainty)
        } else {
            f64::from(u8::from(distance >= 0.0))
        }
    }

    /// The decision for this limit. `error` is that of the square of a device at the limit, and `risk`, below ½, the
    /// largest probability that the decision is wrong.
    pub fn decision(&self, limit: f64, error: f64, risk: f64) -> Decision {
        let conformity = self.conformity(limit, error);
        if !self.is_observable {
            return Decision::Guarded;
        }
        if 1.0 - conformity <= risk {
            Decision::Passed
        } else if conformity <= risk {
            Decision::Failed
        } else {
            Decision::Guarded
        }
    }
}

/// The acceptance limit: a device passes if its value is at most this, and its uncertainty is usual for the lot. The guard
/// band is the rest up to `limit`.
///
/// It is `√(limit² − z e)`, where `e` is the error of the square of a device at the limit, and a normal variable exceeds `z`
/// with the probability `risk`. `None` if even a value of zero does not pass.
pub fn acceptance_limit(limit: f64, error: f64, risk: f64) -> Option<f64> {
    let square = limit * limit - quantile_above(risk) * error;
    (square > 0.0).then(|| square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: f64 = 0.0054;

    fn measured(value: f64, uncertainty: f64) -> Measurement {
        Measurement {
            square: value * value,
            above: uncertainty,
            below: uncertainty,
            error: uncertainty,
            is_measured: true,
            is_observable: true,
        }
    }

    /// `scipy.stats.norm.cdf((0.0054**2 - 0.005**2)/3e-6)`.
    #[test]
    fn conformity_is_that_of_the_normal_distribution() {
        let conformity = measured(0.005, 3e-6).conformity(LIMIT, 0.0);
        assert!(
            (conformity - 0.917_228_285_310_6).abs() < 1e-10,
            "{conformity}"
        );
        let certain = measured(0.005, 0.0);
        assert_eq!(
            (
                certain.conformity(LIMIT, 0.0),
                certain.conformity(0.004, 0.0)
            ),
            (1.0, 0.0)
        );
    }

    #[test]
    fn sides_of_a_limit_have_their_own_uncertainties() {
        let mut one = measured(0.005, 3e-6);
        one.above = 1e-3;
        // Nearly nothing is known of larger squares, and smaller ones are excluded.
        assert!((one.conformity(LIMIT, 0.0) - 0.5).abs() < 0.01);
        assert_eq!(one.decision(LIMIT, 0.0, 0.1), Decision::Guarded);
        assert_eq!(one.decision(0.004, 0.0, 0.1), Decision::Failed);
    }

    #[test]
    fn a_smaller_risk_widens_the_guard_band() {
        let one = measured(0.005, 3e-6);
        assert_eq!(one.decision(LIMIT, 0.0, 0.1), Decision::Passed);
        assert_eq!(one.decision(LIMIT, 0.0, 0.08), Decision::Guarded);
        let unknown = Measurement {
            is_observable: false,
            ..one
        };
        assert_eq!(unknown.decision(LIMIT, 0.0, 0.1), Decision::Guarded);
        let worse = measured(0.0058, 3e-6);
        assert_eq!(worse.decision(LIMIT, 0.0, 0.1), Decision::Failed);
        assert_eq!(worse.decision(LIMIT, 0.0, 0.01), Decision::Guarded);
    }

    #[test]
    fn the_error_at_the_limit_counts_where_it_is_the_larger_one() {
        let one = measured(0.005, 3e-6);
        assert_eq!(one.decision(LIMIT, 0.0, 0.1), Decision::Passed);
        assert_eq!(one.decision(LIMIT, 2e-6, 0.1), Decision::Passed);
        assert_eq!(one.decision(LIMIT, 4e-6, 0.1), Decision::Guarded);
        // A device above the limit has its own.
        let worse = measured(0.0058, 3e-6);
        assert_eq!(worse.decision(LIMIT, 4e-6, 0.1), Decision::Failed);
    }

    /// `scipy.stats.norm.isf(0.025)` is 1.959963985, that of 0.05 is 1.644853627.
    #[test]
    fn a_device_at_the_acceptance_limit_has_the_stated_risk() {
        let error = 0.05 * LIMIT * LIMIT;
        for (risk, quantile) in [(0.025, 1.959_963_985), (0.05, 1.644_853_627)] {
            let accepted = acceptance_limit(LIMIT, error, risk).unwrap();
            let expected = LIMIT * (1.0_f64 - 0.05 * quantile).sqrt();
            assert!(
                (accepted / expected - 1.0).abs() < 1e-9,
                "{risk}: {accepted}"
            );
            let there = measured(accepted, 0.0);
            assert!((1.0 - there.conformity(LIMIT, error) - risk).abs() < 1e-9);
        }
        assert_eq!(acceptance_limit(LIMIT, LIMIT * LIMIT, 0.025), None);
    }
}
