use crate::real::Real;

/// The time that a curve spans.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Span {
    /// Sample interval τ₀, in seconds.
    pub interval_s: Real,
    /// Averaging time of the longest octave, in seconds.
    pub longest_tau_s: Real,
}

/// The values of a shape parameter that a search tries.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SearchRange {
    /// The lowest value, above zero, in the parameter's unit.
    pub low: Real,
    /// The highest value. A search takes `low` instead where the curve is so short that `high` lies
    /// below it.
    pub high: Real,
    /// The number of values for each factor of two. It has no effect on a whole-numbered parameter,
    /// of which a search tries every value.
    pub steps_per_octave: Real,
}
