use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange, angle_random_walk::AngleRandomWalk, filter::Output, low_pass::LowPass, pole::Pole,
    stationary::Stationary,
};
use crate::numerics::real::{
    Real,
    consts::{FRAC_1_SQRT_2, SQRT_2},
};
use nalgebra::Complex;

/// Angle random walk that rises towards high frequency, and is then cut off. It takes the place of [`AngleRandomWalk`].
/// The coefficient is `N` in rate · √s, that of the plateau at low frequency; the shape parameters are the frequency
/// `f_r` in Hz at which the density has risen to twice the plateau, and the frequency `f_c` in Hz of the corner above it.
///
/// The drive and the sense mode of such a gyro lie apart, so that the response to a rate falls with its frequency; what
/// makes up for that in the signal path amplifies the noise of the amplifier. Before sampling, the density is
/// `N² (1 + (f/f_r)²)/(1 + (f/f_c)⁴)`. With the pole `p = ω_c (−1 + i)/√2` of a Butterworth low pass of two poles, the
/// residue there gives the autocovariance
///
/// ```text
/// r(n) = s² Re [(1 + κ) + i(κ − 1)] e^(p nτ₀),   κ = (f_c/f_r)²
/// ```
///
/// The scale `s²` gives the sampled rate the spectral density `N²` at frequency zero, with what is aliased there.
#[derive(Clone, Copy, Debug)]
pub struct ModeSplit;

pub(super) static DESCRIPTION: Description = Description {
    name: "mode_split",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[
        Parameter {
            name: "rise_hz",
            unit: "Hz",
            is_whole: false,
            search_range: |span| SearchRange {
                low: 0.01 / span.interval_s,
                high: 0.5 / span.interval_s,
                steps_per_octave: 2.0,
            },
            reciprocal: None,
        },
        Parameter {
            name: "corner_hz",
            unit: "Hz",
            is_whole: false,
            search_range: |span| SearchRange {
                low: 0.05 / span.interval_s,
                high: 1.0 / span.interval_s,
                steps_per_octave: 2.0,
            },
            reciprocal: None,
        },
    ],
    code: 16,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: Some(&LowPass),
    distribution: Distribution::Gaussian,
};

impl Stationary for ModeSplit {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        let [rise_hz, corner_hz, ..] = shape.parameters;
        let ratio = corner_hz / rise_hz;
        let square = ratio * ratio;
        // The scale makes any factor of the weight good.
        let weight = Complex::new(1.0, (square - 1.0) / (square + 1.0));
        let cycles = FRAC_1_SQRT_2 * corner_hz * shape.interval_s;
        let decay = SQRT_2 * crate::numerics::real::consts::PI * corner_hz * shape.interval_s;
        Output::of_poles(Pole::at(weight, decay, cycles), None)
    }
}

impl Explain for ModeSplit {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "rising white noise: the noise grows with frequency up to the sensor's bandwidth",
            origin: "a gyro whose drive and sense modes are split: what flattens its response amplifies the noise of the sense amplifier",
            check: "lower the sensor's bandwidth below the rise: does the noise of single samples fall by more than the root of the bandwidth?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[10.0, 30.0, 0.0], [5.0, 60.0, 0.0]]
    }
}
