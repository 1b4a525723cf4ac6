use super::{
    Description, Distribution, Effect, Explain, Explanation, SampledShape, SecondDifferences,
};
use crate::numerics::real::Real;

/// Angle random walk, which is white noise of the rate. The coefficient is `N` in rate · √s; the
/// two-sided spectral density of the rate is `N²`.
///
/// `G(n) = −τ₀ n/2` and `σ²(τ) = N²/τ` (IEEE Std 952-1997, eq. C.13).
#[derive(Clone, Copy, Debug)]
pub struct AngleRandomWalk;

pub(super) static DESCRIPTION: Description = Description {
    name: "angle_random_walk",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[],
    code: 2,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for AngleRandomWalk {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        -0.5 * shape.interval_s * lag
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        // For x ≥ m all three terms lie on one straight line, and cancel.
        if x < m {
            shape.interval_s * (x - m)
        } else {
            0.0
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        sum.add_below(m, m, |x| weight * self.second_difference(x, m, shape));
    }
}

impl Explain for AngleRandomWalk {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "angle random walk: white noise of the rate",
            origin: "thermo-mechanical noise of the proof mass, photon shot noise, the front end's amplifier",
            check: "compare with the datasheet's noise density; does the sensor's power mode change it?",
        }
    }
}
