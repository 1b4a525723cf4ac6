//! A fit, in one go or in pieces.

use super::{
    estimate::Estimator,
    independent,
    method::{Method, Options},
    problem::{Problem, check},
    refinement::Refinement,
    result::Fit,
    solver::{Solver, Start, Tolerance},
    work::Work,
};
use crate::{
    curve::Curve,
    error::Error,
    evidence::{observed::Observed, record::Record},
    record::integrity::Reason,
    spectrum::Spectrum,
    theory::model::Model,
};

/// Fits a model's coefficients to a curve.
///
/// # Errors
/// [`Error::Invalid`] if the record is not one of a gyro at rest; its curve alone can be fitted all the same.
/// [`Error::NoNoise`] if an octave has a variance of zero. [`Error::TooFewOctaves`] for fewer than two
/// octaves, or for fewer than there are effects with the unconstrained methods, which count only the
/// octaves that they use. [`Error::Singular`] if the normal equations have no solution.
///
/// # Example
///
/// ```
/// use allanite::{Curve, Model, Real, fit::{Options, fit}};
///
/// // White noise of 1 count² at 100 Hz: σ²(τ) = N²/τ with N = 0.1.
/// let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / (1 << k) as Real));
/// let curve = Curve::<10>::new(100.0, white)?;
/// let fit = fit(&curve, &Model::ieee_952(), Options::default())?;
/// assert!((fit.coefficients[1].value - 0.1).abs() < 1e-6);
/// # Ok::<(), allanite::Error>(())
/// ```
pub fn fit<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
    model: &Model,
    options: Options,
) -> Result<Fit, Error> {
    let record = record.into();
    record.check()?;
    let observed = record.observed();
    let mut fit = Fit::EMPTY;
    let mut work = Work::NEW;
    let mut stage = Stage::Solving;
    stage.begin(observed, model, options, &mut work, &mut fit)?;
    while !stage.advance(observed, model, &mut work, &mut fit)? {}
    Ok(fit)
}

/// A fit in progress, for a main loop that has other work to do. One call of [`advance`](Self::advance)
/// takes at most 2 million instructions on a Cortex-M4F in single precision; `cargo xtask bench`
/// measures the longest. The calls together take as long as [`fit()`]. To abort a fit, drop it.
///
/// # Example
///
/// ```
/// use allanite::{Curve, Model, Real, fit::{Fitting, Options}};
///
/// let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / (1 << k) as Real));
/// let curve = Curve::<10>::new(100.0, white)?;
/// let mut fitting = Fitting::new(&curve, Model::ieee_952(), Options::default());
/// let fit = loop {
///     if let Some(fit) = fitting.advance()? {
///         break fit;
///     }
///     // Feed the watchdog, take the next samples.
/// };
/// assert!((fit.coefficients[1].value - 0.1).abs() < 1e-6);
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Fitting<const K: usize, const B: usize = 0> {
    curve: Curve<K>,
    spectrum: Spectrum<B>,
    model: Model,
    work: Work<K, B>,
    fit: Fit,
    options: Options,
    invalid: Option<Reason>,
    has_begun: bool,
    stage: Stage,
}

impl<const K: usize, const B: usize> Fitting<K, B> {
    /// A fit of a model to the curve and the spectrum of a record, of which it keeps a copy. It does not begin before it is
    /// advanced.
    // Inlined, so that some kilobytes are built where they stay and not moved there.
    #[inline(always)]
    pub fn new<'a>(record: impl Into<Record<'a, K, B>>, model: Model, options: Options) -> Self {
        let record = record.into();
        let spectrum = record.spectrum.cloned().unwrap_or(Spectrum::EMPTY);
        let mut fitting = Self::of(record.curve.clone(), spectrum, model, options);
        fitting.invalid = record.invalid;
        fitting
    }

    /// A fit of a model to a curve and to the spectrum of the same record.
    #[inline(always)]
    pub(crate) fn of(
        curve: Curve<K>,
        spectrum: Spectrum<B>,
        model: Model,
        options: Options,
    ) -> Self {
        Self {
            curve,
            spectrum,
            model,
            work: Work::NEW,
            fit: Fit::EMPTY,
            options,
            invalid: None,
            has_begun: false,
            stage: Stage::Solving,
        }
    }

    /// Does one piece of work. Returns the fit once it is complete, and `None` before.
    ///
    /// # Errors
    /// The same as those of [`fit()`].
    pub fn advance(&mut self) -> Result<Option<&Fit>, Error> {
        let Self {
            curve,
            spectrum,
            model,
            work,
            fit,
            options,
            invalid,
            has_begun,
            stage,
        } = self;
        let observed = Observed::new(curve, spectrum);
        if !*has_begun {
            invalid.map_or(Ok(()), |reason| Err(Error::Invalid(reason)))?;
            stage.begin(observed, model, *options, work, fit)?;
            *has_begun = true;
            return Ok(stage.is_complete().then_some(&self.fit));
        }
        let complete = stage.advance(observed, model, work, fit)?;
        Ok(complete.then_some(&self.fit))
    }

    /// The problem, the memory of its solution, and the fit as far as it is complete. Once it is complete,
    /// the memory is free for another solution of the same problem.
    #[cfg(test)]
    pub(crate) fn parts(&mut self) -> (Problem<'_, K, B>, &mut Solver<K, B>, &Fit) {
        let observed = Observed::new(&self.curve, &self.spectrum);
        let problem = Problem::new(observed, &self.model, &self.work.columns);
        (problem, &mut self.work.solver, &self.fit)
    }

    /// The curve that is fitted.
    pub const fn curve(&self) -> &Curve<K> {
        &self.curve
    }

    /// The model that is fitted.
    pub const fn model(&self) -> &Model {
        &self.model
    }
}

