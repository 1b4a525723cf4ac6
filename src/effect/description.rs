use super::{Effect, SearchRange, Span};
use core::fmt;

/// The name of an effect and its relations to others: everything about it except its mathematics.
///
/// Each effect has one constant of this type. The format of certificates, the command line, the search for
/// shapes, the simulator and the reports read it, so that none of them needs to know any effect by
/// name.
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
    /// The shape parameters, at most [`MAX_PARAMETERS`](super::MAX_PARAMETERS).
    pub parameters: &'static [Parameter],
    /// The number that stands for the effect in a certificate. The catalogue uses 1 to 127, and a number
    /// never changes its meaning. An effect outside of the catalogue takes a number from
    /// [`FIRST_OWN_CODE`] on, or 0 if no certificate needs to distinguish it from others.
    pub code: u8,
    /// The effect whose place this one takes in a model: a filter on white noise takes that of the
    /// angle random walk.
    pub replaces: Option<&'static dyn Effect>,
    /// The effect that has the same Allan variance. A curve cannot tell the two apart, so that a
    /// diagnosis searches for the mirrored effect only and lets the kurtosis decide between them.
    pub mirror: Option<&'static dyn Effect>,
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
}

/// Short forms of the fields of a [`Description`] that callers ask for most often.
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

    /// The values that a search tries for the shape parameter of this index; `None` if there is none.
    pub fn search_range(&self, parameter: usize, span: &Span) -> Option<SearchRange> {
        let parameter = self.parameters().get(parameter);
        parameter.map(|parameter| (parameter.search_range)(span))
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
