//! What an effect is, and the catalogue of those that a gyro can have.
//!
//! Every physical effect is one even function, the generalised covariance `G(n)` of the angle at a
//! lag of `n` samples: `−G″` is the autocovariance of the rate. Allan variances and the covariance
//! of an Allan curve need second differences of `G` only, on both sides, which remove any
//! polynomial up to the third degree: `G` exists for effects whose autocovariance does not.

mod angle_random_walk;
mod bias_instability;
mod decimation_filter;
mod gauss_markov;
mod low_pass;
mod pole;
mod quantization;
mod random_telegraph;
mod rate_ramp;
mod rate_random_walk;
mod resonance;
mod sinusoid;

use crate::real::Real;
pub use angle_random_walk::AngleRandomWalk;
pub use bias_instability::BiasInstability;
pub use decimation_filter::DecimationFilter;
pub use gauss_markov::GaussMarkov;
pub use low_pass::LowPass;
pub use quantization::Quantization;
pub use random_telegraph::RandomTelegraph;
pub use rate_ramp::RateRamp;
pub use rate_random_walk::RateRandomWalk;
pub use resonance::Resonance;
pub use sinusoid::Sinusoid;

pub use crate::lattice::SecondDifferences;

/// Shape parameters that an effect can have: a frequency and a quality are the most.
pub const MAX_PARAMETERS: usize = 2;

/// Where an effect is evaluated: the sampling, and the effect's own shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Sample interval τ₀, in seconds.
    pub interval_s: Real,
    /// The effect's shape parameters, in the order in which it names them; those that it does not
    /// have are ignored.
    pub parameters: [Real; MAX_PARAMETERS],
}

impl Setting {
    /// For an effect without shape parameters.
    pub const fn new(interval_s: Real) -> Self {
        Self {
            interval_s,
            parameters: [0.0; MAX_PARAMETERS],
        }
    }
}

/// What a deterministic effect does to the differences of adjacent cluster means: for middles
/// `y` samples apart, the mean product of two of them is
/// `amplitude(m_j) · amplitude(m_k) · cos(phase · y)`, divided by τ_j τ_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Root-mean-square of a difference, times τ.
    pub amplitude: Real,
    /// Phase from one sample to the next, in radians.
    pub phase: Real,
}

/// A shape parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Parameter {
    /// Its name in files and on the command line, with its unit: `frequency_hz`.
    pub name: &'static str,
    /// Its unit, empty for a number.
    pub unit: &'static str,
}

/// Where a search for a shape parameter looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The lowest value, above zero.
    pub low: Real,
    /// The highest value.
    pub high: Real,
    /// Values tried for each factor of two.
    pub steps_per_octave: Real,
}

/// What a curve spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Sample interval τ₀, in seconds.
    pub interval_s: Real,
    /// Averaging time of the longest octave, in seconds.
    pub longest_tau_s: Real,
}

/// What to tell somebody whose gyro has an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Story {
    /// What it is physically.
    pub what: &'static str,
    /// Where it usually comes from in a gyro.
    pub origin: &'static str,
    /// What to check on the bench.
    pub check: &'static str,
}

/// A physical effect that shows in an Allan curve.
///
/// The coefficient enters squared, as `β`: every function here is for a coefficient of one.
pub trait Effect: Sync {
    /// Its name in files and on the command line, such as `angle_random_walk`.
    fn name(&self) -> &'static str;

    /// The coefficient's customary symbol, such as `N`.
    fn symbol(&self) -> &'static str;

