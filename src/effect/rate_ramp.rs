use super::{Effect, Explain, Response, Setting, Story};
use crate::real::Real;

/// Rate ramp, coefficient R in rate / s: the rate drifts steadily, the same in every difference.
///
/// `G(n) = τ₀⁴ n⁴/24`; `σ²(τ) = R²τ²/2` (IEEE Std 952-1997, eq. C.22).
#[derive(Clone, Copy, Debug)]
pub struct RateRamp;

impl Effect for RateRamp {
    fn name(&self) -> &'static str {
        "rate_ramp"
    }

    fn symbol(&self) -> &'static str {
        "R"
    }

    fn half_seconds(&self) -> i8 {
        -2
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        let t2 = setting.interval_s * setting.interval_s;
        let n2 = lag * lag;
        t2 * t2 * n2 * n2 / 24.0
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        let t2 = setting.interval_s * setting.interval_s;
        let m2 = m * m;
        t2 * t2 * m2 * (0.5 * x * x + m2 / 12.0)
    }

    fn response(&self, m: Real, setting: &Setting) -> Option<Response> {
        // Every difference is Rτ, wherever it lies.
        let tau_s = m * setting.interval_s;
        Some(Response {
            amplitude: tau_s * tau_s,
            phase: 0.0,
        })
    }
}

impl Explain for RateRamp {
    fn story(&self) -> Story {
        Story {
            what: "rate ramp: the rate drifts steadily",
            origin: "warming up after power-on, a steady temperature gradient, a slow turn of the mount",
            check: "let the sensor warm up before recording; log temperature beside the rate",
        }
    }
}
