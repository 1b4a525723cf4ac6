//! The whole search.

use super::{
    beam::{Beams, Growth, MOST, OVER_SPECIAL_CASE},
    hypothesis::{AS_GOOD, Added, Hypothesis},
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

/// The hypotheses that are pruned at the end.
const PRUNED: usize = 5;

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
    beams: Beams,
    shapes: Vec<Term, MAX_VARIANTS>,
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
        let noises = slow_noises(effects);
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
        let mut growth = Growth::NEW;
        solver.start(&mut filters(), &noises, effects, &mut |whole, continuum| {
            growth.begin(beams, whole, continuum)
        })?;
        let Some(plain) = growth.plain.take() else {
            return ControlFlow::Break(());
        };
        for count in 0..=MOST {
            if !growth.go_on(&plain, &mut solver, beams, effects, count)? {
                break;
            }
        }

        let cheapest = cheapest(beams);
        let finals = pruned(&mut solver, &cheapest)?;
        let mut found = chosen(&finals, &cheapest, &plain, limits.ambiguity);
        found.white = solver.range_of_white(&found.best, &found.alternatives)?;
        ControlFlow::Continue(found)
    }
}

/// The effects that are added as noise and have nothing but a time.
fn slow_noises(effects: &[&'static dyn Effect]) -> Vec<&'static dyn Effect, 4> {
    let is_slow = |effect: &dyn Effect| {
        let first = effect.parameters().first();
        first.is_some_and(|first| first.unit == "s") && effect.parameters().len() == 1
    };
    let noises = effects.iter().copied();
    list::fill(noises.filter(|effect| is_added(*effect) && is_slow(*effect)))
}

/// The cheapest of all hypotheses.
fn cheapest(beams: &Beams) -> Vec<&Hypothesis, PRUNED> {
    let mut cheapest = Vec::new();
    for hypothesis in beams.iter().flat_map(Pool::as_slice) {
        list::rank(&mut cheapest, hypothesis, |other: &&Hypothesis| {
            other.cost > hypothesis.cost
        });
    }
    cheapest
}

/// Hypotheses without what they do not need, of each kind the cheapest one.
fn pruned<const B: usize>(
    solver: &mut Solver<'_, '_, '_, B>,
    cheapest: &[&Hypothesis],
) -> ControlFlow<(), Vec<Hypothesis, PRUNED>> {
    let mut finals: Vec<Hypothesis, PRUNED> = Vec::new();
    solver.bars = NO_BARS;
    for hypothesis in cheapest {
        let pruned = solver.prune((*hypothesis).clone())?;
        match finals.iter_mut().find(|other| other.is_like(&pruned)) {
            Some(other) if pruned.cost < other.cost => *other = pruned,
            Some(_) => {}
            None => {
                let _ = finals.push(pruned);
            }
        }
    }
    ControlFlow::Continue(finals)
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
