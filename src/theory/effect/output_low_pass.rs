use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, SampledShape,
    angle_random_walk::AngleRandomWalk,
    digital_low_pass::{self, DigitalLowPass},
    filter::Output,
    stationary::Stationary,
};
use crate::numerics::real::Real;

/// A [`DigitalLowPass`] that the whole signal passed: quantization, flicker noise and random walks as well as the white noise.
/// The coefficient is the `N` of the angle random walk in front of it; the shape parameters are the time constant `T` of the
/// filter in seconds and the number of its poles.
///
/// The kernel is that of the white noise. What the filter leaves of the other terms follows from it
/// ([`passes_all`](super::Effect::passes_all)).
#[derive(Clone, Copy, Debug)]
pub struct OutputLowPass;

pub(super) static DESCRIPTION: Description = Description {
    name: "output_low_pass",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: digital_low_pass::DESCRIPTION.parameters,
    code: 20,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: Some(&DigitalLowPass),
    distribution: Distribution::Gaussian,
};

impl Stationary for OutputLowPass {
    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const NEEDS_SPECTRUM: bool = true;
    const PASSES_ALL: bool = true;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        DigitalLowPass::process(shape)
    }
}

impl Explain for OutputLowPass {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a low pass of the whole output: everything that the sensor gave was smoothed at the sample rate, its quantization too",
            origin: "a smoothing filter in the firmware or in the program that wrote the log, a Butterworth of one to four poles",
            check: "log what the sensor gives before the filter: do single counts show again?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.015, 2.0, 0.0], [0.008, 1.0, 0.0]]
    }
}
