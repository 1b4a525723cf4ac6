//! The whole search.

use super::{
    Pause,
    cross::suspects,
    grow::is_added,
    hypothesis::{Added, Hypothesis, is_permutation},
    likelihood::Workspace,
    pool::Pool,
    price::has_frequency,
    refine::{MAX_VARIANTS, Solver},
    rows::{Observation, Values},
    variant::Variant,
};
use crate::{
    effect::Effect,
    limits::MAX_EFFECTS,
    list,
    model::{Model, Term},
    math,
    real::Real,
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The hypotheses that grow side by side, and those that are kept until the end.
const BEAM: usize = 8;
const KEPT: usize = 20;
const STARTS: usize = 12;
/// How often hypotheses grow.
const DEPTH: u8 = 5;
/// A hypothesis that lags behind the best one by more does not grow, and one that lags by more is not crossed. Where the
/// best one is far from explaining the record, others may lag by as much as is left.
const LAGS: Real = 60.0;
const LAGS_CROSSED: Real = 40.0;
/// A start that is not better than the plain model by this much does not grow.
const EVIDENCE: Real = 4.0;
/// The growth ends when the best new hypothesis is worse than the best one by more.
const WORSE: Real = 8.0;
/// The sets of additions that are crossed with all filters in each round.
const CROSSED: usize = 3;
/// The hypotheses that are pruned at the end.
const PRUNED: usize = 10;

/// What a search may do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// The largest number of effects.
    pub(crate) effects: usize,
    /// What an effect has to gain beyond two for each parameter; see [`price`](super::price).
    pub(crate) threshold: Real,
    /// Alternatives cost up to this much more than the best hypothesis.
    pub(crate) ambiguity: Real,
}

/// A hypothesis of as many effects whose score is less than this above that of the best one is as good.
const AS_GOOD: Real = 2.0;

/// The alternatives that are told.
pub(crate) const MAX_ALTERNATIVES: usize = 6;

/// What a search found: the best hypothesis, and those that explain the record about as well, with their costs beyond it.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) best: Hypothesis,
    pub(crate) alternatives: Vec<(Hypothesis, Real), MAX_ALTERNATIVES>,
    /// The score of the model without filter and additions.
    pub(crate) plain: Real,
}

/// A search, with its memory.
pub(crate) struct Search<const B: usize> {
    work: Workspace<B>,
    grown: Pool<BEAM>,
    beam: Pool<STARTS>,
    done: Pool<KEPT>,
    shapes: Vec<Term, MAX_VARIANTS>,
}

fn score(hypothesis: &Hypothesis) -> Real {
    hypothesis.score
}

fn cost(hypothesis: &Hypothesis) -> Real {
    hypothesis.cost
}

impl<const B: usize> Search<B> {
    /// A search that has not begun.
    pub(crate) const NEW: Self = Self {
        work: Workspace::NEW,
        grown: Pool::new(2, score),
        beam: Pool::new(2, score),
        done: Pool::new(3, cost),
        shapes: Vec::new(),
    };

