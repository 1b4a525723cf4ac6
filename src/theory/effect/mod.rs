//! The effects that make up the noise of a gyro, and the catalogue of the known ones.
//!
//! An effect is a [`Description`] and a kernel. The kernel is the generalised covariance `G(n)` of
//! the angle at a lag of `n` samples, an even function whose negative second derivative `−G″` is the
//! autocovariance of the rate. Allan variances and the covariance of an Allan curve need only second
//! differences of second differences of `G`. These remove a constant and a multiple of `n²` from `G`, so
//! that `G` exists even for an effect whose autocovariance does not.
//!
//! A new effect takes one file in this folder and one line in the catalogue below. The file
//! defines the type, its [`Effect`], its [`Explain`] and a static `DESCRIPTION`. If the rate is a stationary
//! process that the shape determines, such as white noise behind a filter, the file names the process in the
//! place of the [`Effect`]. The package for Python has a class of it, which
//! `ALLANITE_RENEW_PYTHON=1 cargo test --test library python_effects` makes. A firmware can define an effect of its own, in any
//! file, and add it to the list that it gives to [`Diagnosis`](crate::diagnosis::Diagnosis).

mod behind;
mod check;
mod definition;
mod drift;
mod explanation;
mod filter;
mod pole;
mod sampled_shape;
mod search_range;
mod stationary;

pub use crate::curve::Span;
pub use crate::{limits::MAX_PARAMETERS, theory::lattice::SecondDifferences};
pub use behind::Behind;
pub use check::{Flaw, check};
pub use definition::{
    Decay, Description, Distribution, Domain, Effect, FIRST_OWN_CODE, Parameter, Reciprocal,
    Response, Tail,
};
pub use explanation::{Explain, Explanation};
pub use sampled_shape::{SampledShape, padded};
pub use search_range::SearchRange;

/// Declares the module of every effect, exports its type and lists it.
///
/// `cargo fmt` does not find modules that a macro declares; `cargo xtask test` formats them by name.
macro_rules! catalogue {
    ($($file:ident::$effect:ident,)*) => {
        $(
            mod $file;
            pub use $file::$effect;
        )*

        /// Every known effect. A diagnosis tries these unless it is given another list.
        pub const CATALOGUE: [&dyn Effect; [$(stringify!($effect)),*].len()] = [$(&$effect),*];

        /// The effects of [`CATALOGUE`] with their explanations.
        ///
        /// An image that names this list holds the words of every effect.
        pub const EXPLAINED: [&dyn Explain; CATALOGUE.len()] = [$(&$effect),*];

        /// The code and the name of every effect of [`CATALOGUE`], without its mathematics.
        pub(crate) const CODES: [(u8, &str); CATALOGUE.len()] =
            [$(($file::DESCRIPTION.code, $file::DESCRIPTION.name)),*];
    };
}

catalogue! {
    quantization::Quantization,
    angle_random_walk::AngleRandomWalk,
    bias_instability::BiasInstability,
    rate_random_walk::RateRandomWalk,
    rate_ramp::RateRamp,
    gauss_markov::GaussMarkov,
    sinusoid::Sinusoid,
    resonance::Resonance,
    low_pass::LowPass,
    decimation_filter::DecimationFilter,
    random_telegraph::RandomTelegraph,
    power_law::PowerLaw,
    notch::Notch,
    digital_low_pass::DigitalLowPass,
    cascade::Cascade,
    mode_split::ModeSplit,
    high_pass::HighPass,
    drifting_resonance::DriftingResonance,
    drifting_sinusoid::DriftingSinusoid,
    output_low_pass::OutputLowPass,
    moving_average::MovingAverage,
}

/// The five terms of IEEE Std 952-1997, annex C, in the order of their slopes.
pub const IEEE_952: [&dyn Effect; 5] = [
    &Quantization,
    &AngleRandomWalk,
    &BiasInstability,
    &RateRandomWalk,
    &RateRamp,
];

// No two effects share a code, and no effect has a reserved code.
const _: () = {
    let mut i = 0;
    while i < CODES.len() {
        assert!(0 < CODES[i].0 && CODES[i].0 < FIRST_OWN_CODE);
        let mut j = 0;
        while j < i {
            assert!(CODES[i].0 != CODES[j].0);
            j += 1;
        }
        i += 1;
    }
};

/// The explanation of the effect of the catalogue with this name; `None` if there is no such effect.
pub fn explanation(name: &str) -> Option<Explanation> {
    let mut effects = EXPLAINED.iter();
    let named = effects.find(|effect| effect.description().name == name);
    named.map(|effect| effect.explanation())
}
