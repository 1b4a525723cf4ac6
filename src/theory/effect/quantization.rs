use super::{Description, Distribution, Effect, Explain, Explanation, SampledShape};
use crate::{numerics::real::Real, theory::lattice::SecondDifferences};

/// Quantization noise: the angle carries an error that is independent from sample to sample. The
/// coefficient is `Q`, the rms of that error, in rate · s (an angle).
///
/// `G(n)` is 1 at `n = 0` and 0 elsewhere, and `σ²(τ) = 3Q²/τ²` (IEEE Std 952-1997, eq. C.16).
#[derive(Clone, Copy, Debug)]
pub struct Quantization;

/// The lag in samples beyond which a filter is taken to have forgotten: what is left of it is small compared with the variance, and
/// rounding would be larger.
const FORGOTTEN: Real = 256.0;

pub(super) static DESCRIPTION: Description = Description {
    name: "quantization",
    symbol: "Q",
    coefficient: "quantization",
    half_seconds: 2,
    reference_s: None,
    parameters: &[],
    code: 1,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for Quantization {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, _: &SampledShape) -> Real {
        if lag == 0.0 { 1.0 } else { 0.0 }
    }

    /// The error of the angle is white, so that the filter gives it its own autocovariance, which is the second difference of
    /// its kernel.
    fn kernel_behind(&self, filter: &dyn Effect, lag: Real, shape: &SampledShape) -> Option<Real> {
        if lag > FORGOTTEN {
            return Some(0.0);
        }
        Some(-filter.second_difference(lag, 1.0, shape) / shape.interval_s)
    }

    fn add_second_differences(
        &self,
        _: Real,
        weight: Real,
        _: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        // The second difference contains G(0) where x = 0, with weight −2, and where x = m.
        sum.add_at(0, -2.0 * weight);
        sum.add_at(4, weight);
    }
}

impl Explain for Quantization {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "quantization noise: the angle is rounded, or its sampling instant jitters",
            origin: "the resolution of an angle-integrating output, jitter of the sample clock, readout of a laser gyro's fringe count",
            check: "does it change with the output's resolution or the clock? a gyro that outputs rates has little of it",
        }
    }
}
