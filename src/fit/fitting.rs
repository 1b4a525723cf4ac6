//! A fit, in one go or in pieces.

use super::{
    estimate::Estimator,
    independent,
    method::{Method, Options},
    problem::{Columns, Problem, check},
    result::Fit,
    solver::{Solver, Start, Tolerance},
};
use crate::{curve::Curve, error::Error, model::Model};

/// Fits a model's coefficients to a curve.
///
/// # Errors
/// [`Error::NoNoise`] if an octave has a variance of zero. [`Error::TooFewOctaves`] for fewer than two
/// octaves, or for fewer than there are effects with the unconstrained methods. [`Error::Singular`] if
/// the normal equations have no solution.
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
pub fn fit<const K: usize>(
    curve: &Curve<K>,
    model: &Model,
    options: Options,
) -> Result<Fit, Error> {
    let mut fit = Fit::empty();
    let mut work = Work::new();
    if let Some(mut stage) = Stage::begin(curve, model, options, &mut work, &mut fit)? {
        while !stage.advance(curve, model, &mut work, &mut fit)? {}
    }
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
/// let mut fitting = Fitting::new(curve, Model::ieee_952(), Options::default())?;
/// let fit = loop {
///     if let Some(fit) = fitting.advance()? {
///         break fit;
///     }
///     // Feed the watchdog, take the next samples.
/// };
/// assert!((fit.coefficients[1].value - 0.1).abs() < 1e-6);
/// # Ok::<(), allanite::Error>(())
/// ```
pub struct Fitting<const K: usize> {
    curve: Curve<K>,
    model: Model,
    work: Work<K>,
    fit: Fit,
    /// `None` when the fit is complete.
    stage: Option<Stage>,
}

impl<const K: usize> Fitting<K> {
    /// Begins to fit a model to a curve.
    ///
    /// # Errors
    /// The same as those of [`fit()`].
    pub fn new(curve: Curve<K>, model: Model, options: Options) -> Result<Self, Error> {
        let mut fitting = Self {
            curve,
            model,
            work: Work::new(),
            fit: Fit::empty(),
            stage: None,
        };
        let (work, fit) = (&mut fitting.work, &mut fitting.fit);
        fitting.stage = Stage::begin(&fitting.curve, &fitting.model, options, work, fit)?;
        Ok(fitting)
    }

    /// Does one piece of work. Returns the fit once it is complete, and `None` before.
    ///
    /// # Errors
    /// The same as those of [`fit()`].
    pub fn advance(&mut self) -> Result<Option<&Fit>, Error> {
        if let Some(stage) = &mut self.stage {
            let complete =
                stage.advance(&self.curve, &self.model, &mut self.work, &mut self.fit)?;
            if complete {
                self.stage = None;
            }
        }
        Ok(self.stage.is_none().then_some(&self.fit))
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

/// The memory of a fit by the covariance: the columns of the model, and their solution.
pub(crate) struct Work<const K: usize> {
    pub(crate) columns: Columns<K>,
    pub(crate) solver: Solver<K>,
}

impl<const K: usize> Work<K> {
    /// Memory without a fit.
    pub(crate) fn new() -> Self {
        Self {
            columns: Columns::empty(),
            solver: Solver::new(),
        }
    }

    /// Begins to solve a model.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn begin_at(
        &mut self,
        curve: &Curve<K>,
        model: &Model,
        start: Start,
        tolerance: Tolerance,
    ) -> Result<(), Error> {
        self.columns.set(curve, model);
        let problem = Problem::new(curve, model, &self.columns);
        self.solver.begin(&problem, start, tolerance)
    }
}

/// The stage of a fit by the covariance.
// The smaller variant wastes a few hundred bytes of a fit, which takes some thousands.
#[expect(clippy::large_enum_variant)]
enum Stage {
    Solving,
    Estimating(Estimator),
}

impl Stage {
    /// Begins a fit. Returns `None` if the fit is already complete, as it is with the methods that take
    /// octaves for independent.
    #[inline(never)]
    fn begin<const K: usize>(
        curve: &Curve<K>,
        model: &Model,
        options: Options,
        work: &mut Work<K>,
        fit: &mut Fit,
    ) -> Result<Option<Self>, Error> {
        let needed = match options.method {
            Method::Covariance => 2,
            _ => model.terms().len(),
        };
        check(curve.points(), needed)?;
        match options.method {
            Method::Covariance => {
                let tolerance = Tolerance::IfNeeded(options.tolerance);
                work.begin_at(curve, model, Start::Independent, tolerance)?;
                Ok(Some(Self::Solving))
            }
            method => {
                work.columns.set(curve, model);
                let problem = Problem::new(curve, model, &work.columns);
                *fit = independent::fit(&problem, method)?;
                Ok(None)
            }
        }
    }

    /// Does one piece of work, and returns whether the fit is complete.
    fn advance<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        model: &Model,
        work: &mut Work<K>,
        fit: &mut Fit,
    ) -> Result<bool, Error> {
        let problem = Problem::new(curve, model, &work.columns);
        match self {
            Self::Solving => {
                if work.solver.advance(&problem)? {
                    *self = Self::Estimating(Estimator::new(&problem, &work.solver, fit));
                }
                Ok(false)
            }
            Self::Estimating(estimator) => Ok(estimator.advance(&problem, &work.solver, fit)),
        }
    }
}
