//! The way not taken: a step with a candidate that was not added.

use super::{Candidate, Diagnosis, Step, standing::Standing, trial::Better};
use crate::{
    curve::Curve,
    error::Error,
    fit::{Problem, generalized::Solution},
    model::{Model, Term},
    real::Real,
};

impl Diagnosis {
    /// The step that would have followed `step` with another candidate of it: the model with the
    /// candidate, all fitted shapes polished, and where it fails. It has no candidates of its own.
    /// `before` is the step before, whose candidates tell the shape of what a
    /// [`swap`](Candidate::swap) takes; `curve` is the one that `step` was judged on, without what
    /// follows a covariate.
    ///
    /// # Errors
    /// As of [`fit`](crate::fit); [`Error::TooManyEffects`] where the model has no room.
    pub fn alternative<const K: usize>(
        &self,
        curve: &Curve<K>,
        step: &Step<K>,
        before: Option<&Step<K>>,
        candidate: &Candidate,
    ) -> Result<Step<K>, Error> {
        let mut model = step.model.clone();
        if let Some(swap) = candidate.swap {
            let known = before.into_iter().flat_map(|before| &before.candidates);
            let mut same = known.filter(|known| known.term.effect.name() == swap.taken.name());
            let taken = same.next().map(|known| known.term);
            model.exchange(swap.dropped, taken.unwrap_or(Term::fitted(swap.taken)))?;
        }
        if let Some(replaced) = candidate.term.effect.replaces() {
            model.remove(replaced.name());
        }
        model.add(candidate.term)?;
        self.polished(curve, model, candidate, step)
    }

    fn polished<const K: usize>(
        &self,
        curve: &Curve<K>,
        model: Model,
        candidate: &Candidate,
        step: &Step<K>,
    ) -> Result<Step<K>, Error> {
        let squares = {
            let problem = Problem::new(curve, &model);
            let mut solution = Solution::new(&problem);
            solution.solve(self.tolerance)?;
            solution.squares
        };
        let mut better = Better { model, squares };
        // Infinitely much to gain: no round is hopeless.
        better.fit(
            curve,
            self.tolerance,
            Real::INFINITY,
            &mut candidate.clone(),
        )?;
        let mut standing = Standing::at(&better.model);
        standing.step.follows = step.follows;
        standing.squares = better.squares;
        standing.has_start = true;
        self.judge(curve, &[], &mut standing)?;
        Ok(standing.step)
    }
}
