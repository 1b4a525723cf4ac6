//! The best shape of every effect beside a model.

use super::MAX_CANDIDATES;
use crate::{
    curve::Curve,
    effect::{Effect, Span},
    error::Error,
    fit::{Problem, generalized::Solution},
    list,
    model::Model,
    real::Real,
    search::{Found, Search},
};
use heapless::Vec;

/// The best shapes that a scan found, best first.
pub(super) type Scan = Vec<Found, MAX_CANDIDATES>;

/// The shapes of effects that do best beside a model that has not been fitted yet.
#[inline(never)]
pub(super) fn scan_beside<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    tolerance: Real,
    effects: &[&'static dyn Effect],
    found: &mut Scan,
) -> Result<(), Error> {
    let problem = Problem::new(curve, model);
    let mut solution = Solution::new(&problem);
    solution.solve(tolerance)?;
    scan(&problem, &solution, effects, &span(curve), found);
    Ok(())
}

/// The best shape of every effect, with the covariance of the model so far: the best few of them, best
/// first.
#[inline(never)]
pub(super) fn scan<const K: usize>(
    problem: &Problem<'_, K>,
    solution: &Solution<'_, '_, K>,
    effects: &[&'static dyn Effect],
    span: &Span,
    found: &mut Scan,
) {
    let model = problem.model;
    let mut search = Search::new(problem, &solution.weights, true);
    for &effect in effects {
        let present = model.position(effect.name()).is_some();
        let replaced = effect.replaces().map(|other| model.position(other.name()));
        let nothing_to_replace = replaced == Some(None);
        if effect.mirror().is_some() || nothing_to_replace {
            continue;
        }
        if present && effect.parameters().is_empty() {
            continue;
        }
        let place = replaced.flatten().unwrap_or(problem.count());
        if search.at(place, &solution.squares).is_err() {
            // No place left in the model.
            continue;
        }
        let best = search.search(effect, span);
        if best.squares[place] <= 0.0 {
            continue;
        }
        list::rank(found, best, |other| other.chi_squared > best.chi_squared);
    }
}

pub(super) fn span<const K: usize>(curve: &Curve<K>) -> Span {
    Span {
        interval_s: curve.interval_s(),
        longest_tau_s: curve.points().last().map_or(0.0, |point| point.tau_s),
    }
}
