//! The effects that make up the noise of a gyro, and the catalogue of the known ones.
//!
//! An effect is a [`Description`] and a kernel. The kernel is the generalised covariance `G(n)` of
//! the angle at a lag of `n` samples, an even function whose negative second derivative `−G″` is the
//! autocovariance of the rate. Allan variances and the covariance of an Allan curve need only second
//! differences of second differences of `G`. These remove a constant and a multiple of `n²` from `G`, so
//! that `G` exists even for an effect whose autocovariance does not.
//!
//! A new effect takes one file beside the others and one line in the catalogue below. The file
//! defines the type, its [`Effect`], its [`Explain`] and a constant `DESCRIPTION`. A firmware can define
//! an effect of its own in the same way, in any file, and add it to the list that it gives to
//! [`Diagnosis`](crate::Diagnosis).

mod description;
mod explanation;
mod pole;
mod sampled_shape;
mod search_range;

use crate::real::Real;
pub use crate::{lattice::SecondDifferences, limits::MAX_PARAMETERS};
pub use description::{Description, Distribution, FIRST_OWN_CODE, Parameter};
pub use explanation::{Explain, Explanation};
pub use sampled_shape::SampledShape;
pub use search_range::{SearchRange, Span};

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

/// The differences of adjacent cluster means that a deterministic effect causes.
///
/// The mean product of two such differences is `amplitude(m_j) · amplitude(m_k) · cos(phase · y)`,
/// divided by τ_j τ_k, where `m_j` and `m_k` are the averaging factors and `y` is the distance of
/// their middles in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Response {
    /// The root mean square of a difference, times τ, in seconds times the rate unit per unit of the
    /// coefficient. Two differences with amplitudes of opposite sign are in opposition of phase.
    pub amplitude: Real,
    /// The phase from one sample to the next, in radians; 0 for a ramp, whose differences are all equal.
    pub phase: Real,
}

/// A physical effect that is visible in an Allan curve.
///
/// Only the description and the kernel are required. Everything else has a default that follows
/// from the kernel. An effect overrides a default if a closed form is faster or cancels less.
///
/// Every covariance is proportional to the square of the coefficient. All functions are for a coefficient
/// of one, take lags `lag`, `x` and averaging factors `m` in samples, and expect `m ≥ 1` and finite
/// arguments.
pub trait Effect: Sync {
    /// The name, the parameters, the unit and the relations of the effect.
    fn description(&self) -> &'static Description;

    /// The generalised covariance `G(n)` of the angle, for `lag = n ≥ 0` samples, in s² times the
    /// rate unit squared per coefficient squared. A constant and a multiple of `n²` may be added freely.
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real;

    /// The second difference `G(x + m) − 2 G(x) + G(|x − m|)` of the kernel for `x ≥ 0`, up to a
    /// constant, in the unit of the kernel.
    ///
    /// The default loses digits by cancellation for `x ≫ m`. An effect that has a closed form overrides it.
    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let apart = if x < m { m - x } else { x - m };
        self.kernel(x + m, shape) - 2.0 * self.kernel(x, shape) + self.kernel(apart, shape)
    }

    /// The Allan variance `σ²(mτ₀)`, in the rate unit squared per coefficient squared.
    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        let tau_s = m * shape.interval_s;
        let at_m = self.second_difference(m, m, shape);
        (at_m - self.second_difference(0.0, m, shape)) / (tau_s * tau_s)
    }

    /// Calls `each` with the Allan variances at ascending averaging factors. An effect overrides this if the
    /// variance of one octave leads to that of the next.
    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        for m in factors {
            each(self.variance(m, shape));
        }
    }

    /// Adds `weight` times the second differences for clusters of `m` samples, at every lag of the
    /// lattice `sum`.
    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        sum.add(m, |x| weight * self.second_difference(x, m, shape));
    }

    /// The response of a deterministic effect to clusters of `m` samples; `None` for a random one.
    ///
    /// A deterministic effect is the same in every record except for its phase. It shifts the curve. It adds
    /// to the scatter of the curve only by its products with random effects.
    fn response(&self, m: Real, shape: &SampledShape) -> Option<Response> {
        let _ = (m, shape);
        None
    }
}
