//! What an effect is: a description and a kernel.

use super::{sampled_shape::SampledShape, search_range::SearchRange};
use crate::curve::Span;
use crate::{numerics::real::Real, theory::lattice::SecondDifferences};
use core::fmt;

/// The name of an effect and its relations to others: everything about it except its mathematics.
///
/// Each effect has one static of this type, at one address. The format of certificates, the command line, the search for
/// shapes and the reports read it, and name no effect. Only the simulator names some: the digital filters that it runs
/// sample by sample.
pub struct Description {
    /// The name in files and on the command line: lower case with underscores, such as
    /// `angle_random_walk`. No two effects share a name.
    pub name: &'static str,
    /// The coefficient's customary symbol, such as `N`.
    pub symbol: &'static str,
    /// The meaning of the coefficient: `amplitude`, `rms`, or a name such as `angle_random_walk` that says
    /// it by itself.
    pub coefficient: &'static str,
    /// The power of √s in the coefficient's unit, which is rate unit · s^(`half_seconds`/2): 1 for the
    /// angle random walk, whose unit is rate · √s.
    pub half_seconds: i8,
    /// The averaging time in seconds at which the coefficient is the Allan deviation. An effect has one if
    /// the exponent of its variance depends on a shape parameter, because no unit would then suit all
    /// shapes. `None` if the unit says what the coefficient is.
    pub reference_s: Option<Real>,
    /// The shape parameters, at most [`MAX_PARAMETERS`](super::MAX_PARAMETERS).
    pub parameters: &'static [Parameter],
    /// The number that stands for the effect in a certificate. The catalogue uses 1 to 127, and a number
    /// never changes its meaning. An effect outside of the catalogue takes a number from
    /// [`FIRST_OWN_CODE`] on, or 0 if no certificate needs to distinguish it from others.
    pub code: u8,
    /// The effect whose place this one takes in a model: a filter on white noise takes that of the
    /// angle random walk.
    pub replaces: Option<&'static dyn Effect>,
    /// The effect that has the same Allan variance. A curve cannot distinguish the two, and a
    /// diagnosis searches for the mirrored effect only and lets the kurtosis decide between them.
    pub mirror: Option<&'static dyn Effect>,
    /// The simpler effect that this one becomes at the end of its range: a resonance that is too narrow to
    /// be resolved is a sinusoid. Where the data do not distinguish the two, the simpler one is named.
    pub special_case: Option<&'static dyn Effect>,
    /// The distribution of the values, which the kernel does not determine.
    pub distribution: Distribution,
}

/// The first of the codes that the catalogue never uses: 128.
pub const FIRST_OWN_CODE: u8 = 128;

/// The distribution of the values of an effect. A simulator needs it in addition to the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Distribution {
    /// All values are jointly normal, so that the kernel determines the process.
    Gaussian,
    /// The rate jumps between two levels of the same size and opposite sign, at times that are
    /// independent of each other. The autocovariance is exponential.
    TwoLevels,
    /// The frequency of an oscillation runs over a range, up and down at a steady pace. The kernel is the average over
    /// the range.
    Swept,
    /// The rate is a ramp, or a sinusoid of random phase, which [`Effect::response`] determines.
    Deterministic,
}

/// A shape parameter of an effect.
#[derive(Clone, Copy)]
pub struct Parameter {
    /// The name in files and on the command line, which ends in the unit: `frequency_hz`.
    pub name: &'static str,
    /// The unit: `s`, `Hz`, or empty for a number.
    pub unit: &'static str,
    /// Whether the parameter takes whole numbers only.
    pub is_whole: bool,
    /// The values that a search tries on a curve of a given span.
    pub search_range: fn(&Span) -> SearchRange,
    /// The quantity by which the parameter is known as well; `None` if there is none.
    pub reciprocal: Option<Reciprocal>,
}

/// The values that a shape parameter may have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Domain {
    /// Every number above zero.
    Positive,
    /// The whole numbers from `low` to `high`.
    Whole {
        /// The least one, which a parameter has unless it is given.
        low: Real,
        /// The greatest one.
        high: Real,
    },
}

impl Parameter {
    /// The values that the parameter may have: of one that takes whole numbers only, those that a search tries.
    pub fn domain(&self) -> Domain {
        /// Any span will do: the range of a whole number does not depend on it.
        const ANY: Span = Span {
            interval_s: 1.0,
            longest_tau_s: 1.0,
        };
        if !self.is_whole {
            return Domain::Positive;
        }
        let range = (self.search_range)(&ANY);
        Domain::Whole {
            low: range.low,
            high: range.high,
        }
    }
}

