//! The covariance of a curve, factored. It gives the units in which octaves are independent.

use super::problem::{Problem, relative_accuracy};
use crate::{
    algebra::{self, Triangle},
    cholesky,
    covariance::covariance_row,
    error::Error,
    limits::MAX_EFFECTS,
    list::numbered,
    math,
    nnls::{NormalEquations, Vector},
    real::{Real, real, single},
};
use heapless::Vec;

/// The shares that the correlations lose. They are tried in turn until the covariance is positive
/// definite. Chosen by hand; no study varies them. The last one takes octaves for independent, which
/// always works.
const SHRINKAGES: [Real; 6] = [0.0, 0.01, 0.03, 0.1, 0.3, 1.0];

/// The covariance of a curve relative to a model, factored.
pub(crate) struct Weights<const K: usize> {
    /// The model's variances.
    pub(crate) model: algebra::Vector<K>,
    /// The Cholesky factor of the covariance relative to the model's variances. Single precision is
    /// enough for it, because the covariance itself is no more precise.
    factor: Triangle<K, K, f32>,
    /// The logarithm of the determinant of the covariance, in rate units.
    pub(crate) log_determinant: Real,
    pub(crate) tolerance: Real,
    pub(crate) shrinkage: Real,
    /// The next row and column of the covariance, and the present attempt at a positive definite one. They are
    /// where [`advance`](Self::advance) goes on.
    row: usize,
    column: usize,
    attempt: usize,
}

