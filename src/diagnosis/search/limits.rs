//! The limits of a search.

use crate::numerics::real::Real;

/// What a search may do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// The largest number of effects.
    pub(crate) effects: usize,
    /// What an effect has to gain beyond two for each parameter; see [`price`](super::price::price).
    pub(crate) threshold: Real,
    /// Alternatives cost up to this much more than the best hypothesis.
    pub(crate) ambiguity: Real,
}
