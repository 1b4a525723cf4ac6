//! An order of effects in which the error of the fit falls with each.

use super::extended::with;
use crate::{
    evidence::observed::Observed,
    fit::{Start, Tolerance, Work},
    list,
    numerics::real::Real,
    pause::{Pause, Stop, call},
    theory::model::{Model, Term},
};
use heapless::Vec;

/// Lets the effect come first, of those that are left, with which the error of the fit is least, wherever it would rise with the
/// one whose turn it is. The search orders effects by the likelihood of octaves and bins that it takes for independent.
/// `without` is the error of the model alone.
///
/// # Errors
/// [`Stop::Paused`], or that there is no room for an effect.
#[inline(never)]
pub(super) fn fall<const N: usize, const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: &Model,
    effects: &mut Vec<(Term, Real), N>,
    (without, tolerance): (Real, Real),
    pause: &mut Pause<'_>,
) -> Result<(), Stop> {
    let mut before = without;
    let mut told: Vec<Term, N> = Vec::new();
    // The last one leads to the whole model, whatever the order.
    for place in 0..effects.len().saturating_sub(1) {
        let mut best: Option<(usize, Real)> = None;
        for candidate in place..effects.len() {
            let Some((term, _)) = effects.get(candidate) else {
                continue;
            };
            let error = error(observed, model, &told, term, tolerance, pause)?;
            if best.is_none_or(|(_, least)| error < least) {
                best = Some((candidate, error));
            }
            if candidate == place && error < before {
                break;
            }
        }
        let Some((found, error)) = best else { break };
        if found > place
            && let Some(first) = effects.get(found).copied()
        {
            list::remove(effects, found);
            list::insert(effects, place, first);
        }
        if let Some((term, _)) = effects.get(place) {
            let _ = told.push(*term);
        }
        before = error;
    }
    Ok(())
}

/// The error of the model with what was told and one more effect; infinite if it cannot be fitted.
fn error<const N: usize, const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    model: &Model,
    told: &Vec<Term, N>,
    term: &Term,
    tolerance: Real,
    pause: &mut Pause<'_>,
) -> Result<Real, Stop> {
    call(pause)?;
    let mut terms = told.clone();
    let _ = terms.push(*term);
    let whole = with(model, &terms)?;
    let mut work = Work::<K, B>::NEW;
    let tolerance = Tolerance::IfNeeded(tolerance);
    match work.solve(observed, &whole, Start::Independent, tolerance, pause) {
        Ok(()) => Ok(work.solver.chi_squared),
        Err(Stop::Failed(_)) => Ok(Real::INFINITY),
        Err(Stop::Paused) => Err(Stop::Paused),
    }
}
