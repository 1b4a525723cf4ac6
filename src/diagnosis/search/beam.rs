//! The growth of hypotheses: one more effect on each of the best ones, and what was added behind every filter.

use super::{
    cross::suspects,
    hypothesis::{Added, Hypothesis, MAX_ADDED, is_near},
    pool::Pool,
    refine::Solver,
};
use crate::{list, numerics::real::Real, theory::effect::Effect};
use core::ops::ControlFlow;
use heapless::Vec;

/// The largest number of effects of a hypothesis.
pub(super) const MOST: usize = MAX_ADDED + 1;
/// The hypotheses of as many effects that grow side by side.
const BEAM: usize = 4;
/// The best hypotheses of the continuum, narrow peaks left out, which grow too.
const CONTINUA: usize = 2;
/// A hypothesis that lags behind the best one of as many effects by more does not grow, and one that lags by more is not
/// crossed. Where the best one is far from explaining the record, others may lag by as much as is left.
const LAGS: Real = 25.0;
const LAGS_CROSSED: Real = 15.0;
/// A hypothesis that is not better than the plain model by this much does not grow.
const EVIDENCE: Real = 4.0;
/// The growth ends when the best hypothesis of one more effect is worse than the best one by more. Octaves alone show two
/// effects less well one by one.
const WORSE: Real = 2.5;
const WORSE_IN_OCTAVES: Real = 5.0;
/// The sets of additions that are crossed with all filters, for each number of effects.
const CROSSED: usize = 3;
/// The lead in cost that an effect needs over its own special case.
pub(super) const OVER_SPECIAL_CASE: Real = 5.0;

/// The best hypotheses of no effect, of one effect and so on.
pub(super) type Beams = [Pool<BEAM>; MOST + 1];

/// Hypotheses to grow, and what was tried.
pub(super) struct Growth {
    /// The model as it is; `None` until the continuum was fitted.
    pub(super) plain: Option<Hypothesis>,
    /// The best hypotheses of the continuum, with their scores in it.
    continua: Vec<(Hypothesis, Real), CONTINUA>,
    /// The additions that were tried behind every filter.
    crossed: Vec<Added, { CROSSED * (MOST + 1) }>,
    /// The lowest score of all.
    best: Real,
}

/// Keeps a hypothesis among those of as many effects. Returns the score that others have to beat.
fn enter(beams: &mut [Pool<BEAM>], hypothesis: &Hypothesis) -> Real {
    match beams.get_mut(list::count(hypothesis.terms())) {
        Some(beam) => {
            beam.enter(hypothesis);
            beam.bar()
        }
        None => Real::INFINITY,
    }
}

/// The lowest score of some hypotheses.
fn lowest(hypotheses: &[Hypothesis]) -> Real {
    let scores = hypotheses.iter().map(|hypothesis| hypothesis.score);
    scores.fold(Real::INFINITY, Real::min)
}

/// Whether a general form gains so little over a special case among these that it tells the same story.
fn is_told(hypothesis: &Hypothesis, known: &[Hypothesis]) -> bool {
    known.iter().any(|other| {
        hypothesis.is_general_form_of(other) && other.score < hypothesis.score + OVER_SPECIAL_CASE
    })
}

impl Growth {
    /// Before anything is known.
    pub(super) const NEW: Self = Self {
        plain: None,
        continua: Vec::new(),
        crossed: Vec::new(),
        best: Real::INFINITY,
    };

    /// Keeps a filter of the continuum, of which the first one is none. Returns the score that others have to beat.
    pub(super) fn begin(&mut self, beams: &mut Beams, whole: &Hypothesis, continuum: Real) -> Real {
        if self.plain.is_none() {
            self.plain = Some(whole.clone());
            self.best = whole.score;
        }
        list::rank(&mut self.continua, (whole.clone(), continuum), |other| {
            other.1 > continuum
        });
        enter(beams, whole)
    }