/// A quantity that is inversely proportional to a parameter, such as the cut-off frequency of a filter with a
/// time constant. Data sheets give the one, formulas the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reciprocal {
    /// The name in files and on the command line, which ends in the unit: `cutoff_hz`.
    pub name: &'static str,
    /// The unit.
    pub unit: &'static str,
    /// The product of the quantity and the parameter: 1/2π for a cut-off frequency and a time constant.
    pub product: Real,
}

/// The differences of adjacent cluster means that a deterministic effect makes.
///
/// The mean product of two such differences is `amplitude(m_j) · amplitude(m_k) · cos(phase · y)`,
/// divided by τ_j τ_k, where `m_j` and `m_k` are the averaging factors and `y` is the distance of
/// their middles in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Response {
    /// Root-mean-square of a difference, times τ, in seconds times the rate unit per unit of the
    /// coefficient. The sign distinguishes two differences in phase from two in opposition.
    pub amplitude: Real,
    /// Phase from one sample to the next, in radians: 0 for a ramp, whose differences are all the
    /// same.
    pub phase: Real,
}

/// The second differences of a random effect from the lag `start` on: the sum of up to two decays, and zero if there
/// is none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tail {
    /// The first lag `x` of the tail, in samples.
    pub start: Real,
    /// The decays. The second one is there only if there is a first one.
    pub decays: [Option<Decay>; 2],
}

/// A part of a [`Tail`]:
/// `e^(−decay (x − start)) [cosine cos(phase (x − start)) − sine sin(phase (x − start))]`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Decay {
    /// Logarithmic decay from one sample to the next, above zero.
    pub decay: Real,
    /// Phase from one sample to the next, in radians, from −π to π.
    pub phase: Real,
    /// The second difference at the start, in the unit of the kernel.
    pub cosine: Real,
    /// The part that is a quarter of a turn ahead, in the same unit.
    pub sine: Real,
}

impl Tail {
    /// Second differences that vanish from a lag on.
    pub(super) const fn none(start: Real) -> Self {
        Self {
            start,
            decays: [None; 2],
        }
    }

    /// The tail of second differences that are larger by a factor.
    #[must_use]
    pub(super) fn scaled(self, factor: Real) -> Self {
        let scaled = |part: Decay| Decay {
            cosine: factor * part.cosine,
            sine: factor * part.sine,
            ..part
        };
        Self {
            start: self.start,
            decays: self.decays.map(|part| part.map(scaled)),
        }
    }

    /// The number of places that the tail takes among those of a model.
    pub(crate) fn places(&self) -> usize {
        self.decays.iter().flatten().count().max(1)
    }
}

/// A physical effect that shows in an Allan curve.
///
/// Only the description and the kernel have to be given. Everything else has a default that follows
/// from the kernel; an effect overrides it where a closed form is faster or cancels less.
///
/// The coefficient enters every covariance squared. All functions are for a coefficient of one, take
/// lags `lag`, `x` and averaging factors `m` in samples, and expect `m ≥ 1` and finite arguments.
pub trait Effect: Sync {
    /// Name, parameters, unit and relations of the effect.
    fn description(&self) -> &'static Description;

    /// The values that a search tries for the shape parameter of this index; `None` if there is none. The default is that of
    /// the description. An effect whose ranges are known only while the program runs overrides it.
    fn search_range(&self, parameter: usize, span: &Span) -> Option<SearchRange> {
        let parameter = self.description().parameters.get(parameter);
        parameter.map(|parameter| (parameter.search_range)(span))
    }

    /// Whether only a spectrum shows the effect. The octaves of a record without one would take it for anything, so that
    /// a diagnosis does not look for it there. The default is `false`.
    fn needs_spectrum(&self) -> bool {
        false
    }

    /// The shape from which a search goes on, in the place of one at which the effect no longer changes with a parameter:
    /// the nearest one with the same effect at which it does. The default is the shape itself.
    fn canonical(&self, shape: &SampledShape) -> [Real; super::MAX_PARAMETERS] {
        shape.parameters
    }

    /// Whether all noise without a shape passes what the effect describes, and not only the effect that it
    /// [replaces](Description::replaces): quantization, flicker noise and random walks are filtered as the white noise is.
    /// The default is `false`.
    fn passes_all(&self) -> bool {
        false
    }

