use super::{Effect, Explain, Setting, Story};
use crate::lattice::SecondDifferences;
use crate::real::Real;

/// Quantization noise, coefficient Q in rate · s (an angle): the angle is rounded, or jitters, by an
/// amount that is independent from sample to sample.
///
/// `G(n) = 1` at `n = 0`, else 0; `σ²(τ) = 3Q²/τ²` (IEEE Std 952-1997, eq. C.16).
#[derive(Clone, Copy, Debug)]
pub struct Quantization;

impl Effect for Quantization {
    fn name(&self) -> &'static str {
        "quantization"
    }

    fn symbol(&self) -> &'static str {
        "Q"
    }

    fn half_seconds(&self) -> i8 {
        2
    }

    fn kernel(&self, lag: Real, _: &Setting) -> Real {
        if lag == 0.0 { 1.0 } else { 0.0 }
    }

    fn add_second_differences(
        &self,
        _: Real,
        weight: Real,
        _: &Setting,
        sum: &mut SecondDifferences,
    ) {
        // G(0) is met at x = 0, twice and negative, and at x = m.
        sum.add_at(0, -2.0 * weight);
        sum.add_at(4, weight);
    }
}

impl Explain for Quantization {
    fn story(&self) -> Story {
        Story {
            what: "quantization noise: the angle is rounded, or its sampling instant jitters",
            origin: "the resolution of an angle-integrating output, jitter of the sample clock, readout of a laser gyro's fringe count",
            check: "does it change with the output's resolution or the clock? a rate-output gyro has little of it",
        }
    }
}
