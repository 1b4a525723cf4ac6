use super::MAX_PARAMETERS;
use crate::real::Real;

/// The shape of an effect that is sampled: the sample interval and the shape parameters. Together
/// with an averaging factor they determine everything that an effect computes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SampledShape {
    /// The sample interval τ₀, in seconds, above zero.
    pub interval_s: Real,
    /// The shape parameters, in the order of [`Description::parameters`](super::Description::parameters).
    /// Entries beyond those that the effect has are ignored.
    pub parameters: [Real; MAX_PARAMETERS],
}

impl SampledShape {
    /// The shape of an effect that has no shape parameters.
    pub const fn new(interval_s: Real) -> Self {
        Self {
            interval_s,
            parameters: [0.0; MAX_PARAMETERS],
        }
    }
}
