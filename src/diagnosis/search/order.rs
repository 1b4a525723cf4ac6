//! The order in which the effects of a hypothesis are reported.

use super::{
    hypothesis::{Added, Hypothesis, MAX_ADDED},
    kind::is_filter,
    likelihood::Workspace,
    limits::Limits,
    refine::{NO_BARS, Solver},
    rows::Observation,
    run::set_common,
};
use crate::{
    numerics::real::Real,
    pause::Pause,
    theory::{
        effect::Effect,
        model::{Model, Term},
    },
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The largest number of effects of a hypothesis.
const MAX_TERMS: usize = MAX_ADDED + 1;

/// The effects of a hypothesis in the order in which they lower `−2 ln L` most, each with its fall. The shapes stay.
#[inline(never)]
pub(crate) fn ordered<const B: usize>(
    observation: &Observation<'_, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
    hypothesis: &Hypothesis,
    pause: &mut Pause<'_>,
) -> ControlFlow<(), Vec<(Term, Real), MAX_TERMS>> {
    let mut work = Workspace::<B>::NEW;
    pause()?;
    let white = set_common(&mut work, observation, model, effects);
    pause()?;
    let mut solver = Solver {
        observation,
        work: &mut work,
        white,
        model,
        shapes: &mut Vec::new(),
        limits: Limits {
            effects: MAX_TERMS,
            threshold: 0.0,
            ambiguity: 0.0,
        },
        bars: NO_BARS,
        pause,
    };
    let mut ordered: Vec<(Term, Real), MAX_TERMS> = Vec::new();
    let mut present = Hypothesis::new(None, Added::new());
    let mut before = solver.deviance(&present)?;
    loop {
        let mut best: Option<(Hypothesis, Term, Real)> = None;
        for term in hypothesis.terms() {
            let is_told = ordered.iter().any(|(told, _)| {
                told.effect.name() == term.effect.name() && told.parameters == term.parameters
            });
            if is_told {
                continue;
            }
            let mut more = present.clone();
            if is_filter(term.effect) {
                more.filter = Some(*term);
            } else {
                let _ = more.added.push(*term);
            }
            let deviance = solver.deviance(&more)?;
            if best.as_ref().is_none_or(|(_, _, least)| deviance < *least) {
                best = Some((more, *term, deviance));
            }
        }
        let Some((more, term, deviance)) = best else {
            return ControlFlow::Continue(ordered);
        };
        let _ = ordered.push((term, before - deviance));
        (present, before) = (more, deviance);
    }
}
