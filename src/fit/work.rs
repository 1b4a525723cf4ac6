//! The memory of a fit.

use super::{
    problem::{Columns, Problem},
    shape::Derivatives,
    solver::{Solver, Start, Tolerance},
};
use crate::{
    error::Error,
    evidence::observed::Observed,
    pause::{Pause, Stop, call},
    theory::model::Model,
};

/// The memory of a fit by the covariance: the columns of the model, their solution, and their derivatives by the shapes.
pub(crate) struct Work<const K: usize, const B: usize = 0> {
    pub(crate) columns: Columns<K, B>,
    pub(crate) solver: Solver<K, B>,
    pub(crate) derivatives: Derivatives<K, B>,
}

impl<const K: usize, const B: usize> Work<K, B> {
    /// No fit yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NEW: Self = Self {
        columns: Columns::EMPTY,
        solver: Solver::NEW,
        derivatives: Derivatives::NONE,
    };

    /// Begins to solve a model.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn begin_at(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        start: Start,
        tolerance: Tolerance,
    ) -> Result<(), Error> {
        self.columns.set(observed, model);
        let problem = Problem::new(observed, model, &self.columns);
        self.solver.begin(&problem, start, tolerance)
    }

    /// Solves a model, and calls the pause between two pieces.
    ///
    /// # Errors
    /// [`Error::Singular`], and the end of the pause.
    #[inline(never)]
    pub(crate) fn solve(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        start: Start,
        tolerance: Tolerance,
        pause: &mut Pause<'_>,
    ) -> Result<(), Stop> {
        self.begin_at(observed, model, start, tolerance)?;
        let problem = Problem::new(observed, model, &self.columns);
        loop {
            call(pause)?;
            if self.solver.advance(&problem)? {
                return Ok(());
            }
        }
    }
}
