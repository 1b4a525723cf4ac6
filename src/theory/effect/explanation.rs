use super::{Effect, MAX_PARAMETERS};
use crate::numerics::real::Real;

/// The explanation of an effect for a person whose gyro has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Explanation {
    /// The physical nature of the effect. A noun comes first, with its article if it takes one, then a colon.
    pub what: &'static str,
    /// The usual origin of the effect in a gyro.
    pub origin: &'static str,
    /// The checks to make on the bench.
    pub check: &'static str,
}

/// The words about an effect, as opposed to its mathematics.
///
/// This trait stands apart from [`Effect`] for the sake of flash: an image that prints no
/// explanation never refers to an `&dyn Explain`, so that the linker drops the words. A field of
/// [`Description`](super::Description) or a method of [`Effect`] would keep them in every image.
pub trait Explain: Effect {
    /// What the effect is, where it comes from and what to check.
    fn explanation(&self) -> Explanation;

    /// Shapes that are typical of a gyro which is sampled 100 times a second. Studies hide the effect
    /// in these shapes, and tests evaluate it there.
    ///
    /// The default suits an effect without shape parameters.
    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.0; MAX_PARAMETERS]]
    }
}
