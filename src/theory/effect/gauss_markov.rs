use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange, low_pass::LowPass, pole::Pole, stationary::Stationary,
};
use crate::numerics::real::Real;

/// Exponentially correlated noise, which is a Gauss–Markov process of first order. The coefficient is
/// its rms `s` in rate units, the shape parameter its correlation time `T_c` in seconds, above zero.
///
/// The autocovariance is `r(n) = s² zⁿ` with the real pole `z = e^(−τ₀/T_c)`. For `τ ≫ τ₀` the Allan
/// variance is `σ²(τ) = (2 s² T_c/τ) [1 − (T_c/2τ)(3 − 4e^(−τ/T_c) + e^(−2τ/T_c))]`, whose root peaks
/// at 0.617 s where `τ = 1.89 T_c` (IEEE Std 952-1997, eq. C.20); the functions here are exact for a
/// sampled rate.
#[derive(Clone, Copy, Debug)]
pub struct GaussMarkov;

pub(super) static DESCRIPTION: Description = Description {
    name: "gauss_markov",
    symbol: "s",
    coefficient: "rms",
    half_seconds: 0,
    reference_s: None,
    parameters: &[Parameter {
        name: "correlation_time_s",
        unit: "s",
        is_whole: false,
        // The curve peaks at 1.89 T_c, and the peak must lie within the octaves.
        search_range: |span| SearchRange {
            low: span.interval_s,
            high: 0.5 * span.longest_tau_s,
            steps_per_octave: 2.0,
        },
        reciprocal: None,
    }],
    code: 6,
    replaces: None,
    mirror: None,
    special_case: Some(&LowPass),
    distribution: Distribution::Gaussian,
};

impl Stationary for GaussMarkov {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Pole;

    fn process(shape: &SampledShape) -> Pole {
        let [correlation_time_s, ..] = shape.parameters;
        Pole::new(correlation_time_s, 0.0, shape.interval_s)
    }
}

impl Explain for GaussMarkov {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "exponentially correlated noise: a random rate that keeps its value for about its correlation time",
            origin: "temperature control loops, charge trapping in the sense electronics, slow mechanical relaxation of the package",
            check: "log temperature and supply beside the rate; does the correlation time change with either?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.1, 0.0, 0.0], [1.0, 0.0, 0.0]]
    }
}
