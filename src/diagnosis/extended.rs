//! A model with what was found.

use crate::{
    error::Error,
    theory::model::{Model, Term},
};

/// The model with some effects. Each takes the place of the effect that it replaces, or the last place.
pub(super) fn with(model: &Model, terms: &[Term]) -> Result<Model, Error> {
    let mut whole = model.clone();
    for term in terms {
        if let Some(replaced) = term.effect.replaces() {
            whole.remove(replaced.name());
        }
        whole.add(*term)?;
    }
    Ok(whole)
}
