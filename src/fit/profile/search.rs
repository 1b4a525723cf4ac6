//! The search for the best shape of an effect over the whole range of shapes.

use super::{
    evaluations_a_call,
    grid::Grid,
    likelihood::{Evaluation, Found},
    refinement::Refinement,
};
use crate::{
    limits::MAX_PARAMETERS,
    list,
    numerics::real::Real,
    theory::{
        effect::{Effect, Span},
        model::Term,
    },
};
use heapless::Vec;

/// The number of the grid's shapes that are refined. A curve has several minima where an effect
/// oscillates, and the lowest one of the grid need not be the lowest one between its steps.
const MINIMA: usize = 4;
/// The fewest steps of the first parameter between two shapes that are refined.
const APART: u32 = 2;

/// A search over the grid of an effect's shapes. The best shapes of the grid are then refined.
pub(crate) struct GridSearch {
    term: Term,
    grids: [Grid; MAX_PARAMETERS],
    /// The place in the grid that comes next, the first parameter running slowest.
    at: u32,
    /// The best shapes of the grid that lie apart, best first, and their step of the first parameter.
    minima: Vec<(Found, u32), MINIMA>,
    /// The best shape after the refinement of some of the minima.
    best: Found,
    refinement: Option<Refinement>,
}

impl GridSearch {
    /// Begins to search for an effect's shape on a curve of this span.
    pub(crate) fn new(effect: &'static dyn Effect, span: &Span) -> Self {
        let term = Term::fitted(effect);
        let grids: [Grid; MAX_PARAMETERS] = core::array::from_fn(|i| Grid::of(effect, i, span));
        Self {
            term,
            grids,
            at: 0,
            minima: Vec::new(),
            best: Found::none(term),
            refinement: None,
        }
    }

    /// Begins to search among the shapes with this value of a parameter.
    pub(crate) fn with(effect: &'static dyn Effect, j: usize, value: Real, span: &Span) -> Self {
        let mut search = Self::new(effect, span);
        if let Some(grid) = search.grids.get_mut(j) {
            *grid = Grid::only(value);
        }
        search
    }

    /// Does some evaluations; returns the best shape when no more are to do.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K, B>,
    ) -> Option<Found> {
        if let Some(refinement) = &mut self.refinement {
            let refined = refinement.advance(evaluation)?;
            self.best.improve(refined);
            self.refinement = None;
            if self.minima.is_empty() {
                return Some(self.best);
            }
        }
        let [first, others @ ..] = self.grids;
        let inner = others
            .iter()
            .fold(1_u32, |n, grid| n.saturating_mul(grid.steps))
            .max(1);
        for _ in 0..evaluations_a_call(B) {
            let step = self.at / inner;
            if step >= first.steps {
                let Some((best, _)) = self.minima.pop() else {
                    return Some(self.best);
                };
                self.refinement = Some(Refinement::new(best, self.grids));
                break;
            }
            let mut rest = self.at % inner;
            self.term.set_parameter(0, first.at(step));
            for (j, grid) in list::numbered(others.iter()) {
                self.term
                    .set_parameter(j.saturating_add(1), grid.at(rest % grid.steps.max(1)));
                rest /= grid.steps.max(1);
            }
            let found = evaluation.found(self.term);
            self.keep(found, step);
            self.at = self.at.saturating_add(1);
        }
        None
    }

    /// Keeps a shape at a step of the first parameter, if it is one of the best and the best one near it.
    fn keep(&mut self, found: Found, at: u32) {
        let parameters = found.term.parameters;
        let effect = found.term.effect;
        // Shapes with different whole numbers have minima of their own.
        let is_alike = |other: &Found| {
            let pairs = parameters.iter().zip(&other.term.parameters);
            list::numbered(pairs).all(|(j, (one, other))| !effect.is_whole(j) || one == other)
        };
        let is_near = |(other, step): &(Found, u32)| step.abs_diff(at) < APART && is_alike(other);
        let is_worse = |other: &Found| other.chi_squared > found.chi_squared;
        let mut near = self.minima.iter().filter(|known| is_near(known));
        if near.any(|(other, _)| !is_worse(other)) {
            return;
        }
        while let Some(place) = self.minima.iter().position(is_near) {
            list::remove(&mut self.minima, place);
        }
        list::rank(&mut self.minima, (found, at), |(other, _)| is_worse(other));
    }
}
