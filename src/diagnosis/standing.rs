//! Where a diagnosis stands: the model so far, and what might be added to it.

use super::{
    Addition, Candidate, Diagnosis, Step, Swap,
    revise::Preferred,
    scan::{Scan, scan, span},
    trial::Better,
};
use crate::{
    comparison::Comparison,
    curve::Curve,
    effect::Effect,
    error::Error,
    fit::{
        Fit, Problem,
        generalized::{Rounds, Solution},
    },
    list,
    model::Model,
    nnls::Vector,
    real::Real,
};
use heapless::Vec;

/// Where a diagnosis stands.
pub(super) struct Standing<const K: usize> {
    /// What is reported of the model.
    pub(super) step: Step<K>,
    /// Effects and covariates added so far.
    pub(super) additions: usize,
    /// The model's squared coefficients; before it is judged, where to start from if `has_start`.
    pub(super) squares: Vector,
    pub(super) has_start: bool,
    /// Its score, `−2 ln L`.
    pub(super) score: Real,
    pub(super) adequate: bool,
    /// The best shapes that a scan found: beside the model, or beside `base` if an effect is swapped.
    pub(super) found: Scan,
    pub(super) base: Model,
    /// The model with the best candidate.
    pub(super) best: Better,
    /// The effect that was added last.
    pub(super) preferred: Option<Preferred>,
}

impl<const K: usize> Standing<K> {
    pub(super) fn at(model: &Model) -> Self {
        Self {
            step: Step {
                model: model.clone(),
                follows: None,
                fit: Fit::empty(),
                comparison: Comparison::empty(),
                candidates: Vec::new(),
                added: None,
                ambiguous: Vec::new(),
            },
            additions: 0,
            squares: Vector::zeros(),
            has_start: false,
            score: Real::NAN,
            adequate: false,
            found: Scan::new(),
            base: Model::default(),
            best: Better::empty(),
            preferred: None,
        }
    }

    /// Goes on to the model with the best candidate.
    pub(super) fn accept(&mut self, threshold: Real) {
        self.preferred = Preferred::of(&self.step.candidates, threshold);
        self.step.model.clone_from(&self.best.model);
        self.squares = self.best.squares;
        self.has_start = true;
    }
}

impl Diagnosis {
    /// Fits and compares the step's model; where it is not adequate, finds the best shape of every
    /// effect.
    // What it takes of the stack is free again for the trials.
    #[inline(never)]
    pub(super) fn judge<const K: usize>(
        &self,
        curve: &Curve<K>,
        effects: &[&'static dyn Effect],
        standing: &mut Standing<K>,
    ) -> Result<(), Error> {
        let step = &mut standing.step;
        let problem = Problem::new(curve, &step.model);
        let mut solution = Solution::new(&problem);
        if standing.has_start {
            // Once the tolerance was granted it stays: steps are compared with each other.
            solution.converge(standing.squares, self.tolerance, Rounds::All)?;
        } else {
            solution.solve(self.tolerance)?;
        }
        standing.squares = solution.squares;
        standing.score = solution.minus_two_log_likelihood();
        standing.adequate = solution.p_value() >= self.adequate_p;
        let span = span(curve);
        solution.report(&mut step.fit);
        solution.bound_shapes(&mut step.fit, &span)?;
        let octaves = problem.points.len();
        let unknowns = octaves.saturating_sub(step.fit.degrees_of_freedom);
        step.comparison
            .set(&problem, &solution.weights, &solution.squares, unknowns);
        standing.found.clear();
        if !standing.adequate {
            scan(&problem, &solution, effects, &span, &mut standing.found);
        }
        Ok(())
    }

    /// Fits the shapes that a scan found: the best few become candidates of the step, the model with
    /// the very best is kept. The scan was made beside the step's model, or beside one with a swap.
    #[inline(never)]
    pub(super) fn try_all<const K: usize>(
        &self,
        curve: &Curve<K>,
        swap: Option<Swap>,
        standing: &mut Standing<K>,
    ) {
        let Standing {
            step,
            found,
            base,
            best,
            score,
            ..
        } = standing;
        let known = |step: &Step<K>, candidate: &Candidate| {
            let mut others = step.candidates.iter();
            others.any(|other| other.brings_the_same(candidate))
        };
        let gained = step
            .candidates
            .first()
            .map_or(0.0, |first| first.improvement);
        let mut least = *score - gained;
        let mut better = Better::empty();
        for found in &*found {
            let model = if swap.is_some() { &*base } else { &step.model };
            if better.begin(model, found).is_err() {
                continue;
            }
            // An effect that cannot be fitted is no candidate.
            let mut candidate = Candidate {
                term: found.term,
                swap,
                coefficient: 0.0,
                chi_squared: Real::NAN,
                improvement: 0.0,
            };
            if known(step, &candidate) {
                continue;
            }
            let fitted = better.fit(curve, self.tolerance, least, &mut candidate);
            let Ok(Some(fitted)) = fitted else {
                continue;
            };
            least = least.min(fitted);
            candidate.improvement = *score - fitted - 2.0 * candidate.cost();
            let place = list::rank(&mut step.candidates, candidate, |other| {
                other.improvement < candidate.improvement
            });
            if place == Some(0) {
                best.clone_from(&better);
            }
        }
    }

    /// Adds the best candidate if it is worth its parameters, and names those that are about as good.
    pub(super) fn choose<const K: usize>(&self, step: &mut Step<K>) {
        let Some((first, others)) = step.candidates.split_first() else {
            return;
        };
        if first.improvement < self.threshold {
            return;
        }
        step.added = Some(Addition::Effect(first.term));
        let dropped = first.swap.map(|swap| swap.dropped.name());
        let chosen = first.brings(dropped);
        let close = |other: &&Candidate| other.improvement > first.improvement - self.ambiguity;
        for other in others.iter().filter(close) {
            for name in other.brings(dropped).into_iter().flatten() {
                if !chosen.contains(&Some(name)) && !step.ambiguous.contains(&name) {
                    // As many names as candidates bring.
                    let _ = step.ambiguous.push(name);
                }
            }
        }
    }
}
