//! The step that would have followed if another candidate had been added.

use super::{
    assessment::assess,
    polish::{Fitted, polish},
    step::{Candidate, Step},
};
use crate::{
    error::Error,
    fit::{Start, Tolerance, Work},
    model::Model,
    observed::Observed,
    pause::unpaused,
    real::Real,
    record::Record,
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
    let fitted = polished(observed, model, step.fit.tolerance)?;
    let mut alternative = Step::of(&fitted.model);
    alternative.covariate = step.covariate;
    let start = Start::Once(fitted.squares);
    let tolerance = Tolerance::Fixed(step.fit.tolerance);
    let mut work = Work::NEW;
    unpaused(|pause| {
        assess(
            observed,
            start,
            tolerance,
            &mut work,
            &mut alternative,
            pause,
        )
    })?;
    Ok(alternative)
}

/// Fits the model and polishes its shapes.
pub(super) fn polished<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: Model,
    tolerance: Real,
) -> Result<Fitted, Error> {
    let mut work = Work::NEW;
    let granted = Tolerance::Fixed(tolerance);
    unpaused(|pause| {
        work.solve(observed, &model, Start::Independent, granted, pause)?;
        let squares = work.solver.squares;
        polish(
            observed,
            Fitted { model, squares },
            tolerance,
            &mut work,
            pause,
        )
    })
}
