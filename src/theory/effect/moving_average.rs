use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter,
    SampledShape, SearchRange, SecondDifferences, Tail, angle_random_walk::AngleRandomWalk,
    decimation_filter::DecimationFilter,
};
use crate::numerics::real::Real;

/// A moving average of the whole output: quantization, flicker noise and random walks as well as the white noise are means
/// over the last samples. The coefficient is the `N` of the angle random walk in front of it; the shape parameter is the
/// number of samples of a mean, up to 64.
///
/// The kernel is that of the white noise, which is a [`DecimationFilter`] of one stage. What the average leaves of the other
/// terms follows from it ([`passes_all`](Effect::passes_all)).
#[derive(Clone, Copy, Debug)]
pub struct MovingAverage;

/// The shape of the filter of white noise.
fn stage(shape: &SampledShape) -> SampledShape {
    let [samples, ..] = shape.parameters;
    SampledShape {
        parameters: [samples * shape.interval_s, 1.0, 0.0],
        ..*shape
    }
}

pub(super) static DESCRIPTION: Description = Description {
    name: "moving_average",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[Parameter {
        name: "samples",
        unit: "",
        is_whole: true,
        search_range: |_| SearchRange {
            low: 2.0,
            high: 32.0,
            steps_per_octave: 1.0,
        },
        reciprocal: None,
    }],
    code: 21,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: Some(&DecimationFilter),
    distribution: Distribution::Gaussian,
};

impl Effect for MovingAverage {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn needs_spectrum(&self) -> bool {
        true
    }

    fn passes_all(&self) -> bool {
        true
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        DecimationFilter.kernel(lag, &stage(shape))
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        DecimationFilter.second_difference(x, m, &stage(shape))
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        DecimationFilter.variances(factors, &stage(shape), each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        DecimationFilter.add_second_differences(m, weight, &stage(shape), sum);
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        DecimationFilter.tail(m, &stage(shape))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        DecimationFilter.variogram(m, &stage(shape), values);
    }
}

impl Explain for MovingAverage {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a moving average of the whole output: every value is a mean over the last samples, quantization and all",
            origin: "a running mean in the firmware or in the program that wrote the log",
            check: "log every sample without the average: do neighbouring samples become independent?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[5.0, 0.0, 0.0]]
    }
}
