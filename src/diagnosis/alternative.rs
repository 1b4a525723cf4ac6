//! The step that would have followed if another candidate had been added.

use super::{
    judged::{Judged, Judging},
    polished::{Fitted, Polishing},
    step::{Candidate, Step},
};
use crate::{
    error::Error,
    fit::{Problem, Start, Tolerance, Work},
    model::Model,
    observed::Observed,
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
    judged(observed, &fitted, step.fit.tolerance, &mut alternative)?;
    Ok(alternative)
}

/// Fits the model and polishes its shapes.
pub(super) fn polished<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: Model,
    tolerance: Real,
) -> Result<Fitted, Error> {
    let mut work = Work::NEW;
    work.begin_at(
        observed,
        &model,
        Start::Independent,
        Tolerance::Fixed(tolerance),
    )?;
    let problem = Problem::new(observed, &model, &work.columns);
    while !work.solver.advance(&problem)? {}
    let squares = work.solver.squares;
    let mut polishing = Polishing::new(Fitted { model, squares });
    let span = observed.span();
    loop {
        if let Some(polished) = polishing.advance(observed, &span, tolerance, &mut work)? {
            return Ok(polished);
        }
    }
}

/// Compares a fitted model with the curve.
fn judged<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    fitted: &Fitted,
    tolerance: Real,
    step: &mut Step<K, B>,
) -> Result<Judged, Error> {
    let mut work = Work::NEW;
    let start = Start::Once(fitted.squares);
    work.begin_at(observed, &step.model, start, Tolerance::Fixed(tolerance))?;
    let mut judging = Judging::new();
    loop {
        if let Some(judged) = judging.advance(observed, &observed.span(), &mut work, step)? {
            return Ok(judged);
        }
    }
}
