//! The whole search.

use super::{
    cross::suspects,
    hypothesis::{AS_GOOD, Added, Hypothesis, MAX_ADDED, is_near},
    kind::{is_added, is_filter, is_white},
    likelihood::Workspace,
    limits::Limits,
    pool::Pool,
    refine::{MAX_VARIANTS, NO_BARS, Solver},
    rows::Observation,
    variant::Variant,
    white::WhiteRange,
};
use crate::{
    limits::MAX_EFFECTS,
    list,
    numerics::{math, real::Real},
    pause::Pause,
    theory::{
        effect::Effect,
        model::{Model, Term},
    },
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The largest number of effects of a hypothesis.
const MOST: usize = MAX_ADDED + 1;
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
/// The hypotheses that are pruned at the end.
const PRUNED: usize = 5;

/// The lead in cost that an effect needs over its own special case.
const OVER_SPECIAL_CASE: Real = 5.0;

/// The alternatives that are reported.
pub(crate) const MAX_ALTERNATIVES: usize = 6;

/// What a search found: the best hypothesis, and those that explain the record about as well, with their costs beyond it.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) best: Hypothesis,
    pub(crate) alternatives: Vec<(Hypothesis, Real), MAX_ALTERNATIVES>,
    /// What the white noise is in the alternatives; `None` if there are none that say it.
    pub(crate) white: Option<WhiteRange>,
}

/// A search, with its memory.
pub(crate) struct Search<const B: usize> {
    work: Workspace<B>,
    /// The best hypotheses of no effect, of one effect and so on.
    beams: [Pool<BEAM>; MOST + 1],
    shapes: Vec<Term, MAX_VARIANTS>,
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

fn cost(hypothesis: &Hypothesis) -> Real {
    hypothesis.cost
}

impl<const B: usize> Search<B> {
    /// A search that has not begun.
    pub(crate) const NEW: Self = Self {
        work: Workspace::NEW,
        beams: [const { Pool::NEW }; MOST + 1],
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
            beams,
            shapes,
        } = self;
        pause()?;
        let white = set_common(work, observation, model, effects);
        pause()?;
        let filters = || {
            let has_white = white.is_some();
            let filters = effects
                .iter()
                .copied()
                .filter(move |effect| has_white && is_filter(*effect) && !effect.passes_all());
            filters.flat_map(|effect| Variant::of(effect, &observation.span))
        };
        let is_slow = |effect: &dyn Effect| {
            let first = effect.parameters().first();
            first.is_some_and(|first| first.unit == "s") && effect.parameters().len() == 1
        };
        let noises: Vec<&'static dyn Effect, 4> = list::fill(
            effects
                .iter()
                .copied()
                .filter(|effect| is_added(*effect) && is_slow(*effect)),
        );
        let mut solver = Solver {
            observation,
            work,
            white,
            model,
            shapes,
            limits: Limits {
                effects: limits.effects.min(
                    MAX_EFFECTS
                        .saturating_sub(model.terms().len())
                        .saturating_add(usize::from(white.is_some())),
                ),
                ..limits
            },
            bars: NO_BARS,
            pause,
        };
        for beam in beams.iter_mut() {
            beam.clear();
        }

        // The filters of the continuum, and the best continua.
        let mut plain: Option<Hypothesis> = None;
        let mut continua: Vec<(Hypothesis, Real), CONTINUA> = Vec::new();
        solver.start(&mut filters(), &noises, effects, &mut |whole, continuum| {
            if plain.is_none() {
                plain = Some(whole.clone());
            }
            list::rank(&mut continua, (whole.clone(), continuum), |other| {
                other.1 > continuum
            });
            enter(beams, whole)
        })?;
        let Some(plain) = plain else {
            return ControlFlow::Break(());
        };

