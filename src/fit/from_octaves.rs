//! The coefficients of a model of power laws, from the octaves alone.
//!
//! A fit to octaves and bins takes both for independent, and each level's bins for independent of those of the
//! others. They overlap a little, so that the joint errors of `N` and `B` come out 6 % and 16 % too small. The
//! octaves' covariance is exact, and they keep all that power laws say: their coefficients scatter 6 % to 12 % less
//! than the joint ones. The joint fit still tells whether the model is adequate.

use super::{
    estimate::Estimator,
    problem::Problem,
    result::Fit,
    solver::{Start, Tolerance},
    work::Work,
};
use crate::{
    error::Error,
    model::{Model, Term},
    observed::Observed,
};

/// The estimate of the coefficients from the octaves, in progress. It needs the memory of the joint fit.
// The large variant shares its memory with those of the fit's other stages.
#[allow(clippy::large_enum_variant)]
pub(crate) enum FromOctaves {
    Solving,
    Estimating(Estimator),
}

impl FromOctaves {
    /// Whether the octaves tell the coefficients of a model that was fitted to octaves and bins: it is adequate, and
    /// no effect has a shape, which only bins may show.
    pub(crate) fn suffice<const K: usize, const B: usize>(
        observed: Observed<'_, K, B>,
        model: &Model,
        fit: &Fit,
    ) -> bool {
        let has_shape = |term: &Term| !term.effect.parameters().is_empty();
        observed.spectrum().is_some()
            && fit.is_adequate() == Some(true)
            && !model.terms().iter().any(has_shape)
    }

    /// Begins in the memory of the joint fit, which is complete.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn begin<const K: usize, const B: usize>(
        observed: Observed<'_, K, B>,
        model: &Model,
        fit: &Fit,
        work: &mut Work<K, B>,
    ) -> Result<Self, Error> {
        let start = Start::From(work.solver.squares);
        work.begin_at(
            observed.octaves(),
            model,
            start,
            Tolerance::Fixed(fit.tolerance),
        )?;
        Ok(Self::Solving)
    }

    /// Does one piece of work, and returns whether the fit has the coefficients.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        work: &mut Work<K, B>,
        fit: &mut Fit,
    ) -> Result<bool, Error> {
        let problem = Problem::new(observed.octaves(), model, &work.columns);
        match self {
            Self::Solving => {
                if work.solver.advance(&problem)? {
                    fit.coefficients.clear();
                    *self = Self::Estimating(Estimator::NEW);
                }
                Ok(false)
            }
            Self::Estimating(estimator) => Ok(estimator.advance(&problem, &work.solver, fit)),
        }
    }
}
