//! The likelihood-ratio test of a limit: how far a coefficient lies above or below it.

use super::{
    problem::Problem,
    result::Fit,
    solver::{CONVERGED, Rounds, Solver},
};
use crate::{
    error::Error,
    numerics::{math, nnls::Vector, real::Real},
};

/// A limit at which the effect alone would be this many times the curve in every octave is replaced by
/// the lowest limit for which this is so. The curve is as far below the one as below the other, and the
/// ratio of column and model stays within the range of single precision. Chosen by hand.
const BEYOND: Real = 1e3;

/// The rounds of a test against zero end when the relative change of the model is smaller than this. It moves the
/// statistic by about as little.
const ROUGHLY: Real = 0.03;

/// A test of the hypothesis that a coefficient is at a limit.
///
/// The curve is fitted twice: with the coefficient held at the limit and all others free, and with all
/// of them free. The statistic is the signed root of the difference in χ²,
///
/// ```text
/// z = ± √(χ²(limit) − χ²(free)),
/// ```
///
/// which is positive if the free coefficient is above the limit. If the coefficient is at the limit, z is
/// nearly normal with a variance of one (Wilks 1938), or nearer to zero where the others are at zero too
/// (Chernoff 1954).
///
/// Both χ² take the covariance of the curve at the hypothesis. The covariance at the free fit would follow
/// the scatter of the curve: where an octave is low by chance it would be taken for exact, and a wrong
/// coefficient for a certain one.
pub(crate) struct LikelihoodRatio {
    /// The place of the coefficient in the model.
    place: usize,
    /// The square of the limit, in the problem's variance unit.
    square: Real,
    /// The rounds end when the relative change of the model is smaller than this.
    converged: Real,
    /// χ² with the coefficient at the limit, once it is known.
    at_limit: Option<Real>,
}

impl LikelihoodRatio {
    /// Begins to test the limit of the coefficient at `place`, in rate units and seconds. It works in the
    /// memory of the fit, which is complete.
    ///
    /// # Errors
    /// [`Error::Singular`] if the limit or the curve is beyond the range of numbers.
    #[inline(never)]
    pub(crate) fn begin<const K: usize, const B: usize>(
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
        fit: &Fit,
        place: usize,
        limit: Real,
    ) -> Result<Self, Error> {
        let most = problem
            .rows()
            .map(|k| problem.measured(k) / problem.unit(place, k))
            .fold(0.0, Real::max);
        let root = limit / math::sqrt(problem.variance_unit);
        let square = (root * root).min(BEYOND * most);
        let mut start = problem.squares_of(fit);
        start.put(place, square);
        solver.begin_rounds(problem, start, fit.tolerance, Rounds::All)?;
        Ok(Self {
            place,
            square,
            converged: CONVERGED,
            at_limit: None,
        })
    }

    /// Begins to test whether the coefficient at `place` may be zero. The rounds start with the best fit without the
    /// coefficient by the solver's present weights.
    ///
    /// # Errors
    /// [`Error::Singular`] if nothing else explains the curve.
    #[inline(never)]
    pub(crate) fn begin_at_zero<const K: usize, const B: usize>(
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
            square: 0.0,
            converged: ROUGHLY,
            at_limit: None,
        })
    }

    /// Does one piece of work, no longer than one of the fit. Returns the signed root of the likelihood
    /// ratio once it is known, and `None` before.
    ///
    /// # Errors
    /// [`Error::Singular`] if the covariance at the hypothesis cannot be factored.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
    ) -> Result<Option<Real>, Error> {
        if let Some(at_limit) = self.at_limit {
            return self.compare(problem, solver, at_limit).map(Some);
        }
        if solver.weights.advance(problem, &solver.assumed)? {
            self.end_round(problem, solver)?;
        }
        Ok(None)
    }

    /// Solves the normal equations at the limit with the present weights.
    // Apart from the computation of the weights: its temporaries do not lie on the stack below the deepest calls.
    #[inline(never)]
    fn end_round<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
    ) -> Result<(), Error> {
        let rest = |k: usize| problem.measured(k) - self.square * problem.unit(self.place, k);
        let (weights, equations) = (&solver.weights, &mut solver.equations);
        weights.equations(problem, &|_| 1.0, &[], &rest, equations)?;
        let pinned = problem.pinned().with(self.place);
        let (mut squares, _) = solver.equations.solve_non_negative(&pinned);
        squares.put(self.place, self.square);
        solver.squares = squares;
        if solver.has_ended(problem, self.converged)? {
            self.at_limit = Some(solver.weights.squared_residuals(problem, &squares));
        }
        Ok(())
    }

    /// Fits all coefficients with the covariance at the limit, and compares the two fits.
    #[inline(never)]
    fn compare<const K: usize, const B: usize>(
        &self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
        at_limit: Real,
    ) -> Result<Real, Error> {
        let curve = |k: usize| problem.measured(k);
        let (weights, equations) = (&solver.weights, &mut solver.equations);
        weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
        let (squares, _): (Vector, _) = solver.equations.solve_non_negative(&problem.pinned());
        let free = solver.weights.squared_residuals(problem, &squares);
        let root = math::sqrt((at_limit - free).max(0.0));
        Ok(if squares[self.place] > self.square {
            root
        } else {
            -root
        })
    }
}

#[cfg(test)]
mod tests;
