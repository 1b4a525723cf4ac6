//! The search for the best shape near a known one.

use super::{
    evaluations_a_call,
    grid::Grid,
    likelihood::{Evaluation, Found},
};
use crate::{
    limits::MAX_PARAMETERS,
    numerics::{math, real::Real},
};

/// How often the step is halved: it goes from half a grid step to a 32nd of one. Chosen by hand, to
/// save evaluations: a trial goes on from there with steps of Gauss and Newton.
const HALVINGS: u8 = 5;

/// A way downhill from a shape, one parameter after the other, in steps of the logarithm that are
/// halved whenever a round is over.
pub(crate) struct Refinement {
    best: Found,
    steps: [Real; MAX_PARAMETERS],
    grids: [Grid; MAX_PARAMETERS],
    /// The round, the parameter and the direction that come next.
    round: u8,
    parameter: u8,
    down: bool,
}

impl Refinement {
    /// Refines a shape that a grid search found.
    pub(super) fn new(best: Found, grids: [Grid; MAX_PARAMETERS]) -> Self {
        Self {
            best,
            steps: grids.map(|grid| 0.5 * grid.log_step),
            grids,
            round: 0,
            parameter: 0,
            down: false,
        }
    }

    /// Does some evaluations; returns the best shape when no more are to do.
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        evaluation: &mut Evaluation<'_, K, B>,
    ) -> Option<Found> {
        let mut evaluations = 0;
        while evaluations < evaluations_a_call(B) {
            if self.round >= HALVINGS {
                return Some(self.best);
            }
            let j = usize::from(self.parameter);
            let (Some(step), Some(grid)) = (self.steps.get(j).copied(), self.grids.get(j)) else {
                self.round = self.round.saturating_add(1);
                self.parameter = 0;
                continue;
            };
            let mut fitted = self.best.term.fitted_parameters();
            if !fitted.any(|fitted| fitted == j) {
                self.next_parameter();
                continue;
            }
            let mut term = self.best.term;
            let step = if self.down { -step } else { step };
            term.set_parameter(j, grid.clamp(term.parameter(j) * math::exp(step)));
            let better = self.best.improve(evaluation.found(term));
            evaluations = evaluations.saturating_add(1);
            if better || self.down {
                self.next_parameter();
            } else {
                self.down = true;
            }
        }
        None
    }

    fn next_parameter(&mut self) {
        if let Some(step) = self.steps.get_mut(usize::from(self.parameter)) {
            *step *= 0.5;
        }
        self.parameter = self.parameter.saturating_add(1);
        self.down = false;
    }
}
