//! The covariance of a curve, factored: the units in which octaves are independent.

use super::{Problem, squared};
use crate::{
    algebra::{self, Triangle},
    cholesky,
    covariance::covariance,
    error::Error,
    limits::MAX_EFFECTS,
    math,
    nnls::{NormalEquations, Vector},
    real::{Real, real, single},
};
use heapless::Vec;

/// How much of the correlations a covariance keeps, tried in turn until it is positive definite.
const SHRINKAGES: [Real; 5] = [0.0, 0.01, 0.03, 0.1, 0.3];

/// The covariance of a curve relative to a model, factored.
pub(crate) struct Weights<const K: usize> {
    /// The model's variances.
    pub(crate) model: algebra::Vector<K>,
    /// Of the covariance relative to them; single precision is that of the covariance.
    factor: Triangle<K, K, f32>,
    /// Of the covariance in rate units.
    pub(crate) log_determinant: Real,
    pub(crate) tolerance: Real,
    pub(crate) shrinkage: Real,
}

impl<const K: usize> Weights<K> {
    /// Not yet of any model.
    pub(crate) fn empty() -> Self {
        Self {
            model: algebra::Vector::zeros(),
            factor: Triangle::zeros(),
            log_determinant: 0.0,
            tolerance: 0.0,
            shrinkage: 0.0,
        }
    }

    /// Takes the covariance of a model with these squared coefficients.
    #[inline(never)]
    pub(crate) fn set(
        &mut self,
        problem: &Problem<'_, K>,
        squares: &Vector,
        tolerance: Real,
    ) -> Result<(), Error> {
        let n = problem.points.len().min(K);
        for k in 0..n {
            let variance = problem.variance(k, squares);
            if !(variance.is_finite() && variance > 0.0) {
                return Err(Error::Singular);
            }
            self.model.put(k, variance);
        }
        self.tolerance = tolerance;
        for shrinkage in SHRINKAGES {
            self.shrinkage = shrinkage;
            self.take_relative(problem, squares, 1.0 - shrinkage);
            if cholesky::factor(&mut self.factor, n) {
                self.log_determinant = (0..n)
                    .map(|k| {
                        2.0 * math::log(
                            self.model[k] * problem.variance_unit / real(self.factor[(k, k)]),
                        )
                    })
                    .sum();
                return Ok(());
            }
        }
        Err(Error::Singular)
    }

    /// The covariance relative to the model, of which correlations keep a share.
    fn take_relative(&mut self, problem: &Problem<'_, K>, squares: &Vector, keep: Real) {
        let mut reciprocal = self.model;
        for k in 0..problem.points.len().min(K) {
            reciprocal.put(k, 1.0 / self.model[k]);
        }
        let (factor, tolerance) = (&mut self.factor, self.tolerance);
        covariance(
            problem.points,
            problem.model,
            squares.as_slice(),
            problem.interval_s,
            &mut |k, j, covariance| {
                let relative = covariance * reciprocal[j] * reciprocal[k];
                let kept = if j == k {
                    relative + squared(tolerance)
                } else {
                    relative * keep
                };
                factor.put((k, j), single(kept));
            },
        );
    }

    /// Standard error of octave `k`, relative to the model's variance.
    pub(crate) fn relative_error(&self, k: usize) -> Real {
        let element = |j: usize| real(self.factor[(k, j)]);
        let row = (0..k).map(|j| squared(element(j)));
        let diagonal = 1.0 / element(k);
        math::sqrt(row.sum::<Real>() + squared(diagonal))
    }

    /// χ² of the curve beside the model with these squared coefficients.
    pub(crate) fn chi_squared(&self, problem: &Problem<'_, K>, squares: &Vector) -> Real {
        let residual = |k: usize| problem.measured(k) - problem.variance(k, squares);
        self.whiten(problem, &|_| 1.0, &residual).norm_squared()
    }

    /// The normal equations `A'C⁻¹A β = A'C⁻¹y`, one column at a time, with the standard error of octave
    /// `k` enlarged by `scatter(k)`. Behind the model's own columns there may be `more`.
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
            // C⁻¹ of this column, in units of the errors squared.
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

    /// Curve and columns in units in which octaves are independent and have a variance of one,
    /// with the standard error of octave `k` enlarged by `scatter(k)`.
    #[inline(never)]
    pub(crate) fn whiten_into(
        &self,
        problem: &Problem<'_, K>,
        scatter: &dyn Fn(usize) -> Real,
        whitened: &mut Whitened<K>,
    ) {
        whitened.columns.clear();
        for column in &problem.columns {
            // As many columns as effects.
            let _ = whitened
                .columns
                .push(self.whiten(problem, scatter, &|k| real(column[k])));
        }
        whitened.curve = self.whiten(problem, scatter, &|k| problem.measured(k));
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

    /// The same in single precision, for a shape on trial: a core that has it in hardware spends a tenth
    /// of the time, and with a tolerance granted, numbers are below some hundred standard errors. In
    /// units of its largest number, which is returned too.
    pub(crate) fn whiten_trial(
        &self,
        problem: &Problem<'_, K>,
        scatter: &dyn Fn(usize) -> Real,
        variance: &dyn Fn(usize) -> Real,
    ) -> (algebra::Vector<K, f32>, Real) {
        let n = problem.points.len().min(K);
        let relative = |k: usize| variance(k) / (self.model[k] * scatter(k));
        let unit = (0..n).map(relative).fold(0.0, Real::max);
        let mut column = algebra::Vector::<K, f32>::zeros();
        for k in 0..n {
            column.put(k, single(relative(k) / unit));
        }
        cholesky::forward(&self.factor, n, &mut column);
        (column, unit)
    }
}

/// Curve and columns in units in which octaves are independent. Octaves that the curve does not have
/// are zero.
pub(crate) struct Whitened<const K: usize> {
    pub(crate) columns: Vec<algebra::Vector<K>, MAX_EFFECTS>,
    pub(crate) curve: algebra::Vector<K>,
}

impl<const K: usize> Whitened<K> {
    pub(crate) fn empty() -> Self {
        Self {
            columns: Vec::new(),
            curve: algebra::Vector::zeros(),
        }
    }
}