/// How far a fit by the covariance has come. It solves a model, estimates its coefficients from the solution, and refines
/// them. Both a [`Fitting`] and a diagnosis go this way.
// The smaller variant wastes a few hundred bytes of a fit, which takes some thousands.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Stage {
    /// The memory has begun to solve the model.
    Solving,
    Solved,
    /// At the end, the coefficients are those of the solution, which is still in the memory.
    Estimating {
        estimator: Estimator,
        is_complete: bool,
    },
    Refining(Refinement),
    Complete,
}

impl Stage {
    /// Begins a fit.
    #[inline(never)]
    fn begin<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        options: Options,
        work: &mut Work<K, B>,
        fit: &mut Fit,
    ) -> Result<(), Error> {
        let needed = match options.method {
            Method::Covariance => 2,
            _ => model.terms().len(),
        };
        check(observed.curve().points(), needed)?;
        match options.method {
            Method::Covariance => {
                let tolerance = Tolerance::IfNeeded(options.tolerance);
                *self = Self::Solving;
                work.begin_at(observed, model, Start::Independent, tolerance)
            }
            method => {
                // These methods are for curves only.
                let octaves = observed.octaves();
                work.columns.set(octaves, model);
                let problem = Problem::new(octaves, model, &work.columns);
                *fit = independent::fit(&problem, method)?;
                *self = Self::Complete;
                Ok(())
            }
        }
    }

    // Apart from what goes on with it: its temporaries do not lie on the stack below the deepest calls.
    #[inline(never)]
    fn begin_estimating<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        fit: &mut Fit,
    ) {
        *self = Self::Estimating {
            estimator: Estimator::NEW,
            is_complete: false,
        };
        if let Self::Estimating { estimator, .. } = self {
            estimator.begin(problem, solver, fit);
        }
    }

    /// Begins to refine the coefficients, if the fit allows it.
    #[inline(never)]
    fn begin_refining<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        work: &mut Work<K, B>,
        fit: &Fit,
    ) -> Result<(), Error> {
        if !Refinement::applies(model, fit) {
            *self = Self::Complete;
            return Ok(());
        }
        *self = Self::Refining(Refinement::NEW);
        match self {
            Self::Refining(refining) => refining.begin(observed, model, fit, work),
            _ => Ok(()),
        }
    }

    /// Does one piece of work, and returns whether the fit is complete.
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        work: &mut Work<K, B>,
        fit: &mut Fit,
    ) -> Result<bool, Error> {
        let problem = Problem::new(observed, model, &work.columns);
        match self {
            Self::Solving => {
                if work.solver.advance(&problem)? {
                    *self = Self::Solved;
                }
            }
            Self::Solved => self.begin_estimating(&problem, &work.solver, fit),
            Self::Estimating {
                is_complete: true, ..
            } => self.begin_refining(observed, model, work, fit)?,
            Self::Estimating {
                estimator,
                is_complete,
            } => *is_complete = estimator.advance(&problem, &work.solver, fit),
            Self::Refining(refining) => {
                if refining.advance(observed, model, work, fit)? {
                    // What follows a fit finds the columns of all rows.
                    work.columns.set(observed, model);
                    *self = Self::Complete;
                }
            }
            Self::Complete => {}
        }
        Ok(self.is_complete())
    }

    const fn is_complete(&self) -> bool {
        matches!(self, Self::Complete)
    }

    /// The estimator at its end, before the coefficients are refined.
    pub(crate) const fn estimated(&self) -> Option<&Estimator> {
        match self {
            Self::Estimating {
                estimator,
                is_complete: true,
            } => Some(estimator),
            _ => None,
        }
    }
}