        // One more effect on each of the best hypotheses of as many effects.
        let mut crossed: Vec<Added, { CROSSED * (MOST + 1) }> = Vec::new();
        let mut best = plain.score;
        for count in 0..=MOST {
            let Some((lower, higher)) = beams.split_at_mut_checked(count.saturating_add(1)) else {
                break;
            };
            let Some(beam) = lower.last_mut() else { break };
            solver.pass_all(beam, effects)?;
            let lead = lowest(beam.as_slice());
            best = best.min(lead);
            let left = (best - observation.expected_deviance()).max(0.0);
            let is_worth = |hypothesis: &&Hypothesis| {
                let is_plain = list::count(hypothesis.terms()) == 0;
                is_plain
                    || (hypothesis.score < plain.score - EVIDENCE
                        && hypothesis.score < lead + LAGS + left)
            };
            // A general form that gains little over its special case tells the same story.
            let is_told = |hypothesis: &Hypothesis, known: &[Hypothesis]| {
                known.iter().any(|other| {
                    hypothesis.is_general_form_of(other)
                        && other.score < hypothesis.score + OVER_SPECIAL_CASE
                })
            };
            let others = continua.iter().map(|(hypothesis, _)| hypothesis);
            let of_count = others.filter(|other| list::count(other.terms()) == count);
            let known = beam.as_slice();
            let more = of_count.filter(|other| !known.iter().any(|known| known.is_like(other)));
            let parents: Vec<Hypothesis, { BEAM + CONTINUA }> = list::fill(
                known
                    .iter()
                    .chain(more)
                    .filter(|hypothesis| is_worth(hypothesis) && !is_told(hypothesis, known))
                    .cloned(),
            );
            for parent in parents.iter().filter(|_| count < MOST) {
                solver.grow(parent, effects, &mut |hypothesis| {
                    let of = list::count(hypothesis.terms());
                    let later = of.checked_sub(count.saturating_add(1));
                    let pool = match later.and_then(|later| higher.get_mut(later)) {
                        Some(pool) => pool,
                        // A more general effect in the place of one of the parent's.
                        None if of == count => &mut *beam,
                        None => return Real::INFINITY,
                    };
                    pool.enter(hypothesis);
                    pool.bar()
                })?;
            }
            // The best sets of additions behind the other filters.
            let mut sets: Vec<(Added, Hypothesis), CROSSED> = Vec::new();
            let top = lowest(beam.as_slice());
            for hypothesis in beam.as_slice() {
                if is_told(hypothesis, beam.as_slice()) {
                    continue;
                }
                let broad = suspects(&hypothesis.added, observation.interval_s);
                for added in [hypothesis.added.clone(), broad] {
                    let is_known = crossed.iter().any(|known| is_near(known, &added));
                    let is_close = hypothesis.score < top + LAGS_CROSSED + left;
                    if !added.is_empty() && !is_known && is_close && !sets.is_full() {
                        let _ = crossed.push(added.clone());
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
            let next = beams.get(count.saturating_add(1));
            let next = next.map_or(Real::INFINITY, |beam| lowest(beam.as_slice()));
            let worse = if observation.has_bins() {
                WORSE
            } else {
                WORSE_IN_OCTAVES
            };
            if next > best + worse {
                break;
            }
        }

        // The cheapest of all, without what they do not need.
        let mut cheapest: Vec<&Hypothesis, PRUNED> = Vec::new();
        for hypothesis in beams.iter().flat_map(Pool::as_slice) {
            list::rank(&mut cheapest, hypothesis, |other| {
                other.cost > hypothesis.cost
            });
        }
        let mut finals: Vec<Hypothesis, PRUNED> = Vec::new();
        solver.bars = NO_BARS;
        for hypothesis in &cheapest {
            let pruned = solver.prune((*hypothesis).clone())?;
            match finals.iter_mut().find(|other| other.is_like(&pruned)) {
                Some(other) if pruned.cost < other.cost => *other = pruned,
                Some(_) => {}
                None => {
                    let _ = finals.push(pruned);
                }
            }
        }
        let mut found = chosen(&finals, &cheapest, &plain, limits.ambiguity);
        found.white = solver.range_of_white(&found.best, &found.alternatives)?;
        ControlFlow::Continue(found)
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

/// The best shape of an effect that is added to a model. A whole number above zero is kept. `None` if no shape adds anything.
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
        model,
        shapes: &mut Vec::new(),
        limits: Limits {
            effects: MAX_EFFECTS,
            threshold: 0.0,
            ambiguity: 0.0,
        },
        bars: NO_BARS,
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
    if is_filter(effect) {
        for variant in Variant::of(effect, &observation.span).filter(wanted) {
            if let ControlFlow::Continue(found) = solver.best_filter(variant, &plain)
                && let ControlFlow::Continue(found) = solver.refine(found, 10)
            {
                keep(&found);
            }
        }
    } else {
        let _ = solver.grow(&plain, &[effect], &mut |found| {
            keep(found);
            Real::INFINITY
        });
    }
    best?.terms().next().copied()
}

/// Sets the columns of the terms that every hypothesis has. Returns the term of the white noise, which is what the filters
/// of the list replace.
#[inline(never)]
pub(super) fn set_common<const B: usize>(
    work: &mut Workspace<B>,
    observation: &Observation<'_, B>,
    model: &Model,
    effects: &[&'static dyn Effect],
) -> Option<Term> {
    let has_filters = effects.iter().any(|effect| is_filter(*effect));
    let is_replaceable = |term: &&Term| has_filters && is_white(term.effect) && !term.fitted;
    let white = model.terms().iter().find(is_replaceable).copied();
    let common = model.terms().iter().filter(|term| !is_replaceable(term));
    work.set_common(observation, common);
    work.shape = observation.shape;
    work.pass(observation, None);
    white
}

/// The lead in cost that a hypothesis needs over its special case. A filter at the sample rate is as likely as one before
/// sampling, which it becomes where it is slow, and has no more shapes: it has to explain the record better at all.
fn lead_over(general: &Hypothesis, special: &Hypothesis) -> Real {
    let passes_all = general.terms().any(|term| term.effect.passes_all());
    if general.parameters() > special.parameters() || passes_all {
        OVER_SPECIAL_CASE
    } else {
        AS_GOOD
    }
}

/// The hypothesis whose names have the largest weight, the sum of `exp(−Δ/2)` over those that share them: six low passes
/// near one boxcar are a low pass. Alternatives are those of other kinds that cost little more.
fn chosen(
    finals: &[Hypothesis],
    cheapest: &[&Hypothesis],
    plain: &Hypothesis,
    ambiguity: Real,
) -> Found {
    let low = finals.iter().map(cost).fold(Real::INFINITY, Real::min);
    let weight = |hypothesis: &Hypothesis| -> Real {
        let same = finals
            .iter()
            .filter(|other| other.is_named_like(hypothesis));
        same.map(|other| math::exp(0.5 * (low - other.cost))).sum()
    };
    let heaviest = finals.iter().map(&weight).fold(0.0, Real::max);
    let leading = finals.iter().filter(|one| weight(one) >= heaviest);
    let best = leading
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .unwrap_or(plain);
    // An effect that leads little over its own special case, which it can imitate, is that one.
    let special = finals.iter().filter(|other| {
        best.is_general_form_of(other) && other.cost < best.cost + lead_over(best, other)
    });
    let best = special
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .unwrap_or(best);
    let mut alternatives: Vec<(Hypothesis, Real), MAX_ALTERNATIVES> = Vec::new();
    for other in finals.iter().chain(cheapest.iter().copied()) {
        let beyond = other.cost - best.cost;
        let is_told = |known: &(Hypothesis, Real)| known.0.is_like(other);
        // Effects of one spectrum are told, whatever their prices.
        let is_as_good = other.score < best.score + AS_GOOD
            && list::count(other.terms()) == list::count(best.terms());
        if !(beyond < ambiguity || is_as_good)
            || other.is_like(best)
            || other.is_general_form_of(best)
        {
            continue;
        }
        if let Some(place) = alternatives.iter().position(is_told) {
            if alternatives
                .get(place)
                .is_some_and(|known| known.1 <= beyond)
            {
                continue;
            }
            list::remove(&mut alternatives, place);
        }
        list::rank(&mut alternatives, (other.clone(), beyond), |known| {
            known.1 > beyond
        });
    }
    Found {
        best: best.clone(),
        alternatives,
        white: None,
    }
}
