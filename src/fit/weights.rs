//! The covariance of a curve, factored: the units in which octaves are independent.

use super::{Columns, Problem, squared};
use crate::{
    covariance::covariance,
    error::Error,
    math,
    nnls::{NormalEquations, Vector},
};
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// The covariance of a curve relative to a model, factored.
pub(crate) struct Weights<const K: usize> {
    /// The model's variances.
    pub(crate) model: SVector<f64, K>,
    factor: Cholesky<f64, Const<K>>,
    /// Of the covariance in rate units.
    pub(crate) log_determinant: f64,
    pub(crate) tolerance: f64,
    pub(crate) shrinkage: f64,
}

impl<const K: usize> Weights<K> {
    pub(crate) fn new(
        problem: &Problem<'_, K>,
        squares: &Vector,
        tolerance: f64,
    ) -> Result<Self, Error> {
        let points = problem.points;
        let model = SVector::<f64, K>::from_fn(|k, _| {
            if k < points.len() {
                problem.variance(k, squares)
            } else {
                1.0
            }
        });
        if !model
            .iter()
            .all(|&variance| variance.is_finite() && variance > 0.0)
        {
            return Err(Error::Singular);
        }
        let mut matrix = covariance::<K>(
            points,
            problem.model,
            squares.as_slice(),
            problem.interval_s,
        );
        for k in 0..K {
            for j in 0..K {
                matrix[(j, k)] /= model[j] * model[k];
            }
            // Octaves that the curve does not have become the identity.
            matrix[(k, k)] += if k < points.len() {
                squared(tolerance)
            } else {
                1.0
            };
        }
        let (factor, shrinkage) = factor_positive(matrix)?;
        let lower = factor.l_dirty();
        let log_determinant = (0..points.len())
            .map(|k| 2.0 * math::log(lower[(k, k)] * model[k]))
            .sum();
        Ok(Self {
            model,
            factor,
            log_determinant,
            tolerance,
            shrinkage,
        })
    }

    /// Standard error of octave `k`, relative to the model's variance.
    pub(crate) fn relative_error(&self, k: usize) -> f64 {
        let row = self.factor.l_dirty().row(k);
        let square: f64 = row.iter().take(k + 1).map(|&x| x * x).sum();
        math::sqrt(square)
    }

    /// Curve and columns in units in which octaves are independent and have a variance of one,
    /// with the standard error of octave `k` enlarged by `scatter(k)`.
    pub(crate) fn whiten(
        &self,
        problem: &Problem<'_, K>,
        scatter: impl Fn(usize) -> f64,
    ) -> Result<Whitened<K>, Error> {
        let mut columns = problem.columns;
        let mut curve = SVector::<f64, K>::zeros();
        for (k, point) in problem.points.iter().enumerate() {
            let unit = 1.0 / (self.model[k] * scatter(k));
            curve[k] = point.variance * unit;
            for i in 0..problem.count() {
                columns[(k, i)] *= unit;
            }
        }
        let lower = self.factor.l_dirty();
        let solved = lower.solve_lower_triangular_mut(&mut columns)
            && lower.solve_lower_triangular_mut(&mut curve);
        if solved {
            Ok(Whitened { columns, curve })
        } else {
            Err(Error::Singular)
        }
    }

    /// One more column in the same units.
    pub(crate) fn whiten_column(
        &self,
        column: &mut SVector<f64, K>,
        scatter: impl Fn(usize) -> f64,
    ) -> bool {
        for k in 0..K {
            column[k] /= self.model[k] * scatter(k);
        }
        self.factor.l_dirty().solve_lower_triangular_mut(column)
    }
}

/// Curve and columns in units in which octaves are independent.
pub(crate) struct Whitened<const K: usize> {
    pub(crate) columns: Columns<K>,
    pub(crate) curve: SVector<f64, K>,
}

impl<const K: usize> Whitened<K> {
    pub(crate) fn equations(&self, count: usize) -> Result<NormalEquations, Error> {
        let matrix = self.columns.tr_mul(&self.columns);
        let right = self.columns.tr_mul(&self.curve);
        NormalEquations::new(&matrix, &right, count)
    }
}

/// Cholesky factor of a covariance, its correlations shrunk by as little as makes it positive
/// definite, and by how much that was.
fn factor_positive<const K: usize>(
    matrix: SMatrix<f64, K, K>,
) -> Result<(Cholesky<f64, Const<K>>, f64), Error> {
    for shrinkage in [0.0, 0.01, 0.03, 0.1, 0.3] {
        let keep = 1.0 - shrinkage;
        let shrunk = SMatrix::from_fn(|j, k| matrix[(j, k)] * if j == k { 1.0 } else { keep });
        if let Some(factor) = Cholesky::new(shrunk) {
            return Ok((factor, shrinkage));
        }
    }
    Err(Error::Singular)
}
