use super::MAX_PARAMETERS;
use crate::numerics::real::Real;

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

/// Shape parameters followed by zeros, for an effect that has fewer than there is room for. More than there is room
/// for do not compile.
pub fn padded<const N: usize>(parameters: [Real; N]) -> [Real; MAX_PARAMETERS] {
    const { assert!(N <= MAX_PARAMETERS) }
    let mut all = [0.0; MAX_PARAMETERS];
    for (place, parameter) in all.iter_mut().zip(parameters) {
        *place = parameter;
    }
    all
}

impl SampledShape {
    /// The shape of an effect with these parameters, of which there may be up to [`MAX_PARAMETERS`].
    pub fn known<const N: usize>(interval_s: Real, parameters: [Real; N]) -> Self {
        Self {
            interval_s,
            parameters: padded(parameters),
        }
    }

    /// The shape of an effect that has no shape parameters.
    pub const fn new(interval_s: Real) -> Self {
        Self {
            interval_s,
            parameters: [0.0; MAX_PARAMETERS],
        }
    }
}
