use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter,
    SampledShape, SearchRange, SecondDifferences, angle_random_walk::AngleRandomWalk, pole::Pole,
};
use crate::real::Real;

/// Angle random walk that passed a low pass of first order. It takes the place of [`AngleRandomWalk`].
/// The coefficient is `N` in rate · √s, the shape parameter the time constant `T` of the filter in
/// seconds, above zero.
///
/// The autocovariance is `r(n) = s² zⁿ` with the pole `z = e^(−τ₀/T)`, as that of
/// [`GaussMarkov`](super::GaussMarkov) noise. The variance `s² = N²(1−z)/((1+z)τ₀)` gives the sampled
/// rate the spectral density `N²` at frequency zero.
#[derive(Clone, Copy, Debug)]
pub struct LowPass;

fn pole(shape: &SampledShape) -> Pole {
    Pole::new(shape.parameters[0], 0.0, shape.interval_s)
}

/// The variance `s²` of the rate for `N = 1`.
fn variance(shape: &SampledShape) -> Real {
    1.0 / (pole(shape).long_mean() * shape.interval_s)
}

pub(super) const DESCRIPTION: Description = Description {
    name: "low_pass",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[Parameter {
        name: "time_constant_s",
        unit: "s",
        is_whole: false,
        search_range: |span| SearchRange {
            low: 0.25 * span.interval_s,
            high: (64.0 * span.interval_s).min(0.1 * span.longest_tau_s),
            steps_per_octave: 2.0,
        },
    }],
    code: 9,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    distribution: Distribution::Gaussian,
};

impl Effect for LowPass {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        scale(shape) * pole(shape).kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        scale(shape) * pole(shape).second_difference(x, m)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        variance(shape) * pole(shape).variance(m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        let scale = variance(shape);
        pole(shape).variances(factors, |value| each(scale * value));
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        pole(shape).add_second_differences(m, weight * scale(shape), sum);
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        pole(shape).variogram(m, variance(shape), values);
    }
}

impl Explain for LowPass {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a first-order low pass: white noise is cut off before it is sampled",
            origin: "an analogue RC filter, or a digital smoothing filter of one pole, in the sensor's signal path",
            check: "read the sensor's bandwidth setting; does the deficit at short averaging times move with it?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.02, 0.0]]
    }
}

fn scale(shape: &SampledShape) -> Real {
    variance(shape) * shape.interval_s * shape.interval_s
}
