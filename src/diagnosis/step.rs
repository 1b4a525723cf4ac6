//! What a diagnosis reports about every model on its way.

use crate::{
    comparison::Comparison,
    covariate::Slope,
    effect::Effect,
    fit::Fit,
    limits::MAX_EFFECTS,
    model::{Model, Term},
    real::Real,
};
use heapless::Vec;

/// The number of candidates that a step fits in full and reports. Chosen by hand.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
pub const MAX_CANDIDATES: usize = 4;

/// The number of names that a step can call ambiguous: two for every other candidate, and the mirrors
/// of two.
pub const MAX_AMBIGUOUS: usize = 2 * MAX_CANDIDATES;

/// The candidates of a step, best first.
pub(super) type Candidates = Vec<Candidate, MAX_CANDIDATES>;

/// An effect that a step tried and that improves the model.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The effect with its best shape.
    pub term: Term,
    /// What else changes in the model when the effect is added.
    pub swap: Option<Swap>,
    /// The effect's coefficient, in the unit that a [`Coefficient`](crate::Coefficient) of it has.
    pub coefficient: Real,
    /// χ² of the model with the effect.
    pub chi_squared: Real,
    /// How far the effect lowers `−2 ln L`, less two for each parameter that it brings.
    pub improvement: Real,
}

impl Candidate {
    /// A candidate that has not been fitted yet.
    pub(super) const fn of(term: Term, swap: Option<Swap>) -> Self {
        Self {
            term,
            swap,
            coefficient: 0.0,
            chi_squared: Real::NAN,
            improvement: 0.0,
        }
    }

    /// Whether the other candidate becomes this one at the end of its effect's range.
    pub(super) fn is_special_case_of(&self, other: &Self) -> bool {
        let special = other.term.effect.description().special_case;
        let swaps = |one: &Self| {
            one.swap
                .map(|swap| (swap.dropped.name(), swap.taken.name()))
        };
        special.is_some_and(|special| special.name() == self.term.effect.name())
            && swaps(self) == swaps(other)
    }

    /// The number of parameters that the candidate brings: coefficients and fitted shapes, less the coefficient of
    /// the effect whose place it takes.
    pub(super) fn cost(&self) -> Real {
        let swap = self
            .swap
            .map_or(0.0, |swap| cost(swap.taken) - cost(swap.dropped));
        cost(self.term.effect) + swap
    }

    /// Whether both candidates swap, and bring the same pair of effects.
    pub(super) fn brings_the_same(&self, other: &Self) -> bool {
        let pair = |one: &Self| {
            one.swap
                .map(|swap| (one.term.effect.name(), swap.taken.name()))
        };
        let (Some(one), Some((first, second))) = (pair(self), pair(other)) else {
            return false;
        };
        one == (first, second) || one == (second, first)
    }

    /// The effects by which the candidate's model differs from the models of other candidates, where
    /// the best candidate drops the effect `dropped`.
    pub(super) fn brings(&self, dropped: Option<&'static str>) -> [Option<&'static str>; 2] {
        let beside = self.swap.map(|swap| swap.taken.name());
        [Some(self.term.effect.name()), beside.or(dropped)]
    }
}

/// An effect that was added before and is exchanged for another one when a further effect is added.
/// Alone, it had stood for both of them.
#[derive(Clone, Copy)]
pub struct Swap {
    /// The effect that is removed.
    pub dropped: &'static dyn Effect,
    /// The effect that takes its place.
    pub taken: &'static dyn Effect,
}

impl core::fmt::Debug for Swap {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} → {}", self.dropped.name(), self.taken.name())
    }
}

/// A covariate that the rate follows, or two that it follows together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FollowedCovariate {
    /// The covariate's place among [`Evidence::covariates`](super::Evidence::covariates).
    pub index: usize,
    /// The slope with which the rate follows the covariate.
    pub slope: Slope,
    /// The covariate that acts beside it; `None` if it acts alone.
    pub beside: Option<Beside>,
}

/// A covariate that acts beside another one, such as the rate of change of a temperature that the rate follows with a
/// lag.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Beside {
    /// The covariate's place among [`Evidence::covariates`](super::Evidence::covariates).
    pub index: usize,
    /// The slope with which the rate follows it.
    pub slope: Slope,
    /// The correlation of the errors of the two slopes.
    pub correlation: Real,
    /// The pair's place among [`Evidence::pairs`](super::Evidence::pairs).
    pub pair: usize,
}

/// The number of parameters that an effect adds to a model when its shape is fitted. The coefficient of the effect
/// whose place it takes goes.
pub(crate) fn cost(effect: &'static dyn Effect) -> Real {
    let shapes = Term::fitted(effect).fitted_parameters();
    let coefficient = if effect.replaces().is_some() {
        0.0
    } else {
        1.0
    };
    shapes.fold(coefficient, |cost, _| cost + 1.0)
}

/// What a step adds to the model.
#[derive(Clone, Copy, Debug)]
pub enum Addition {
    /// An effect of the list, which is that of the first candidate.
    Effect(Term),
    /// A covariate. What follows it is subtracted from the curve.
    Covariate(FollowedCovariate),
}

/// One step of a diagnosis: a model, and what is added to it.
#[derive(Clone, Debug)]
pub struct Step<const K: usize, const B: usize = 0> {
    /// The model so far.
    pub model: Model,
    /// The effects of the step before that this model does not need any more.
    pub dropped: Vec<&'static str, MAX_EFFECTS>,
    /// The covariate whose share has been subtracted from the curve; `None` if there is none.
    pub covariate: Option<FollowedCovariate>,
    /// The model's fit.
    pub fit: Fit,
    /// Where the model fails.
    pub comparison: Comparison<K, B>,
    /// What was tried next, best first. Empty if the model is adequate.
    pub candidates: Candidates,
    /// What was added to the model; `None` if nothing was.
    pub added: Option<Addition>,
    /// Effects that explain the curve about as well as those of the candidate that was added.
    pub ambiguous: Vec<&'static str, MAX_AMBIGUOUS>,
}

impl<const K: usize, const B: usize> Step<K, B> {
    /// A step of which only the model is known.
    #[inline(always)]
    pub(super) fn of(model: &Model) -> Self {
        Self {
            model: model.clone(),
            dropped: Vec::new(),
            covariate: None,
            fit: Fit::EMPTY,
            comparison: Comparison::EMPTY,
            candidates: Vec::new(),
            added: None,
            ambiguous: Vec::new(),
        }
    }

    /// Clears what was reported on the way from the model before.
    pub(super) fn begin_report(&mut self) {
        self.candidates.clear();
        self.added = None;
        self.ambiguous.clear();
    }

    /// What else changes with the effect that is added; `None` if nothing does.
    pub fn swap(&self) -> Option<Swap> {
        match self.added {
            Some(Addition::Effect(_)) => self.candidates.first()?.swap,
            _ => None,
        }
    }
}