    /// Grows the best hypotheses of as many effects. Returns whether one more effect may explain more.
    pub(super) fn go_on<const B: usize>(
        &mut self,
        plain: &Hypothesis,
        solver: &mut Solver<'_, '_, '_, B>,
        beams: &mut Beams,
        effects: &[&'static dyn Effect],
        count: usize,
    ) -> ControlFlow<(), bool> {
        let Some(beam) = beams.get_mut(count) else {
            return ControlFlow::Continue(false);
        };
        solver.pass_all(beam, effects)?;
        let (drifted, left) = self.drift(plain, solver, beam, effects, count, &[])?;
        // What is found behind another filter grows too.
        self.cross(solver, beams, count, left)?;
        let Some((lower, higher)) = beams.split_at_mut_checked(count.saturating_add(1)) else {
            return ControlFlow::Continue(false);
        };
        let Some(beam) = lower.last_mut() else {
            return ControlFlow::Continue(false);
        };
        let (_, left) = self.drift(plain, solver, beam, effects, count, &drifted)?;
        let parents = self.parents(plain, beam.as_slice(), count, left);
        for parent in parents.iter().filter(|_| count < MOST) {
            solver.grow(parent, effects, &mut |hypothesis| {
                let of = list::count(hypothesis.terms());
                let later = of.checked_sub(count.saturating_add(1));
                match later.and_then(|later| higher.get_mut(later)) {
                    Some(pool) => {
                        pool.enter(hypothesis);
                        pool.bar()
                    }
                    None => Real::INFINITY,
                }
            })?;
        }
        let next = beams.get(count.saturating_add(1));
        let next = next.map_or(Real::INFINITY, |beam| lowest(beam.as_slice()));
        let worse = if solver.observation.has_bins() {
            WORSE
        } else {
            WORSE_IN_OCTAVES
        };
        ControlFlow::Continue(next <= self.best + worse)
    }

    /// Lets the oscillations of the best hypotheses of as many effects drift, those left out that were looked at before.
    /// Returns the ones that were looked at, and what the best hypothesis of all leaves to explain.
    fn drift<const B: usize>(
        &mut self,
        plain: &Hypothesis,
        solver: &mut Solver<'_, '_, '_, B>,
        beam: &mut Pool<BEAM>,
        effects: &[&'static dyn Effect],
        count: usize,
        before: &[Hypothesis],
    ) -> ControlFlow<(), (Vec<Hypothesis, { BEAM + CONTINUA }>, Real)> {
        self.best = self.best.min(lowest(beam.as_slice()));
        let left = (self.best - solver.observation.expected_deviance()).max(0.0);
        let parents = self.parents(plain, beam.as_slice(), count, left);
        for parent in parents.iter().filter(|_| count < MOST) {
            if before
                .iter()
                .any(|other| other.score.to_bits() == parent.score.to_bits())
            {
                continue;
            }
            solver.drift(parent, effects, &mut |hypothesis| {
                beam.enter(hypothesis);
                beam.bar()
            })?;
        }
        ControlFlow::Continue((parents, left))
    }

    /// The hypotheses of a beam, and those of the continuum with as many effects, that are worth another effect.
    fn parents(
        &self,
        plain: &Hypothesis,
        known: &[Hypothesis],
        count: usize,
        left: Real,
    ) -> Vec<Hypothesis, { BEAM + CONTINUA }> {
        let lead = lowest(known);
        let is_worth = |hypothesis: &&Hypothesis| {
            let is_plain = list::count(hypothesis.terms()) == 0;
            is_plain
                || (hypothesis.score < plain.score - EVIDENCE
                    && hypothesis.score < lead + LAGS + left)
        };
        let others = self.continua.iter().map(|(hypothesis, _)| hypothesis);
        let of_count = others.filter(|other| list::count(other.terms()) == count);
        let more = of_count.filter(|other| !known.iter().any(|known| known.is_like(other)));
        list::fill(
            known
                .iter()
                .chain(more)
                .filter(|hypothesis| is_worth(hypothesis) && !is_told(hypothesis, known))
                .cloned(),
        )
    }

    /// Tries the best sets of additions behind the other filters.
    fn cross<const B: usize>(
        &mut self,
        solver: &mut Solver<'_, '_, '_, B>,
        beams: &mut Beams,
        count: usize,
        left: Real,
    ) -> ControlFlow<()> {
        let beam = beams.get(count).map_or(&[][..], Pool::as_slice);
        let mut sets: Vec<(Added, Hypothesis), CROSSED> = Vec::new();
        let top = lowest(beam);
        for hypothesis in beam {
            if is_told(hypothesis, beam) {
                continue;
            }
            let broad = suspects(&hypothesis.added, solver.observation.interval_s);
            for added in [hypothesis.added.clone(), broad] {
                let is_known = self.crossed.iter().any(|known| is_near(known, &added));
                let is_close = hypothesis.score < top + LAGS_CROSSED + left;
                if !added.is_empty() && !is_known && is_close && !sets.is_full() {
                    let _ = self.crossed.push(added.clone());
                    let _ = sets.push((added, hypothesis.clone()));
                }
            }
        }
        for (added, from) in &sets {
            let is_own = added.len() == from.added.len();
            solver.cross(added, from, is_own, &mut |hypothesis| {
                enter(beams, hypothesis)
            })?;
        }
        ControlFlow::Continue(())
    }
}

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Lets all noise pass the filters of the best hypotheses of as many effects.
    fn pass_all(
        &mut self,
        beam: &mut Pool<BEAM>,
        effects: &[&'static dyn Effect],
    ) -> ControlFlow<()> {
        let known: Vec<Hypothesis, BEAM> = list::fill(beam.as_slice().iter().cloned());
        for hypothesis in known.iter().filter(|known| !known.added.is_empty()) {
            if let Some(of_all) = self.passing(effects, hypothesis)? {
                beam.enter(&of_all);
            }
        }
        ControlFlow::Continue(())
    }
}
