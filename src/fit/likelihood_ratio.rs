//! The likelihood-ratio test against zero: how far a coefficient lies above it.

use super::{
    problem::Problem,
    result::Fit,
    solver::{Rounds, Solver},
};
use crate::{
    error::Error,
    numerics::{math, nnls::Vector, real::Real},
};

/// The rounds of a test against zero end when the relative change of the model is smaller than this. It moves the
/// statistic by about as little.
const ROUGHLY: Real = 0.03;

/// A test of the hypothesis that a coefficient is zero.
///
/// The curve is fitted twice: without the coefficient, and with it. The statistic is the root of the difference in χ²,
///
/// ```text
/// z = √(χ²(zero) − χ²(free)).
/// ```
///
/// If the coefficient is zero, z is nearly normal with a variance of one where the free coefficient is above zero (Wilks
/// 1938), and zero elsewhere (Chernoff 1954).
///
/// Both χ² take the covariance of the curve at the hypothesis. The covariance at the free fit would follow
/// the scatter of the curve: where an octave is low by chance it would be taken for exact, and a wrong
/// coefficient for a certain one.
pub(crate) struct LikelihoodRatio {
    /// The place of the coefficient in the model.
    place: usize,
    /// χ² without the coefficient, once it is known.
    at_zero: Option<Real>,
}

impl LikelihoodRatio {
    /// Begins to test whether the coefficient at `place` may be zero. The rounds start with the best fit without the
    /// coefficient by the solver's present weights.
    ///
    /// # Errors
    /// [`Error::Singular`] if nothing else explains the curve.
    #[inline(never)]
    pub(crate) fn begin<const K: usize, const B: usize>(
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
        fit: &Fit,
        place: usize,
    ) -> Result<Self, Error> {
        let pinned = problem.pinned().with(place);
        let (start, _) = solver.equations.solve_non_negative(&pinned);
        solver.begin_rounds(problem, start, fit.tolerance, Rounds::All)?;
        Ok(Self {
            place,
            at_zero: None,
        })
    }

    /// Does one piece of work, no longer than one of the fit. Returns the root of the likelihood ratio once it is known, and
    /// `None` before.
    ///
    /// # Errors
    /// [`Error::Singular`] if the covariance at the hypothesis cannot be factored.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
    ) -> Result<Option<Real>, Error> {
        if let Some(at_zero) = self.at_zero {
            return Self::compare(problem, solver, at_zero).map(Some);
        }
        if solver.weights.advance(problem, &solver.assumed)? {
            self.end_round(problem, solver)?;
        }
        Ok(None)
    }

    /// Solves the normal equations without the coefficient with the present weights.
    // Apart from the computation of the weights: its temporaries do not lie on the stack below the deepest calls.
    #[inline(never)]
    fn end_round<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
    ) -> Result<(), Error> {
        let curve = |k: usize| problem.measured(k);
        let (weights, equations) = (&solver.weights, &mut solver.equations);
        weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
        let pinned = problem.pinned().with(self.place);
        let (squares, _) = solver.equations.solve_non_negative(&pinned);
        solver.squares = squares;
        if solver.has_ended(problem, ROUGHLY)? {
            self.at_zero = Some(solver.weights.squared_residuals(problem, &squares));
        }
        Ok(())
    }

    /// Fits all coefficients with the covariance at zero, and compares the two fits.
    #[inline(never)]
    fn compare<const K: usize, const B: usize>(
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
        at_zero: Real,
    ) -> Result<Real, Error> {
        let curve = |k: usize| problem.measured(k);
        let (weights, equations) = (&solver.weights, &mut solver.equations);
        weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
        let (squares, _): (Vector, _) = solver.equations.solve_non_negative(&problem.pinned());
        let free = solver.weights.squared_residuals(problem, &squares);
        Ok(math::sqrt((at_zero - free).max(0.0)))
    }
}
