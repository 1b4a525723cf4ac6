//! The way from the first model to the one that was found: one effect a step, the largest fall of the error first.

use super::{
    extended::with,
    falling::fall,
    mirror::{Mirrored, tell_from_mirror},
    polish::polished,
    search::{
        Found, Hypothesis, MAX_ALTERNATIVES, Observation, WhiteRange, is_filter, is_white, ordered,
    },
    step::{Addition, Candidate, MAX_AMBIGUOUS, MAX_CANDIDATES, Step, cost},
};
use crate::{
    error::Error,
    evidence::{kurtosis::Kurtosis, observed::Observed},
    fit::Tolerance,
    list,
    numerics::real::Real,
    pause::{Pause, Stop},
    theory::{
        effect::Effect,
        model::{Model, Term},
    },
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The largest number of steps: a filter, and what adds to it.
const MAX_STEPS: usize = 4;

/// One step of a story.
#[derive(Debug)]
struct StoryStep {
    /// What is added, and what could be added instead, best first.
    candidates: Vec<Candidate, MAX_CANDIDATES>,
    ambiguous: Vec<&'static str, MAX_AMBIGUOUS>,
}

/// What was found, in the order in which it is told.
#[derive(Debug)]
pub(super) struct Story {
    steps: Vec<StoryStep, MAX_STEPS>,
    /// The number of steps that have been told.
    told: usize,
    /// What the white noise is in other stories that explain the record as well.
    white: Option<WhiteRange>,
    /// χ² of the fit with everything that was found.
    chi_squared: Real,
}

impl Story {
    /// Nothing is missing, or nothing that is missing was found.
    pub(super) const NOTHING: Self = Self {
        steps: Vec::new(),
        told: 0,
        white: None,
        chi_squared: 0.0,
    };

    pub(super) fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Tells what a search has found: refines the shapes with the covariance of a fit, lets the kurtosis decide between
    /// effects of one spectrum, and sorts the effects by what they explain. `without` is the error of the model without them.
    // What a story is made of has no smaller unit.
    #[allow(clippy::too_many_arguments)]
    #[inline(never)]
    pub(super) fn new<const K: usize, const B: usize>(
        observation: &Observation<'_, B>,
        observed: Observed<'_, K, B>,
        model: &Model,
        kurtosis: Option<&Kurtosis<K>>,
        effects: &[&'static dyn Effect],
        found: Found,
        (without, tolerance): (Real, Real),
        pause: &mut Pause<'_>,
    ) -> Result<Self, Stop> {
        let mut best = found.best;
        let terms: Vec<Term, MAX_STEPS> = list::fill(best.terms().copied());
        if terms.is_empty() {
            return Ok(Self::NOTHING);
        }
        let whole = with(model, &terms)?;
        let fitted = polished(observed, whole, Tolerance::IfNeeded(tolerance), pause)?;
        // The effects that were added are the last ones of the model, in the order of the hypothesis.
        let first = fitted.model.terms().len().saturating_sub(terms.len());
        let polished = fitted.model.terms().iter().skip(first);
        for (term, polished) in best.filter.iter_mut().chain(&mut best.added).zip(polished) {
            *term = *polished;
        }
        let ControlFlow::Continue(mut ordered) = ordered(observation, model, effects, &best, pause)
        else {
            return Err(Stop::Paused);
        };
        fall(observed, model, &mut ordered, (without, tolerance), pause)?;
        let mut steps: Vec<StoryStep, MAX_STEPS> = Vec::new();
        for &(term, fall) in &ordered {
            let mut candidates: Vec<Candidate, MAX_CANDIDATES> = Vec::new();
            let mut ambiguous: Vec<&'static str, MAX_AMBIGUOUS> = Vec::new();
            let improvement = fall - 2.0 * cost(term.effect);
            let mut own = Candidate::of(term);
            own.improvement = improvement;
            let _ = candidates.push(own);
            for (other, beyond) in &found.alternatives {
                let Some(instead) = instead(&best, other, &term) else {
                    continue;
                };
                let name = instead.effect.name();
                if name != term.effect.name() && !ambiguous.contains(&name) {
                    let _ = ambiguous.push(name);
                    let mut candidate = Candidate::of(instead);
                    candidate.improvement = improvement - beyond;
                    let _ = candidates.push(candidate);
                }
            }
            let _ = steps.push(StoryStep {
                candidates,
                ambiguous,
            });
        }
        let place = |term: &Term| {
            let mut terms = fitted.model.terms().iter();
            terms.position(|other| {
                other.effect.name() == term.effect.name() && other.parameters == term.parameters
            })
        };
        for told in &mut steps {
            let Some(first) = told.candidates.first_mut() else {
                continue;
            };
            let Some(place) = place(&first.term) else {
                continue;
            };
            match tell_from_mirror(observed, kurtosis, effects, &fitted, place) {
                Mirrored::Same => {}
                Mirrored::Other(effect) => first.term.effect = effect,
                Mirrored::Unknown(effect) => {
                    let _ = told.ambiguous.push(effect.name());
                }
            }
            mirrors(&mut told.ambiguous, effects);
        }
        Ok(Self {
            steps,
            told: 0,
            white: found.white,
            chi_squared: fitted.chi_squared,
        })
    }

    /// χ² of the fit with everything that was found; 0 if nothing was.
    pub(super) fn chi_squared(&self) -> Real {
        self.chi_squared
    }

    /// Whether the model of the present step has everything that was found.
    pub(super) fn is_told_to_the_end(&self) -> bool {
        self.told >= self.steps.len()
    }

    /// The model of the present step.
    pub(super) fn model(&self, model: &Model) -> Result<Model, Error> {
        self.first(self.told, model)
    }

    /// The model of the last step.
    pub(super) fn whole(&self, model: &Model) -> Result<Model, Error> {
        self.first(self.steps.len(), model)
    }

    /// The model with what these many steps add.
    fn first(&self, steps: usize, model: &Model) -> Result<Model, Error> {
        let told = self.steps.iter().take(steps);
        let terms: Vec<Term, MAX_STEPS> =
            list::fill(told.filter_map(|told| Some(told.candidates.first()?.term)));
        with(model, &terms)
    }

    /// Lets the interval of the white noise hold what it is in the stories that explain the record as well.
    fn widen<const K: usize, const B: usize>(&self, step: &mut Step<K, B>) {
        let Some(range) = self.white else { return };
        let terms = step.model.terms();
        let filter = terms.iter().position(|term| is_filter(term.effect));
        let white = || terms.iter().position(|term| is_white(term.effect));
        let found = filter.or_else(white);
        if let Some(found) = found.and_then(|at| step.fit.coefficients.get_mut(at)) {
            found.widen(range.lower, range.upper);
        }
    }

    /// Writes what the present step adds. Returns whether it adds anything.
    pub(super) fn tell<const K: usize, const B: usize>(&self, step: &mut Step<K, B>) -> bool {
        let Some(told) = self.steps.get(self.told) else {
            if !self.is_empty() {
                self.widen(step);
            }
            return false;
        };
        step.candidates = told.candidates.clone();
        step.ambiguous = told.ambiguous.clone();
        step.added = told
            .candidates
            .first()
            .map(|first| Addition::Effect(first.term));
        true
    }

    /// Goes on to the next step.
    pub(super) fn go_on(&mut self) {
        self.told = self.told.saturating_add(1);
    }
}

/// The term that another hypothesis has in the place of one of the best hypothesis; `None` if it has the same one, or none.
fn instead(best: &Hypothesis, other: &Hypothesis, term: &Term) -> Option<Term> {
    let count = |one: &Hypothesis, name: &str| {
        list::count(one.terms().filter(|term| term.effect.name() == name))
    };
    let name = term.effect.name();
    if count(other, name) >= count(best, name) {
        return None;
    }
    // A filter stands for a filter if both have one.
    let replaces_white = is_filter(term.effect);
    if replaces_white && let Some(filter) = other.filter {
        return Some(filter);
    }
    let mut more = other.terms().filter(|other_term| {
        let name = other_term.effect.name();
        let is_other_filter = is_filter(other_term.effect);
        count(other, name) > count(best, name)
            && (replaces_white || !is_other_filter || best.filter.is_none())
    });
    more.next().copied()
}

/// Puts the name of its mirror behind each name, because nothing distinguishes the two.
fn mirrors(names: &mut Vec<&'static str, MAX_AMBIGUOUS>, effects: &[&'static dyn Effect]) {
    let mut at = 0_usize;
    while let Some(name) = names.get(at).copied() {
        at = at.saturating_add(1);
        let mut all = effects.iter();
        let mirror = all.find(|effect| effect.mirror().is_some_and(|other| other.name() == name));
        if let Some(mirror) = mirror.filter(|mirror| !names.contains(&mirror.name())) {
            list::insert(names, at, mirror.name());
            at = at.saturating_add(1);
        }
    }
}

const _: () = assert!(MAX_ALTERNATIVES + 1 >= MAX_CANDIDATES);
