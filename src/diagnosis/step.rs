//! What a diagnosis reports about every model on its way.

use crate::{
    comparison::Comparison,
    evidence::covariate::Slope,
    fit::Fit,
    numerics::real::Real,
    theory::{
        effect::Effect,
        model::{Model, Term},
    },
};
use heapless::Vec;

/// The number of candidates that a step reports.
pub const MAX_CANDIDATES: usize = 4;

/// The number of names that a step can call ambiguous: those of the other candidates, and of effects with the same Allan
/// variances.
pub const MAX_AMBIGUOUS: usize = 2 * MAX_CANDIDATES;

/// The candidates of a step, best first.
pub(super) type Candidates = Vec<Candidate, MAX_CANDIDATES>;

/// An effect that a step tried and that improves the model.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The effect with its best shape.
    pub term: Term,
    /// The effect's coefficient, in the unit that a [`Coefficient`](crate::Coefficient) of it has.
    pub coefficient: Real,
    /// χ² of the model with the effect; NaN before the next step, which has it.
    pub chi_squared: Real,
    /// How far the effect lowers `−2 ln L`, less two for each parameter that it brings.
    pub improvement: Real,
}

impl Candidate {
    /// A candidate that has not been fitted yet.
    pub(super) const fn of(term: Term) -> Self {
        Self {
            term,
            coefficient: 0.0,
            chi_squared: Real::NAN,
            improvement: 0.0,
        }
    }
}

/// A covariate that the rate follows, or two that it follows together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FollowedCovariate {
    /// The covariate's place among [`Record::covariates`](crate::Record::covariates).
    pub index: usize,
    /// The slope with which the rate follows the covariate.
    pub slope: Slope,
    /// A second covariate that acts as well; `None` if there is none.
    pub beside: Option<SecondCovariate>,
}

/// A covariate that acts in addition to another one, such as the rate of change of a temperature that the rate follows with a
/// lag.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SecondCovariate {
    /// The covariate's place among [`Record::covariates`](crate::Record::covariates).
    pub index: usize,
    /// The slope with which the rate follows it.
    pub slope: Slope,
    /// The correlation of the errors of the two slopes.
    pub correlation: Real,
    /// The pair's place among [`Record::pairs`](crate::Record::pairs).
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
    /// The covariate whose share has been subtracted from the curve; `None` if there is none.
    pub covariate: Option<FollowedCovariate>,
    /// The model's fit.
    pub fit: Fit,
    /// Where the model fails.
    pub comparison: Comparison<K, B>,
    /// What is added next, and what could be added in its place, best first. Empty if nothing is missing.
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
}
