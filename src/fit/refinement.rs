//! What is better known of the coefficients of an adequate model of power laws than a solution says.
//!
//! A fit to octaves and bins takes both for independent, and each level's bins for independent of those of the
//! others. They overlap a little, so that the joint errors of `N` and `B` come out 6 % and 16 % too small. The
//! octaves' covariance is exact, and they keep all that power laws say: their coefficients scatter 6 % to 12 % less
//! than the joint ones. So the coefficients come from the octaves alone, and the joint fit decides whether the model is
//! adequate. In the end, those that are hardly above zero are tested against zero.

use super::{
    estimate::Estimator,
    problem::Problem,
    result::Fit,
    significance::Significance,
    solver::{Start, Tolerance},
    work::Work,
};
use crate::{
    error::Error,
    evidence::observed::Observed,
    theory::model::{Model, Term},
};

/// The refinement of a complete fit, in progress. It needs the memory of that fit.
// The large variant shares its memory with those of the fit's other stages.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Refinement {
    Solving,
    Estimating(Estimator),
    Testing(Significance),
}

impl Refinement {
    /// A refinement that has not begun.
    // Small, so that it is set where it stays and not moved there.
    pub(crate) const NEW: Self = Self::Solving;

    /// Whether a fit can be refined: its model is adequate, and no effect has a shape, which only bins may show.
    pub(crate) fn applies(model: &Model, fit: &Fit) -> bool {
        let has_shape = |term: &Term| !term.effect.parameters().is_empty();
        fit.is_adequate() == Some(true) && !model.terms().iter().any(has_shape)
    }

    /// Begins in the memory of the fit, which is complete.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn begin<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        fit: &Fit,
        work: &mut Work<K, B>,
    ) -> Result<(), Error> {
        if observed.spectrum().is_none() {
            *self = Self::Testing(Significance::NEW);
            return Ok(());
        }
        let start = Start::From(work.solver.squares);
        work.begin_at(
            observed.octaves(),
            model,
            start,
            Tolerance::Fixed(fit.tolerance),
        )?;
        *self = Self::Solving;
        Ok(())
    }

    /// Does one piece of work, and returns whether the fit has the coefficients.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
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
            }
            Self::Estimating(estimator) => {
                if estimator.advance(&problem, &work.solver, fit) {
                    *self = Self::Testing(Significance::NEW);
                }
            }
            Self::Testing(significance) => {
                return Ok(significance.advance(&problem, &mut work.solver, fit));
            }
        }
        Ok(false)
    }
}
