//! Whether a device keeps a limit, and the guard band that the uncertainty of its measurement demands.

use super::{Measurement, quantile_above};
use statrs::distribution::{ContinuousCDF as _, Normal};

/// A device beside a limit, by the rule of guarded acceptance and guarded rejection (JCGM 106:2012, 8.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Decision {
    /// The probability that the coefficient is above the limit is at most the risk.
    Passed,
    /// The record is too short to tell, or the coefficient is not observable.
    Guarded,
    /// The probability that the coefficient is within the limit is at most the risk.
    Failed,
}

impl Measurement {
    /// The probability that the coefficient is at most `limit`, `Φ((limit² − square)/u)` (JCGM 106:2012, section 7.3, for
    /// squares). It rests on this measurement alone, and not on what the other devices of the lot are like.
    pub fn conformity(&self, limit: f64) -> f64 {
        let distance = limit * limit - self.square;
        let uncertainty = if distance >= 0.0 {
            self.above
        } else {
            self.below
        };
        if uncertainty > 0.0 {
            Normal::standard().cdf(distance / uncertainty)
        } else {
            f64::from(u8::from(distance >= 0.0))
        }
    }

    /// The decision for this limit. `risk`, below ½, is the largest probability that it is wrong.
    pub fn decision(&self, limit: f64, risk: f64) -> Decision {
        let conformity = self.conformity(limit);
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
/// `relative` is the usual standard uncertainty of a square, relative to the square. It stays the same at the limit where
/// the coefficient dominates its octaves, and is a cautious choice for one that others hide and that lies below the
/// limit. So `A² (1 + z u) = limit²`, where a normal variable exceeds `z` with the probability `risk`.
pub fn acceptance_limit(limit: f64, relative: f64, risk: f64) -> f64 {
    limit / (1.0 + quantile_above(risk) * relative).sqrt()
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
        let conformity = measured(0.005, 3e-6).conformity(LIMIT);
        assert!(
            (conformity - 0.917_228_285_310_6).abs() < 1e-10,
            "{conformity}"
        );
        let certain = measured(0.005, 0.0);
        assert_eq!(
            (certain.conformity(LIMIT), certain.conformity(0.004)),
            (1.0, 0.0)
        );
    }

    #[test]
    fn sides_of_a_limit_have_their_own_uncertainties() {
        let mut one = measured(0.005, 3e-6);
        one.above = 1e-3;
        // Nearly nothing is known of larger squares, and smaller ones are excluded.
        assert!((one.conformity(LIMIT) - 0.5).abs() < 0.01);
        assert_eq!(one.decision(LIMIT, 0.1), Decision::Guarded);
        assert_eq!(one.decision(0.004, 0.1), Decision::Failed);
    }

    #[test]
    fn a_smaller_risk_widens_the_guard_band() {
        let one = measured(0.005, 3e-6);
        assert_eq!(one.decision(LIMIT, 0.1), Decision::Passed);
        assert_eq!(one.decision(LIMIT, 0.08), Decision::Guarded);
        let unknown = Measurement {
            is_observable: false,
            ..one
        };
        assert_eq!(unknown.decision(LIMIT, 0.1), Decision::Guarded);
        let worse = measured(0.0058, 3e-6);
        assert_eq!(worse.decision(LIMIT, 0.1), Decision::Failed);
        assert_eq!(worse.decision(LIMIT, 0.01), Decision::Guarded);
    }

    /// The quantiles are those of `scipy.stats.norm.isf`.
    #[test]
    fn a_device_at_the_acceptance_limit_has_the_stated_risk() {
        for (risk, expected) in [(0.025, 0.005_153_389_235), (0.05, 0.005_190_765_758)] {
            let accepted = acceptance_limit(LIMIT, 0.05, risk);
            assert!((accepted - expected).abs() < 1e-11, "{risk}: {accepted}");
            let there = measured(accepted, 0.05 * accepted * accepted);
            assert!((1.0 - there.conformity(LIMIT) - risk).abs() < 1e-9);
        }
    }
}
