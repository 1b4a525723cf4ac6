//! The step that would have followed if another candidate had been added.

use super::{
    assessment::assess,
    polish::polished,
    step::{Candidate, Step},
};
use crate::{
    error::Error,
    evidence::record::Record,
    fit::{Start, Tolerance, Work},
    pause::unpaused,
};

/// The step that would have followed `step` if another one of its candidates had been added: the model
/// with the candidate, with all fitted shapes polished, and where this model fails. The step has no
/// candidates of its own.
///
/// `observed` is what the step was judged on, without what follows a covariate.
///
/// # Errors
/// The same as those of [`fit`](crate::fit::fit()), and [`Error::TooManyEffects`] if the model has no
/// room.
pub fn alternative<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
    step: &Step<K, B>,
    candidate: &Candidate,
) -> Result<Step<K, B>, Error> {
    let observed = record.into().observed();
    let mut model = step.model.clone();
    if let Some(replaced) = candidate.term.effect.replaces() {
        model.remove(replaced.name());
    }
    model.add(candidate.term)?;
    let granted = Tolerance::Fixed(step.fit.tolerance);
    let fitted = unpaused(|pause| polished(observed, model, granted, pause))?;
    let mut alternative = Step::of(&fitted.model);
    alternative.covariate = step.covariate;
    let start = Start::Once(fitted.squares);
    let mut work = Work::NEW;
    unpaused(|pause| assess(observed, start, granted, &mut work, &mut alternative, pause))?;
    Ok(alternative)
}