    /// The [`kernel`](Self::kernel) of this effect, which has no shape, behind an effect of this shape that
    /// [passes all noise](Self::passes_all), if it has a closed form. The default is `None`: the share that the filter leaves
    /// of the effect is then taken for the one that it leaves of white noise, in each octave and bin.
    fn kernel_behind(&self, filter: &dyn Effect, lag: Real, shape: &SampledShape) -> Option<Real> {
        let _ = (filter, lag, shape);
        None
    }

    /// The generalised covariance `G(n)` of the angle, for `lag = n ≥ 0` samples, in s² times the
    /// rate unit squared per coefficient squared. A constant and a multiple of `n²` are free.
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real;

    /// The second difference `G(x + m) − 2 G(x) + G(|x − m|)` of the kernel for `x ≥ 0`, up to a
    /// constant, in the unit of the kernel.
    ///
    /// The default cancels for `x ≫ m`: an effect that has a closed form overrides it.
    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let apart = if x < m { m - x } else { x - m };
        self.kernel(x + m, shape) - 2.0 * self.kernel(x, shape) + self.kernel(apart, shape)
    }

    /// Allan variance `σ²(mτ₀)`, in the rate unit squared per coefficient squared.
    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        let tau_s = m * shape.interval_s;
        let at_m = self.second_difference(m, m, shape);
        (at_m - self.second_difference(0.0, m, shape)) / (tau_s * tau_s)
    }

    /// Hands the Allan variances at ascending averaging factors to `each`. An effect overrides it
    /// where the variance of one octave leads to that of the next.
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

    /// Writes the semivariogram `γ(l) = ½ E (y_{j+l} − y_j)²` of the means `y` of blocks of `m` samples, at the
    /// distances of `l = 1, 2, …` blocks, in the rate unit squared per coefficient squared. At one block it is
    /// the Allan variance. Unlike the autocovariance, it exists for effects without a variance too.
    ///
    /// The default subtracts second differences at `x = 0`. An effect overrides it where its rate changes
    /// little from block to block, so that they would cancel, or where one distance leads to the next.
    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        let tau_s = m * shape.interval_s;
        let per_square = 1.0 / (tau_s * tau_s);
        let at_zero = self.second_difference(0.0, m, shape);
        let mut x = m;
        for value in values {
            *value = per_square * (self.second_difference(x, m, shape) - at_zero);
            x += m;
        }
    }

    /// The response of a deterministic effect to clusters of `m` samples; `None` for a random one.
    ///
    /// A deterministic effect is the same in every record but for its phase. It shifts the curve,
    /// but scatters it only where random effects beat against it.
    fn response(&self, m: Real, shape: &SampledShape) -> Option<Response> {
        let _ = (m, shape);
        None
    }

    /// The tail of a random effect whose second differences, for clusters of `m` samples, have more detail
    /// than the lattice resolves: it holds every lag up to four clusters, and four an octave beyond. `None` for
    /// any other effect.
    ///
    /// The covariance of a curve takes such an effect at every lag up to the tail, and sums the tail in closed
    /// form. The tail starts at `m`, or it is zero and starts after at most 95 distances of starts, which are
    /// the greater of `m/4` and 1.
    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        let _ = (m, shape);
        None
    }
}

/// What callers most often ask of a [`Description`].
impl dyn Effect + '_ {
    /// The name in files and on the command line.
    pub fn name(&self) -> &'static str {
        self.description().name
    }

    /// The coefficient's customary symbol.
    pub fn symbol(&self) -> &'static str {
        self.description().symbol
    }

    /// The meaning of the coefficient, such as `amplitude`.
    pub fn coefficient(&self) -> &'static str {
        self.description().coefficient
    }

    /// The power of √s in the coefficient's unit.
    pub fn half_seconds(&self) -> i8 {
        self.description().half_seconds
    }

    /// The shape parameters.
    pub fn parameters(&self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// Whether the shape parameter of this index takes whole numbers only; false if there is none.
    pub fn is_whole(&self, parameter: usize) -> bool {
        let parameter = self.parameters().get(parameter);
        parameter.is_some_and(|parameter| parameter.is_whole)
    }

    /// The effect whose place this one takes in a model.
    pub fn replaces(&self) -> Option<&'static dyn Effect> {
        self.description().replaces
    }

    /// The effect that has the same Allan variance.
    pub fn mirror(&self) -> Option<&'static dyn Effect> {
        self.description().mirror
    }
}

impl fmt::Debug for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Description {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=str}", self.name);
    }
}

impl fmt::Debug for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Parameter {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=str}", self.name);
    }
}
