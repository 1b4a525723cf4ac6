use super::{Description, Distribution, Effect, Explain, Explanation, Response, SampledShape};
use crate::numerics::real::Real;

/// Rate ramp: the rate drifts steadily, so that all differences are the same. The coefficient is `R`
/// in rate / s.
///
/// `G(n) = τ₀⁴ n⁴/24` and `σ²(τ) = R²τ²/2` (IEEE Std 952-1997, eq. C.22).
#[derive(Clone, Copy, Debug)]
pub struct RateRamp;

pub(super) static DESCRIPTION: Description = Description {
    name: "rate_ramp",
    symbol: "R",
    coefficient: "rate_ramp",
    half_seconds: -2,
    reference_s: None,
    parameters: &[],
    code: 5,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Deterministic,
};

impl Effect for RateRamp {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let t2 = shape.interval_s * shape.interval_s;
        let n2 = lag * lag;
        t2 * t2 * n2 * n2 / 24.0
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let t2 = shape.interval_s * shape.interval_s;
        let m2 = m * m;
        t2 * t2 * m2 * (0.5 * x * x + m2 / 12.0)
    }

    fn response(&self, m: Real, shape: &SampledShape) -> Option<Response> {
        // Every difference is Rτ, wherever it lies.
        let tau_s = m * shape.interval_s;
        Some(Response {
            amplitude: tau_s * tau_s,
            phase: 0.0,
        })
    }
}

impl Explain for RateRamp {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a rate ramp: the rate drifts steadily",
            origin: "warming up after power-on, a steady temperature gradient, a slow turn of the mount",
            check: "let the sensor warm up before recording; log temperature beside the rate",
        }
    }
}
