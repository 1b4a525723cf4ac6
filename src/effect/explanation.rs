use super::{Effect, MAX_PARAMETERS};
use crate::real::Real;

/// What a person reads whose gyro has an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Explanation {
    /// What the effect is physically.
    pub what: &'static str,
    /// Where it usually comes from in a gyro.
    pub origin: &'static str,
    /// What to check on the bench.
    pub check: &'static str,
}

/// What an effect tells a person, as opposed to what it computes.
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