    /// Looks for what a model lacks in a list of effects.
    pub(crate) fn run(
        &mut self,
        observation: &Observation<'_, B>,
        model: &Model,
        effects: &[&'static dyn Effect],
        limits: Limits,
        pause: &mut Pause<'_>,
    ) -> ControlFlow<(), Found> {
        let Self {
            work,
            grown,
            beam,
            done,
            shapes,
        } = self;
        let white = set_common(work, observation, model, effects);
        let filters = || {
            let has_white = white.is_some();
            let filters = effects.iter().copied().filter(move |effect| has_white && effect.replaces().is_some());
            filters.flat_map(|effect| Variant::of(effect, &observation.span))
        };
        let noises: Vec<&'static dyn Effect, 4> = list::fill(
            effects.iter().copied().filter(|effect| is_added(*effect) && !has_frequency(*effect) && effect.parameters().len() == 1),
        );
        let mut solver = Solver {
            observation,
            work,
            white,
            shapes,
            limits: Limits {
                effects: limits.effects.min(MAX_EFFECTS.saturating_sub(model.terms().len()).saturating_add(usize::from(white.is_some()))),
                ..limits
            },
            pause,
        };
        grown.clear();
        beam.clear();
        done.clear();

        // The filters of the continuum, those of the best continuum first.
        let mut plain: Option<Hypothesis> = None;
        let mut masked: Vec<(Hypothesis, Real), 6> = Vec::new();
        solver.start(&mut filters(), &noises, &mut |whole, continuum| {
            if plain.is_none() {
                plain = Some(whole.clone());
            }
            list::rank(&mut masked, (whole.clone(), continuum), |other| other.1 > continuum);
            beam.enter(whole);
        })?;
        for (hypothesis, _) in &masked {
            beam.enter(hypothesis);
        }
        let Some(plain) = plain else {
            return ControlFlow::Break(());
        };
        done.enter(&plain);
        for hypothesis in beam.as_slice() {
            done.enter(hypothesis);
        }

        let mut crossed: Vec<Added, { CROSSED * DEPTH as usize }> = Vec::new();
        // Those that the data speak for grow, and the plain one.
        let spoken = beam.as_slice().iter().filter(|hypothesis| hypothesis.score < plain.score - EVIDENCE);
        let mut parents: Vec<Hypothesis, STARTS> = list::fill(core::iter::once(&plain).chain(spoken).cloned());
        for depth in 0..DEPTH {
            #[cfg(feature = "lab")]
            {
                extern crate std;
                std::eprintln!("== depth {depth} parents");
                for h in &parents { std::eprintln!("  {:.1} {:.1} {:?}", h.score, h.cost, h.terms().collect::<std::vec::Vec<_>>()); }
            }
            let _ = depth;
            grown.clear();
            let mut best_new = Real::INFINITY;
            let lead = |done: &Pool<KEPT>, grown: &Pool<BEAM>| {
                let all = done.as_slice().iter().chain(grown.as_slice());
                all.map(score).fold(Real::INFINITY, Real::min)
            };
            for parent in &parents {
                solver.grow(parent, effects, &mut |_, hypothesis| {
                    best_new = best_new.min(hypothesis.score);
                    grown.enter(hypothesis);
                    done.enter(hypothesis);
                    ControlFlow::Continue(())
                })?;
            }
            // The best sets of additions behind the other filters.
            let top = lead(done, grown);
            let left = (top - observation.expected_deviance()).max(0.0);
            let mut sets: Vec<(Added, Hypothesis), CROSSED> = Vec::new();
            let mut ranked: Vec<&Hypothesis, { BEAM + KEPT }> = Vec::new();
            for hypothesis in grown.as_slice().iter().chain(done.as_slice()) {
                list::rank(&mut ranked, hypothesis, |other| other.score > hypothesis.score);
            }
            for hypothesis in ranked {
                for added in [hypothesis.added.clone(), suspects(&hypothesis.added, observation.interval_s)] {
                    let is_known = crossed.iter().any(|known| is_permutation(known, &added));
                    if !added.is_empty() && !is_known && hypothesis.score < top + LAGS_CROSSED + left && !sets.is_full() {
                        let _ = crossed.push(added.clone());
                        let _ = sets.push((added, hypothesis.clone()));
                    }
                }
            }
            #[cfg(feature = "lab")]
            {
                extern crate std;
                std::eprintln!("-- grown");
                for h in grown.as_slice() { std::eprintln!("  {:.1} {:.1} {:?}", h.score, h.cost, h.terms().collect::<std::vec::Vec<_>>()); }
                std::eprintln!("-- sets");
                for (h, f) in &sets { std::eprintln!("  {:.1} {:?}", f.score, h); }
            }
            for (added, from) in &sets {
                let own = (added.len() == from.added.len()).then_some(from);
                solver.cross(added, own, &mut |hypothesis| {
                    best_new = best_new.min(hypothesis.score);
                    grown.enter(hypothesis);
                    done.enter(hypothesis);
                })?;
            }
            let top = lead(done, grown);
            let near = grown.as_slice().iter().filter(|hypothesis| hypothesis.score < top + LAGS + left);
            parents = list::fill(near.cloned());
            if parents.is_empty() || best_new > top + WORSE {
                break;
            }
        }
        let mut finals: Vec<Hypothesis, PRUNED> = Vec::new();
        for hypothesis in done.as_slice().iter().take(PRUNED) {
            let pruned = solver.prune(hypothesis.clone())?;
            match finals.iter_mut().find(|other| other.is_like(&pruned)) {
                Some(other) if pruned.cost < other.cost => *other = pruned,
                Some(_) => {}
                None => {
                    let _ = finals.push(pruned);
                }
            }
        }
        ControlFlow::Continue(chosen(&finals, done.as_slice(), &plain, limits.ambiguity))
    }
}

