//! The search for the best shape of an effect over the whole range of shapes.

use super::{
    EVALUATIONS_A_CALL,
    grid::Grid,
    likelihood::{Evaluation, Found},
    refinement::Refinement,
};
use crate::{
    effect::{Effect, Span},
    limits::MAX_PARAMETERS,
    model::Term,
    real::Real,
};

/// A search over the grid of an effect's shapes. The best shape of the grid is then refined.
pub(crate) struct GridSearch {
    term: Term,
    grids: [Grid; MAX_PARAMETERS],
    /// The steps of the two parameters that come next.
    at: [u32; MAX_PARAMETERS],
    best: Found,
    refinement: Option<Refinement>,
}

impl GridSearch {
    /// Begins to search for an effect's shape on a curve of this span.
    pub(crate) fn new(effect: &'static dyn Effect, span: &Span) -> Self {
        let term = Term::fitted(effect);
        Self {
            term,
            grids: core::array::from_fn(|i| Grid::of(effect, i, span)),
            at: [0; MAX_PARAMETERS],
            best: Found::none(term),
            refinement: None,
        }
    }

    /// Begins to search among the shapes with this value of a parameter.
    pub(super) fn with(effect: &'static dyn Effect, j: usize, value: Real, span: &Span) -> Self {
        let mut search = Self::new(effect, span);
        if let Some(grid) = search.grids.get_mut(j) {
            *grid = Grid::only(value);
        }
        search
    }

    /// Does some evaluations; returns the best shape when no more are to do.
    #[inline(never)]
    pub(crate) fn advance<const K: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K>,
    ) -> Option<Found> {
        if let Some(refinement) = &mut self.refinement {
            return refinement.advance(evaluation);
        }
        let [first, second] = &self.grids;
        for _ in 0..EVALUATIONS_A_CALL {
            if self.at[0] >= first.steps {
                self.refinement = Some(Refinement::new(self.best, self.grids));
                break;
            }
            self.term.parameters = [first.at(self.at[0]), second.at(self.at[1])];
            self.best.improve(evaluation.found(self.term));
            self.at[1] = self.at[1].saturating_add(1);
            if self.at[1] >= second.steps {
                self.at = [self.at[0].saturating_add(1), 0];
            }
        }
        None
    }
}
