//! The size of an effect that a record would have shown.

use crate::{
    limits::MAX_EFFECTS,
    numerics::real::Real,
    theory::{effect::Effect, model::Term},
};

/// The size of an effect of one shape that a record would have shown with a probability of 95 %.
///
/// The size of most effects is their coefficient. A filter on white noise has the coefficient of the white
/// noise, which is measured, and its size is its first shape parameter, such as a time constant
/// ([`is_of_shape`](Self::is_of_shape)).
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The effect with its shape. For a limit of the shape, the first parameter is the limit.
    pub term: Term,
    /// The coefficient, in the unit that a [`Coefficient`](crate::Coefficient) of the effect has. For a
    /// limit of the shape, it is the coefficient that was measured.
    pub coefficient: Real,
    /// The coefficients of the model's terms with which a gyro that has the effect would look most like the
    /// record, in the order of the model. Those beyond the model are zero.
    pub beside: [Real; MAX_EFFECTS],
}

impl Limit {
    /// Whether the limit is that of the first shape parameter and not that of the coefficient.
    pub fn is_of_shape(&self) -> bool {
        is_of_shape(self.term.effect)
    }

    /// The limit: the coefficient, or the first shape parameter if the limit [is of it](Self::is_of_shape).
    pub fn size(&self) -> Real {
        if self.is_of_shape() {
            self.term.parameter(0)
        } else {
            self.coefficient
        }
    }
}

/// Whether the limit of an effect is that of its first shape parameter, because its coefficient is that of the
/// effect that it replaces.
pub(crate) fn is_of_shape(effect: &dyn Effect) -> bool {
    let replaced = effect.replaces();
    replaced.is_some_and(|replaced| replaced.coefficient() == effect.coefficient())
}