/// Sets the columns of the terms that every hypothesis has. Returns the term of the white noise, which is what the filters
/// of the list replace.
#[inline(never)]
fn set_common<const B: usize>(
    work: &mut Workspace<B>,
    observation: &Observation<'_, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
) -> Option<Term> {
    let replaced = effects.iter().find_map(|effect| effect.replaces());
    let is_white = |term: &&Term| {
        replaced.is_some_and(|white| term.effect.name() == white.name() && !term.fitted)
    };
    let white = model.terms().iter().find(is_white).copied();
    work.common.clear();
    for term in model.terms().iter().filter(|term| !is_white(term)) {
        if work.common.push(Values::ZEROS).is_ok()
            && let Some(values) = work.common.last_mut()
        {
            observation.column(term, None, values);
        }
    }
    work.shape = observation.shape;
    white
}

impl<const B: usize> Search<B> {
    /// The effects of a hypothesis in the order in which they lower `−2 ln L` most, each with its fall. The shapes stay.
    pub(crate) fn ordered(
        &mut self,
        observation: &Observation<'_, B>,
        model: &Model,
        effects: &[&'static dyn Effect],
        hypothesis: &Hypothesis,
        pause: &mut Pause<'_>,
    ) -> ControlFlow<(), Vec<(Term, Real), 4>> {
        let white = set_common(&mut self.work, observation, model, effects);
        let mut solver = Solver {
            observation,
            work: &mut self.work,
            white,
            shapes: &mut self.shapes,
            limits: Limits {
                effects: 4,
                threshold: 0.0,
                ambiguity: 0.0,
            },
            pause,
        };
        let mut ordered: Vec<(Term, Real), 4> = Vec::new();
        let mut present = Hypothesis::new(None, Added::new());
        let mut before = solver.deviance(&present)?;
        loop {
            let mut best: Option<(Hypothesis, Term, Real)> = None;
            for term in hypothesis.terms() {
                let is_told = ordered.iter().any(|(told, _)| told.effect.name() == term.effect.name() && told.parameters == term.parameters);
                if is_told {
                    continue;
                }
                let mut more = present.clone();
                if term.effect.replaces().is_some() {
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
}

/// The best shape of an effect beside a model. A whole number above zero is kept. `None` if no shape adds anything.
pub(crate) fn best_shape_of<const B: usize>(
    observation: &Observation<'_, B>,
    model: &Model,
    term: &Term,
) -> Option<Term> {
    let effect = term.effect;
    let mut work = Workspace::<B>::NEW;
    let white = set_common(&mut work, observation, model, &[effect]);
    let mut go_on = || ControlFlow::Continue(());
    let mut solver = Solver {
        observation,
        work: &mut work,
        white,
        shapes: &mut Vec::new(),
        limits: Limits {
            effects: MAX_EFFECTS,
            threshold: 0.0,
            ambiguity: 0.0,
        },
        pause: &mut go_on,
    };
    let ControlFlow::Continue(plain) = solver.refine(Hypothesis::new(None, Added::new()), 0) else {
        return None;
    };
    let mut best: Option<Hypothesis> = None;
    let wanted = |variant: &Variant| {
        let known = Variant::of_term(term).whole;
        known == 0 || variant.whole == known
    };
    let mut keep = |found: &Hypothesis| {
        if best.as_ref().is_none_or(|best| found.score < best.score) {
            best = Some(found.clone());
        }
    };
    if effect.replaces().is_some() {
        for variant in Variant::of(effect, &observation.span).filter(wanted) {
            if let ControlFlow::Continue(found) = solver.best_filter(variant, &plain)
                && let ControlFlow::Continue(found) = solver.refine(found, 10)
            {
                keep(&found);
            }
        }
    } else {
        let _ = solver.grow(&plain, &[effect], &mut |_, found| {
            keep(found);
            ControlFlow::Continue(())
        });
    }
    best?.terms().next().copied()
}

/// The hypothesis whose names have the largest weight, the sum of `exp(−Δ/2)` over those that share them: six low passes
/// near one boxcar are a low pass. Alternatives are those of other kinds that cost little more.
fn chosen(
    finals: &[Hypothesis],
    done: &[Hypothesis],
    plain: &Hypothesis,
    ambiguity: Real,
) -> Found {
    let low = finals.iter().map(cost).fold(Real::INFINITY, Real::min);
    let weight = |hypothesis: &Hypothesis| -> Real {
        let same = finals.iter().filter(|other| other.is_named_like(hypothesis));
        same.map(|other| math::exp(0.5 * (low - other.cost))).sum()
    };
    let heaviest = finals.iter().map(&weight).fold(0.0, Real::max);
    let leading = finals.iter().filter(|one| weight(one) >= heaviest);
    let best = leading.min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap_or(plain);
    let mut alternatives: Vec<(Hypothesis, Real), MAX_ALTERNATIVES> = Vec::new();
    for other in finals.iter().chain(done) {
        let beyond = other.cost - best.cost;
        let is_told = |known: &(Hypothesis, Real)| known.0.is_like(other);
        // Effects of one spectrum are told, whatever their prices.
        let is_as_good = other.score < best.score + AS_GOOD
            && list::count(other.terms()) == list::count(best.terms());
        if !(beyond < ambiguity || is_as_good) || other.is_like(best) || other.is_general_form_of(best) {
            continue;
        }
        if let Some(place) = alternatives.iter().position(is_told) {
            if alternatives.get(place).is_some_and(|known| known.1 <= beyond) {
                continue;
            }
            list::remove(&mut alternatives, place);
        }
        list::rank(&mut alternatives, (other.clone(), beyond), |known| known.1 > beyond);
    }
    Found {
        best: best.clone(),
        alternatives,
        plain: plain.score,
    }
}

/// The terms of a hypothesis, in words for tests.
#[cfg(test)]
impl Hypothesis {
    pub(crate) fn names(&self) -> std::vec::Vec<&'static str> {
        self.terms().map(|term: &Term| term.effect.name()).collect()
    }
}

impl<const B: usize> Search<B> {
    pub(crate) fn lab(
        &mut self,
        observation: &Observation<'_, B>,
        model: &Model,
        effects: &[&'static dyn Effect],
        filter: Option<Term>,
        added: &[Term],
        each: &mut dyn FnMut(&[Term], Real, Real),
    ) {
        let white = set_common(&mut self.work, observation, model, effects);
        let mut pause = || ControlFlow::Continue(());
        let mut solver = Solver {
            observation,
            work: &mut self.work,
            white,
            shapes: &mut self.shapes,
            limits: Limits { effects: 4, threshold: 8.0, ambiguity: 6.0 },
            pause: &mut pause,
        };
        for rounds in [0, 1, 2, 3, 5, 10, 20] {
            let h = Hypothesis::new(filter, list::fill(added.iter().copied()));
            if let ControlFlow::Continue(h) = solver.refine(h, rounds) {
                let terms: Vec<Term, 4> = list::fill(h.terms().copied());
                each(&terms, h.score, h.cost);
            }
        }
    }
}
