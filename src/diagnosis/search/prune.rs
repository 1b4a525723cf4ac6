//! What a hypothesis does not need.

use super::{
    hypothesis::Hypothesis,
    kind::{at, has_frequency, is_drifting},
    refine::Solver,
};
use crate::{list, numerics::real::Real};
use core::ops::ControlFlow;

/// A resonance of a higher quality is tried as a line.
const NARROW: Real = 15.0;

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Drops one effect after the other, or puts a simpler one in its place, while that lowers the cost.
    pub(super) fn prune(&mut self, hypothesis: Hypothesis) -> ControlFlow<(), Hypothesis> {
        let mut kept = hypothesis;
        loop {
            let mut best: Option<Hypothesis> = None;
            let mut consider = |solver: &mut Self, simpler: Hypothesis| {
                let refined = solver.refine(simpler, 8)?;
                if refined.cost < kept.cost
                    && best.as_ref().is_none_or(|best| refined.cost < best.cost)
                {
                    best = Some(refined);
                }
                ControlFlow::Continue(())
            };
            if kept.filter.is_some() {
                consider(self, Hypothesis::new(None, kept.added.clone()))?;
            }
            for (i, term) in list::numbered(kept.added.iter()) {
                let mut rest = kept.added.clone();
                list::remove(&mut rest, i);
                consider(self, Hypothesis::new(kept.filter, rest.clone()))?;
                let simpler = term.effect.description().special_case;
                let is_narrow = is_drifting(term.effect) || term.parameter(1) > NARROW;
                if let Some(simpler) =
                    simpler.filter(|simpler| has_frequency(*simpler) && is_narrow)
                {
                    let mut parameters = term.parameters;
                    for parameter in parameters.iter_mut().skip(simpler.parameters().len()) {
                        *parameter = 0.0;
                    }
                    let line = at(simpler, &parameters);
                    list::insert(&mut rest, i, line);
                    consider(self, Hypothesis::new(kept.filter, rest))?;
                }
            }
            match best {
                Some(simpler) => kept = simpler,
                None => return ControlFlow::Continue(kept),
            }
        }
    }
}
