use crate::real::Real;

/// The time that a curve spans.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Span {
    /// The sample interval τ₀, in seconds.
    pub interval_s: Real,
    /// The averaging time of the longest octave, in seconds.
    pub longest_tau_s: Real,
}

/// The values of a shape parameter that a search tries. The ranges and steps of the catalogue are
/// chosen by hand; `cargo xtask study hidden-effect` runs with them and does not vary them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SearchRange {
    /// The lowest value, above zero, in the parameter's unit.
    pub low: Real,
    /// The highest value. If the curve is so short that `high` lies below `low`, a search takes `low`
    /// instead.
    pub high: Real,
    /// The number of values for each factor of two. It has no effect on a parameter that takes whole numbers
    /// only, because a search tries all of these.
    pub steps_per_octave: Real,
}
