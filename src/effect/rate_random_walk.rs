use super::{Effect, Explain, SecondDifferences, Setting, Story};
use crate::real::Real;

/// Rate random walk, coefficient K in rate / √s: the rate is a walk, stepped once a sample.
///
/// `G(n) = τ₀³ (n³ − n)/12`; `σ² = K²τ₀ (2m² + 1)/6m`, the `K²τ/3` of IEEE Std 952-1997, eq. C.19,
/// for a sampled walk.
#[derive(Clone, Copy, Debug)]
pub struct RateRandomWalk;

impl Effect for RateRandomWalk {
    fn name(&self) -> &'static str {
        "rate_random_walk"
    }

    fn symbol(&self) -> &'static str {
        "K"
    }

    fn half_seconds(&self) -> i8 {
        -1
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        let t = setting.interval_s;
        t * t * t * lag * (lag * lag - 1.0) / 12.0
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        let t = setting.interval_s;
        let cubic = if x < m {
            // 2m³ + 6mx² − 2x³, less 2(m − x) for the linear part of the kernel.
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
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        sum.add_below(m, m, |x| weight * self.second_difference(x, m, setting));
        let t = setting.interval_s;
        let slope = 0.5 * weight * t * t * t * m * m;
        sum.add_from(m, |x| slope * x);
    }
}

impl Explain for RateRandomWalk {
    fn story(&self) -> Story {
        Story {
            what: "rate random walk: the rate itself wanders",
            origin: "ageing, slow temperature drift, creep of the package's stress",
            check: "log temperature beside the rate and record for longer",
        }
    }
}