impl<const K: usize> Weights<K> {
    /// The weights of no model yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        model: algebra::Vector::ZEROS,
        factor: Triangle::ZEROS,
        log_determinant: 0.0,
        tolerance: 0.0,
        shrinkage: 0.0,
        row: 0,
        column: 0,
        attempt: 0,
    };

    /// Computes the weights of a model with these squared coefficients, in one go.
    pub(crate) fn set(
        &mut self,
        problem: &Problem<'_, K>,
        squares: &Vector,
        tolerance: Real,
    ) -> Result<(), Error> {
        self.begin(problem, squares, tolerance)?;
        while !self.advance(problem, squares)? {}
        Ok(())
    }

    /// Begins to compute the weights of a model with these squared coefficients.
    ///
    /// # Errors
    /// [`Error::Singular`] if the model has no variance in an octave.
    pub(crate) fn begin(
        &mut self,
        problem: &Problem<'_, K>,
        squares: &Vector,
        tolerance: Real,
    ) -> Result<(), Error> {
        for k in 0..problem.points.len().min(K) {
            let variance = problem.variance(k, squares);
            if !(variance.is_finite() && variance > 0.0) {
                return Err(Error::Singular);
            }
            self.model.put(k, variance);
        }
        self.tolerance = tolerance;
        (self.row, self.column) = (0, 0);
        self.attempt = 0;
        Ok(())
    }

    /// Sets the weights of octaves that are taken for independent, each with the scatter that Lv, Liu, Lai
    /// & Huang 2015 give it at its measured variance. A model that lacks an effect knows neither the
    /// scatter nor the correlations of the octaves where it fails, so they say nothing about the effect.
    pub(crate) fn set_independent(&mut self, problem: &Problem<'_, K>) {
        self.factor = Triangle::ZEROS;
        for (k, point) in numbered(problem.points.iter()).take(K) {
            self.model.put(k, problem.measured(k));
            self.factor
                .put((k, k), single(1.0 / relative_accuracy(point)));
        }
    }

    /// Computes one more row of the covariance or a part of it, or factors the covariance when all rows are there.
    /// Returns `true` when the weights are complete.
    ///
    /// # Errors
    /// [`Error::Singular`] if no shrinkage makes the covariance positive definite.
    #[inline(never)]
    pub(crate) fn advance(
        &mut self,
        problem: &Problem<'_, K>,
        squares: &Vector,
    ) -> Result<bool, Error> {
        let n = problem.points.len().min(K);
        let shrinkage = SHRINKAGES.get(self.attempt).copied();
        self.shrinkage = shrinkage.ok_or(Error::Singular)?;
        if self.row < n {
            self.column = self.set_row(problem, squares, 1.0 - self.shrinkage);
            if self.column >= n {
                self.row = self.row.saturating_add(1);
                self.column = self.row;
            }
            return Ok(false);
        }
        if !cholesky::factor(&mut self.factor, n) {
            self.attempt = self.attempt.saturating_add(1);
            (self.row, self.column) = (0, 0);
            return Ok(false);
        }
        let diagonal = |k: usize| self.model[k] * problem.variance_unit / real(self.factor[(k, k)]);
        self.log_determinant = (0..n).map(|k| 2.0 * math::log(diagonal(k))).sum();
        Ok(true)
    }

    /// Computes a part of one row of the covariance relative to the model, and returns the column that comes next.
    /// The correlations are multiplied by `keep`.
    fn set_row(&mut self, problem: &Problem<'_, K>, squares: &Vector, keep: Real) -> usize {
        let (row, model, tolerance) = (self.row, &self.model, self.tolerance);
        let factor = &mut self.factor;
        let own = 1.0 / model[row];
        covariance_row(
            problem.points,
            problem.model,
            squares.as_slice(),
            problem.interval_s,
            (row, self.column),
            &mut |k, covariance| {
                let relative = covariance * own / model[k];
                let kept = if k == row {
                    relative + tolerance * tolerance
                } else {
                    relative * keep
                };
                factor.put((k, row), single(kept));
            },
        )
    }

    /// The standard error of octave `k`, relative to the model's variance.
    pub(crate) fn relative_error(&self, k: usize) -> Real {
        let element = |j: usize| real(self.factor[(k, j)]);
        let row = (0..k).map(|j| element(j) * element(j));
        let diagonal = 1.0 / element(k);
        math::sqrt(row.sum::<Real>() + diagonal * diagonal)
    }

    /// χ² of the curve for the model with these squared coefficients.
    pub(crate) fn chi_squared(&self, problem: &Problem<'_, K>, squares: &Vector) -> Real {
        let residual = |k: usize| problem.measured(k) - problem.variance(k, squares);
        self.whiten(problem, &|_| 1.0, &residual).norm_squared()
    }

    /// Sets the normal equations `A'C⁻¹A β = A'C⁻¹y`, one column at a time. The standard error of
    /// octave `k` is enlarged by the factor `scatter(k)`. `more` holds further columns behind those of
    /// the model.
    #[inline(never)]
    pub(crate) fn equations(
        &self,
        problem: &Problem<'_, K>,
        scatter: &dyn Fn(usize) -> Real,
        more: &[algebra::Vector<K, f32>],
        right: &dyn Fn(usize) -> Real,
        equations: &mut NormalEquations,
    ) -> Result<(), Error> {
        let n = problem.points.len().min(K);
        let count = problem.count();
        let unit = |i: usize, k: usize| match i.checked_sub(count) {
            None => problem.unit(i, k),
            Some(at) => more.get(at).map_or(0.0, |column| real(column[k])),
        };
        let per_error = |k: usize| 1.0 / (self.model[k] * scatter(k));
        equations.set(count.saturating_add(more.len()), &|i, row| {
            // This is C⁻¹ times the column, in units of the squared errors.
            let mut column = self.whiten(problem, scatter, &|k| unit(i, k));
            cholesky::backward(&self.factor, n, &mut column);
            for k in 0..n {
                column.put(k, column[k] * per_error(k));
            }
            for j in 0..=i {
                row.put(j, (0..n).map(|k| column[k] * unit(j, k)).sum());
            }
            (0..n).map(|k| column[k] * right(k)).sum()
        })
    }

    /// Expresses the curve and the columns in units in which octaves are independent and have a
    /// variance of one.
    #[inline(never)]
    pub(crate) fn whiten_into(&self, problem: &Problem<'_, K>, whitened: &mut Whitened<K>) {
        whitened.columns.clear();
        for column in problem.columns() {
            // There is a place for the column of every effect.
            let _ = whitened
                .columns
                .push(self.whiten(problem, &|_| 1.0, &|k| real(column[k])));
        }
        whitened.curve = self.whiten(problem, &|_| 1.0, &|k| problem.measured(k));
    }

    /// One more column of variances in the same units.
    #[inline(never)]
    pub(crate) fn whiten(
        &self,
        problem: &Problem<'_, K>,
        scatter: &dyn Fn(usize) -> Real,
        variance: &dyn Fn(usize) -> Real,
    ) -> algebra::Vector<K> {
        let mut column = algebra::Vector::<K>::zeros();
        let n = problem.points.len().min(K);
        for k in 0..n {
            column.put(k, variance(k) / (self.model[k] * scatter(k)));
        }
        cholesky::forward(&self.factor, n, &mut column);
        column
    }

    /// Does the same in single precision, for a shape on trial. A core that has single precision in
    /// hardware takes a tenth of the time. With a tolerance granted, the numbers stay below some
    /// hundred standard errors. The column is in units of its largest number, which is returned too.
    pub(crate) fn whiten_trial(
        &self,
        problem: &Problem<'_, K>,
        variance: &dyn Fn(usize) -> Real,
    ) -> (algebra::Vector<K, f32>, Real) {
        let n = problem.points.len().min(K);
        let relative = |k: usize| variance(k) / self.model[k];
        let unit = (0..n).map(relative).fold(0.0, Real::max);
        let mut column = algebra::Vector::<K, f32>::zeros();
        for k in 0..n {
            column.put(k, single(relative(k) / unit));
        }
        cholesky::forward(&self.factor, n, &mut column);
        (column, unit)
    }

    /// The variance of the sum of a whitened curve along `direction`, if the octaves do not have the scatter
    /// that the weights expect. `ratio(k)` is the standard error of octave `k` relative to the expected one,
    /// and the tolerance, which no record has, is left out.
    #[inline(never)]
    pub(crate) fn variance_along(
        &self,
        n: usize,
        direction: &algebra::Vector<K>,
        ratio: &dyn Fn(usize) -> Real,
    ) -> Real {
        // With the factor L, the covariance of the octaves is S (L L' − tolerance²) S, and whitening
        // multiplies it by the inverse of L from both sides.
        let mut x = *direction;
        cholesky::backward(&self.factor, n, &mut x);
        for k in 0..n {
            x.put(k, x[k] * ratio(k));
        }
        let column = |j: usize| {
            let below = (j.saturating_add(1)..n).map(|k| real(self.factor[(k, j)]) * x[k]);
            x[j] / real(self.factor[(j, j)]) + below.sum::<Real>()
        };
        let tolerance = self.tolerance * self.tolerance;
        (0..n)
            .map(|j| column(j) * column(j) - tolerance * x[j] * x[j])
            .sum()
    }
}

/// The curve and the columns in units in which octaves are independent. Octaves that the curve does not
/// have are zero.
pub(crate) struct Whitened<const K: usize> {
    pub(crate) columns: Vec<algebra::Vector<K>, MAX_EFFECTS>,
    pub(crate) curve: algebra::Vector<K>,
}

impl<const K: usize> Whitened<K> {
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        columns: Vec::new(),
        curve: algebra::Vector::ZEROS,
    };
}
