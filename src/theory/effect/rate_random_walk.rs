use super::{
    Description, Distribution, Effect, Explain, Explanation, SampledShape, SecondDifferences,
};
use crate::numerics::real::Real;

/// Rate random walk: the rate takes a random step once a sample. The coefficient is `K` in
/// rate / √s; a step has the variance `K²τ₀`.
///
/// `G(n) = τ₀³ (n³ − n)/12` and `σ² = K²τ₀ (2m² + 1)/6m`, which for `m ≫ 1` is the `K²τ/3` of IEEE
/// Std 952-1997, eq. C.19.
#[derive(Clone, Copy, Debug)]
pub struct RateRandomWalk;

pub(super) static DESCRIPTION: Description = Description {
    name: "rate_random_walk",
    symbol: "K",
    coefficient: "rate_random_walk",
    half_seconds: -1,
    reference_s: None,
    parameters: &[],
    code: 4,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for RateRandomWalk {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let t = shape.interval_s;
        t * t * t * lag * (lag * lag - 1.0) / 12.0
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let t = shape.interval_s;
        let cubic = if x < m {
            // The cubic part of the kernel gives 2m³ + 6mx² − 2x³, the linear part −2(m − x).
            (m * (m * m + 3.0 * x * x - 1.0) - x * (x * x - 1.0)) / 6.0
        } else {
            0.5 * x * m * m
        };
        t * t * t * cubic
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        sum.add_below(m, m, |x| weight * self.second_difference(x, m, shape));
        let t = shape.interval_s;
        let slope = 0.5 * weight * t * t * t * m * m;
        sum.add_from(m, |x| slope * x);
    }
}

impl Explain for RateRandomWalk {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "rate random walk: the rate wanders by independent random steps",
            origin: "ageing, slow temperature drift, creep of the package's stress",
            check: "log temperature beside the rate and record for longer",
        }
    }
}
