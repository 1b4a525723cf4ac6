use super::{Effect, Explain, SecondDifferences, Setting, Story};
use crate::real::Real;

/// Angle random walk, coefficient N in rate · √s: white rate noise of two-sided density N².
///
/// `G(n) = −τ₀ n/2`; `σ²(τ) = N²/τ` (IEEE Std 952-1997, eq. C.13).
#[derive(Clone, Copy, Debug)]
pub struct AngleRandomWalk;

impl Effect for AngleRandomWalk {
    fn name(&self) -> &'static str {
        "angle_random_walk"
    }

    fn symbol(&self) -> &'static str {
        "N"
    }

    fn half_seconds(&self) -> i8 {
        1
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        -0.5 * setting.interval_s * lag
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        // Beyond a cluster the straight lines cancel exactly.
        if x < m {
            setting.interval_s * (x - m)
        } else {
            0.0
        }
    }
    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        sum.add_below(m, m, |x| weight * self.second_difference(x, m, setting));
    }
}

impl Explain for AngleRandomWalk {
    fn story(&self) -> Story {
        Story {
            what: "angle random walk: white noise of the rate",
            origin: "thermo-mechanical noise of the proof mass, photon shot noise, the front end's amplifier",
            check: "compare with the datasheet's noise density; does the sensor's power mode change it?",
        }
    }
}