    /// What the coefficient is: `amplitude`, `rms`, or the effect's own name where that says it.
    fn coefficient(&self) -> &'static str {
        self.name()
    }

    /// The shape parameters, up to [`MAX_PARAMETERS`].
    fn parameters(&self) -> &'static [Parameter] {
        &[]
    }

    /// Where a search looks for a shape parameter on a curve of that span.
    fn range(&self, parameter: usize, span: &Span) -> Range {
        let _ = parameter;
        Range {
            low: span.interval_s,
            high: span.longest_tau_s,
            steps_per_octave: 2.0,
        }
    }

    /// Whether a shape parameter takes whole numbers only.
    fn is_whole(&self, parameter: usize) -> bool {
        let _ = parameter;
        false
    }

    /// The effect that this one takes the place of in a model.
    fn replaces(&self) -> Option<&'static dyn Effect> {
        None
    }

    /// An effect with the same Allan variance: only evidence beyond the curve tells the two apart.
    fn twin(&self) -> Option<&'static dyn Effect> {
        None
    }

    /// Half the power of seconds in the coefficient's unit, which is rate unit · s^(half/2):
    /// 1 for the angle random walk, rate · √s.
    fn half_seconds(&self) -> i8;

    /// The generalised covariance `G(n)`, in s² times the rate unit squared per coefficient
    /// squared, for `lag = n ≥ 0` samples, up to a polynomial of the third degree.
    fn kernel(&self, lag: Real, setting: &Setting) -> Real;

    /// `G(x + m) − 2 G(x) + G(|x − m|)` for lags in samples, up to a straight line in `x`.
    ///
    /// For `x ≫ m` the terms cancel: an effect with a closed form should give it.
    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        let apart = if x < m { m - x } else { x - m };
        self.kernel(x + m, setting) - 2.0 * self.kernel(x, setting) + self.kernel(apart, setting)
    }

    /// Allan variance `σ²(mτ₀)`, in the rate unit squared per coefficient squared.
    fn variance(&self, m: Real, setting: &Setting) -> Real {
        let tau_s = m * setting.interval_s;
        let at_m = self.second_difference(m, m, setting);
        (at_m - self.second_difference(0.0, m, setting)) / (tau_s * tau_s)
    }

    /// Allan variances at ascending averaging factors: sooner, where one gives the next.
    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        for m in factors {
            each(self.variance(m, setting));
        }
    }

    /// Adds `weight` times the second differences for clusters of `m` samples, at every position
    /// of the lattice.
    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        sum.add(m, |x| weight * self.second_difference(x, m, setting));
    }

    /// For an effect that is the same in every record, and not random: its response to clusters of
    /// `m` samples. It shifts the curve, but scatters it only where random effects beat against it.
    fn response(&self, m: Real, setting: &Setting) -> Option<Response> {
        let _ = (m, setting);
        None
    }
}

/// What people are told of an effect: apart from what it computes, so that firmware that tells nobody has no
/// room to spend on words.
pub trait Explain: Effect {
    /// What it is, where it comes from, what to check.
    fn story(&self) -> Story;
}

/// The five terms of IEEE Std 952-1997, annex C, in the order of their slopes.
pub const IEEE_952: [&dyn Effect; 5] = [
    &Quantization,
    &AngleRandomWalk,
    &BiasInstability,
    &RateRandomWalk,
    &RateRamp,
];

/// The catalogue, once: effects to compute with, and what to tell of them.
macro_rules! catalogue {
    ($($effect:ident,)*) => {
        /// Every effect that a diagnosis tries. An effect of one's own takes a file beside the others and
        /// a line here, or none in this crate: a diagnosis takes any list.
        pub const CATALOGUE: [&dyn Effect; [$(stringify!($effect)),*].len()] = [$(&$effect),*];

        const EXPLAINED: [&dyn Explain; CATALOGUE.len()] = [$(&$effect),*];
    };
}

catalogue! {
    Quantization,
    AngleRandomWalk,
    BiasInstability,
    RateRandomWalk,
    RateRamp,
    GaussMarkov,
    Sinusoid,
    Resonance,
    LowPass,
    DecimationFilter,
    RandomTelegraph,
}

/// What to tell of an effect of the catalogue, by its name.
pub fn story(name: &str) -> Option<Story> {
    let named = EXPLAINED.iter().find(|effect| effect.name() == name);
    named.map(|effect| effect.story())
}
