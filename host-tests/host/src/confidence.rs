//! Confidence limits of each octave of a curve.

use allanite::{
    Curve, Model,
    fit::{Fit, curve_covariance},
};
use allanite_log::OCTAVES;
use statrs::distribution::{Beta, ChiSquared, ContinuousCDF};

/// Half-width of the two-sided 95 % interval of a normal variable, in standard errors (Abramowitz & Stegun
/// 1964, table 26.5). The library's own constant is not public.
pub const TWO_SIDED_95: f64 = 1.959_964;

/// The number of standard errors that a normal variable exceeds with a probability of 5 % (same table).
pub const ONE_SIDED_95: f64 = 1.644_854;

/// Probability below the lower limit and above the upper limit, which leaves 95 % between them.
const TAIL: f64 = 0.025;

/// The quantile of the normal distribution beyond which [`TAIL`] lies.
const NORMAL: f64 = 1.959_963_984_540_054;

/// More degrees of freedom than these are many.
const MANY: f64 = 1e5;

/// The confidence limits of an octave's true Allan variance, in rate units squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Lower end of the 95 % interval.
    pub lower: f64,
    /// Upper end of the 95 % interval.
    pub upper: f64,
}

/// The two-sided 95 % interval of every octave, each by itself.
///
/// An estimate of variance `σ̂²` is distributed as `σ² χ²_ν/ν` with the equivalent degrees of freedom
/// `ν = 2 σ⁴ / Var(σ̂²)` (NIST SP 1065, 2008, section 5.4). σ² is the variance of the fitted model, and
/// Var(σ̂²) is taken from the covariance of the curve at this model. The interval is
/// `σ̂² ν/χ²_ν(0.975) … σ̂² ν/χ²_ν(0.025)`.
pub fn limits(curve: &Curve<OCTAVES>, model: &Model, fit: &Fit) -> Vec<Limits> {
    let errors = relative_errors(curve, model, fit);
    let octaves = curve.points().iter().zip(errors);
    octaves
        .map(|(point, error)| interval(point.variance, 2.0 / (error * error)))
        .collect()
}

/// The standard error of every octave's Allan variance, relative to the variance. It follows from the covariance of the
/// curve at a fitted model.
pub fn relative_errors(curve: &Curve<OCTAVES>, model: &Model, fit: &Fit) -> Vec<f64> {
    let squares = fit.squares();
    let covariance = curve_covariance(curve, model, &squares);
    let octaves = curve.points().iter().enumerate();
    octaves
        .map(|(k, point)| {
            let variance = model.variance(&squares, point.m, curve.interval_s());
            covariance[(k, k)].sqrt() / variance
        })
        .collect()
}

/// The interval of a variance with these degrees of freedom.
fn interval(variance: f64, freedom: f64) -> Limits {
    // No estimate has less than one degree of freedom, and no model is accurate enough for more than
    // 10¹² to matter.
    let freedom = if freedom.is_finite() {
        freedom.clamp(1.0, 1e12)
    } else {
        1.0
    };
    // With many degrees of freedom the exact quantiles take seconds, and the approximation of Wilson &
    // Hilferty (1931) is right to 10⁻⁷.
    if freedom > MANY {
        let part = 2.0 / (9.0 * freedom);
        let quantile = |z: f64| (1.0 - part + z * part.sqrt()).powi(3);
        return Limits {
            lower: variance / quantile(NORMAL),
            upper: variance / quantile(-NORMAL),
        };
    }
    match ChiSquared::new(freedom) {
        Ok(distribution) => Limits {
            lower: variance * freedom / distribution.inverse_cdf(1.0 - TAIL),
            upper: variance * freedom / distribution.inverse_cdf(TAIL),
        },
        Err(_) => Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        },
    }
}

/// The value that a probability is at most, with this confidence, if its event was a share of `trials` (Clopper &
/// Pearson, Biometrika 26, 404, 1934).
pub fn share_is_at_most(share: f64, trials: u64, confidence: f64) -> f64 {
    let count = (share * trials as f64).round();
    let others = trials as f64 - count;
    let beta = Beta::new(count + 1.0, others).ok();
    // Without others, the probability may be one.
    beta.map_or(1.0, |beta| beta.inverse_cdf(confidence))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_the_tables() {
        // χ² quantiles of 10 degrees of freedom, Abramowitz & Stegun 1964, table 26.8.
        let limits = interval(1.0, 10.0);
        assert!((10.0 / limits.upper - 3.246_97).abs() < 1e-4, "{limits:?}");
        assert!((10.0 / limits.lower - 20.483_2).abs() < 1e-3, "{limits:?}");
    }

    #[test]
    fn approximation_for_many_degrees_of_freedom_joins_the_exact_limits() {
        let [below, above] = [0.999, 1.001].map(|factor| interval(1.0, MANY * factor));
        let change = 1.96 * (2.0 / MANY).sqrt() * 0.001;
        assert!((below.upper - above.upper - change).abs() < 2e-7);
        assert!((above.lower - below.lower - change).abs() < 2e-7);
    }

    #[test]
    fn many_degrees_of_freedom_leave_a_normal_interval() {
        let limits = interval(2.0, 1e8);
        let error = 2.0 * (2.0_f64 / 1e8).sqrt();
        assert!(((limits.upper - 2.0) / error - 1.96).abs() < 0.01);
        assert!(((2.0 - limits.lower) / error - 1.96).abs() < 0.01);
    }
}
