//! Cholesky factors of a curve's covariance and of the normal equations, in place.
//!
//! nalgebra's own takes and returns matrices by value: three copies of 3 KiB on the stack of a
//! microcontroller for 20 octaves. A factor is found in the precision of the rest, whatever it is kept in.

use crate::{
    algebra::{Elements, Number, Square, Vector},
    math,
    real::{Real, double, real, single},
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
        single(value)
    }

    fn value(self) -> Real {
        real(self)
    }
}

/// Replaces the lower triangle of the first `n` rows by its Cholesky factor, with the reciprocals of
/// the diagonal on the diagonal. `false` if the matrix is not positive definite.
#[inline(never)]
pub(crate) fn factor<M: Elements<Element: Element>>(matrix: &mut M, n: usize) -> bool {
    let mut reciprocal = 0.0;
    for j in 0..n {
        for i in j..n {
            let mut value = matrix.at(i, j).value();
            for k in 0..j {
                value -= matrix.at(i, k).value() * matrix.at(j, k).value();
            }
            let element = if i > j {
                value * reciprocal
            } else if value > 0.0 && value.is_finite() {
                reciprocal = 1.0 / math::sqrt(value);
                reciprocal
            } else {
                return false;
            };
            matrix.put_at(i, j, Element::new(element));
        }
    }
    true
}

/// Solves `L x = b` in place, for the factor `L` of [`factor`].
#[inline(never)]
pub(crate) fn forward<M: Elements<Element: Element>, const K: usize>(
    factor: &M,
    n: usize,
    x: &mut Vector<K>,
) {
    for i in 0..n.min(K) {
        let mut value = x[i];
        for k in 0..i {
            value -= factor.at(i, k).value() * x[k];
        }
        x.put(i, value * factor.at(i, i).value());
    }
}

/// [`forward`] in single precision.
#[inline(never)]
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
#[inline(never)]
pub(crate) fn backward<M: Elements<Element: Element>, const K: usize>(
    factor: &M,
    n: usize,
    x: &mut Vector<K>,
) {
    for i in (0..n.min(K)).rev() {
        let mut value = x[i];
        for k in i + 1..n.min(K) {
            value -= factor.at(k, i).value() * x[k];
        }
        x.put(i, value * factor.at(i, i).value());
    }
}
