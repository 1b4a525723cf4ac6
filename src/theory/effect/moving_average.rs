use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange,
    angle_random_walk::AngleRandomWalk,
    decimation_filter::{Boxcars, DecimationFilter},
    stationary::Stationary,
};
use crate::numerics::real::Real;

/// A moving average of the whole output: quantization, flicker noise and random walks as well as the white noise are means
/// over the last samples. The coefficient is the `N` of the angle random walk in front of it; the shape parameter is the
/// number of samples of a mean, 2 to 32.
///
/// The kernel is that of the white noise, which is a [`DecimationFilter`] of one stage. What the average leaves of the other
/// terms follows from it ([`passes_all`](super::Effect::passes_all)).
#[derive(Clone, Copy, Debug)]
pub struct MovingAverage;

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

impl Stationary for MovingAverage {
    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const NEEDS_SPECTRUM: bool = true;
    const PASSES_ALL: bool = true;

    type Process = Boxcars;

    fn process(shape: &SampledShape) -> Boxcars {
        let [samples, ..] = shape.parameters;
        DecimationFilter::process(&SampledShape {
            parameters: [samples * shape.interval_s, 1.0, 0.0],
            ..*shape
        })
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
