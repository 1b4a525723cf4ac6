use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, SampledShape,
    gauss_markov::{self, GaussMarkov},
    pole::Pole,
    stationary::Stationary,
};
use crate::numerics::real::Real;

/// Random telegraph noise: the rate jumps between two levels. The coefficient is its rms in rate
/// units, the shape parameter its correlation time `T_c` in seconds, above zero.
///
/// The levels lie `2 rms` apart, and the rate stays at one of them for `2 T_c` on average
/// (Machlup 1954). The autocovariance, and with it the Allan variance, is that of [`GaussMarkov`]
/// noise, and only the kurtosis of the differences at `τ ≲ T_c` distinguishes the two.
#[derive(Clone, Copy, Debug)]
pub struct RandomTelegraph;

pub(super) static DESCRIPTION: Description = Description {
    name: "random_telegraph",
    symbol: "s",
    coefficient: "rms",
    half_seconds: 0,
    reference_s: None,
    parameters: gauss_markov::DESCRIPTION.parameters,
    code: 11,
    replaces: None,
    mirror: Some(&GaussMarkov),
    special_case: None,
    distribution: Distribution::TwoLevels,
};

impl Stationary for RandomTelegraph {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Pole;

    fn process(shape: &SampledShape) -> Pole {
        GaussMarkov::process(shape)
    }
}

impl Explain for RandomTelegraph {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "random telegraph noise: the rate jumps between two levels",
            origin: "a single defect in the sense electronics that captures and releases charge (popcorn noise), a stick-slip contact in the package",
            check: "plot the rate averaged over a fifth of the correlation time: are there two levels? does it change when the amplifier is cooled or replaced?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.1, 0.0, 0.0], [1.0, 0.0, 0.0]]
    }
}
