//! Cholesky factors of a curve's covariance and of the normal equations, in place.
//!
//! nalgebra's own takes and returns matrices by value: three copies of 3 KiB on the stack of a
//! microcontroller for 20 octaves. A factor is found in the precision of the rest, whatever it is kept in.

use crate::{
    algebra::{Number, Square, Vector},
    math,
    real::{Real, double, real},
};

/// What a factor's elements are kept in.
pub(crate) trait Element: Number {
    fn new(value: Real) -> Self;
    fn value(self) -> Real;
}

impl Element for f64 {
    fn new(value: Real) -> Self {
        double(value)
    }

    fn value(self) -> Real {
        real(self)
    }
}

impl Element for f32 {
    fn new(value: Real) -> Self {
        value as f32
    }

    fn value(self) -> Real {
        real(self)
    }
}

/// Replaces the lower triangle of the first `n` rows by its Cholesky factor, with the reciprocals of
/// the diagonal on the diagonal. `false` if the matrix is not positive definite.
pub(crate) fn factor<E: Element, const K: usize>(matrix: &mut Square<K, E>, n: usize) -> bool {
    for j in 0..n.min(K) {
        let mut pivot = matrix[(j, j)].value();
        for k in 0..j {
            pivot -= matrix[(j, k)].value() * matrix[(j, k)].value();
        }
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let reciprocal = 1.0 / math::sqrt(pivot);
        matrix.put((j, j), E::new(reciprocal));
        for i in j + 1..n.min(K) {
            let mut value = matrix[(i, j)].value();
            for k in 0..j {
                value -= matrix[(i, k)].value() * matrix[(j, k)].value();
            }
            matrix.put((i, j), E::new(value * reciprocal));
        }
    }
    true
}

/// Solves `L x = b` in place, for the factor `L` of [`factor`].
pub(crate) fn forward<E: Element, const K: usize>(
    factor: &Square<K, E>,
    n: usize,
    x: &mut Vector<K>,
) {
    for i in 0..n.min(K) {
        let mut value = x[i];
        for k in 0..i {
            value -= factor[(i, k)].value() * x[k];
        }
        x.put(i, value * factor[(i, i)].value());
    }
}

/// [`forward`] in single precision.
pub(crate) fn forward_single<const K: usize>(
    factor: &Square<K, f32>,
    n: usize,
    x: &mut Vector<K, f32>,
) {
    for i in 0..n.min(K) {
        let mut value = x[i];
        for k in 0..i {
            value -= factor[(i, k)] * x[k];
        }
        x.put(i, value * factor[(i, i)]);
    }
}

/// Solves `L'x = b` in place.
pub(crate) fn backward<E: Element, const K: usize>(
    factor: &Square<K, E>,
    n: usize,
    x: &mut Vector<K>,
) {
    for i in (0..n.min(K)).rev() {
        let mut value = x[i];
        for k in i + 1..n.min(K) {
            value -= factor[(k, i)].value() * x[k];
        }
        x.put(i, value * factor[(i, i)].value());
    }
}
