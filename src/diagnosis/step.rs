//! What a diagnosis reports of every model on its way.

use crate::{
    comparison::Comparison,
    covariate::Slope,
    effect::Effect,
    fit::Fit,
    model::{Model, Term},
    real::Real,
};
use heapless::Vec;

/// Candidates that a step fits in full and reports.
pub const MAX_CANDIDATES: usize = 4;

/// Names that a step calls ambiguous: two of every other candidate, and mirrors of two.
pub const MAX_AMBIGUOUS: usize = 2 * MAX_CANDIDATES;

/// The candidates of a step, best first.
pub(super) type Candidates = Vec<Candidate, MAX_CANDIDATES>;

/// An effect that a step tried, and that improves the model.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The effect with its best shape.
    pub term: Term,
    /// What else changes where it is added.
    pub swap: Option<Swap>,
    /// Its coefficient, in the unit that a [`Coefficient`](crate::Coefficient) of it has.
    pub coefficient: Real,
    /// χ² of the model with it.
    pub chi_squared: Real,
    /// How far it lowers `−2 ln L`, less two for each parameter that it brings.
    pub improvement: Real,
}

impl Candidate {
    /// Parameters that it brings: a coefficient and shapes.
    pub(super) fn cost(&self) -> Real {
        let swap = self
            .swap
            .map_or(0.0, |swap| cost(swap.taken) - cost(swap.dropped));
        cost(self.term.effect) + swap
    }

    /// Whether both swap, and bring the same pair.
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

    /// The effects by which its model differs from those of other candidates, if `dropped` gives way to
    /// some of them.
    pub(super) fn brings(&self, dropped: Option<&'static str>) -> [Option<&'static str>; 2] {
        let beside = self.swap.map(|swap| swap.taken.name());
        [Some(self.term.effect.name()), beside.or(dropped)]
    }
}

/// An effect that was added before and gives way to another when a further one is added: alone, it
/// had taken the part of both.
#[derive(Clone, Copy)]
pub struct Swap {
    /// The one that gives way.
    pub dropped: &'static dyn Effect,
    /// The one in its place.
    pub taken: &'static dyn Effect,
}

impl core::fmt::Debug for Swap {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} → {}", self.dropped.name(), self.taken.name())
    }
}

/// A covariate that the rate follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FollowedCovariate {
    /// Its place among [`Evidence::covariates`](super::Evidence::covariates).
    pub index: usize,
    /// How the rate follows it.
    pub slope: Slope,
}

/// Parameters of an effect whose shape is fitted.
pub(super) fn cost(effect: &'static dyn Effect) -> Real {
    let shapes = Term::fitted(effect).fitted_parameters();
    1.0 + shapes.map(|_| 1.0).sum::<Real>()
}

/// What a step adds to the model.
#[derive(Clone, Copy, Debug)]
pub enum Addition {
    /// An effect of the list: the first candidate.
    Effect(Term),
    /// A covariate: what follows it is taken off the curve.
    Covariate(FollowedCovariate),
}

/// A model on the way of a diagnosis.
#[derive(Clone, Debug)]
pub struct Step<const K: usize> {
    /// The model so far.
    pub model: Model,
    /// The covariate whose share has been subtracted from the curve.
    pub covariate: Option<FollowedCovariate>,
    /// The model's fit.
    pub fit: Fit,
    /// Where it fails.
    pub comparison: Comparison<K>,
    /// What was tried next, best first; none where the model is adequate.
    pub candidates: Candidates,
    /// What was added.
    pub added: Option<Addition>,
    /// Candidates that explain the curve about as well as the one that was added.
    pub ambiguous: Vec<&'static str, MAX_AMBIGUOUS>,
}

impl<const K: usize> Step<K> {
    /// A step of which only the model is known.
    #[inline(always)]
    pub(super) fn of(model: &Model) -> Self {
        Self {
            model: model.clone(),
            covariate: None,
            fit: Fit::empty(),
            comparison: Comparison::empty(),
            candidates: Vec::new(),
            added: None,
            ambiguous: Vec::new(),
        }
    }

    /// Clears what is known of the way from the model before.
    pub(super) fn begin_report(&mut self) {
        self.candidates.clear();
        self.added = None;
        self.ambiguous.clear();
    }

    /// What else changes with the effect that is added.
    pub fn swap(&self) -> Option<Swap> {
        match self.added {
            Some(Addition::Effect(_)) => self.candidates.first()?.swap,
            _ => None,
        }
    }
}
