//! Cholesky factor of a curve's covariance, in place.
//!
//! nalgebra's own takes and returns matrices by value: three copies of 3 KiB on the stack of a
//! microcontroller for 20 octaves. It serves for the small normal equations.

use crate::math;
use nalgebra::{SMatrix, SVector};

/// Replaces the lower triangle of the first `n` rows by its Cholesky factor, with the reciprocals of
/// the diagonal on the diagonal. `false` if the matrix is not positive definite.
pub(crate) fn factor<const K: usize>(matrix: &mut SMatrix<f64, K, K>, n: usize) -> bool {
    for j in 0..n.min(K) {
        let mut pivot = matrix[(j, j)];
        for k in 0..j {
            pivot -= matrix[(j, k)] * matrix[(j, k)];
        }
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let reciprocal = 1.0 / math::sqrt(pivot);
        matrix[(j, j)] = reciprocal;
        for i in j + 1..n.min(K) {
            let mut value = matrix[(i, j)];
            for k in 0..j {
                value -= matrix[(i, k)] * matrix[(j, k)];
            }
            matrix[(i, j)] = value * reciprocal;
        }
    }
    true
}

/// Solves `L x = b` in place, for the factor `L` of [`factor`].
pub(crate) fn forward<const K: usize>(
    factor: &SMatrix<f64, K, K>,
    n: usize,
    x: &mut SVector<f64, K>,
) {
    for i in 0..n.min(K) {
        let mut value = x[i];
        for k in 0..i {
            value -= factor[(i, k)] * x[k];
        }
        x[i] = value * factor[(i, i)];
    }
}
