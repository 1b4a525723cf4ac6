//! The Cholesky factor `L` of a positive definite matrix `A = L L'`, and the solution of equations with
//! it.
//!
//! The rows of a [`Triangle`] are handled as slices, so that one function serves triangles of every
//! size.
//!
//! nalgebra's own `Cholesky` takes and returns whole square matrices by value. It also asserts the
//! sizes of the parts that it views, so that it may panic. The table compares the alternatives with a
//! plain loop over `(i, j)` in each storage, as measured on a Cortex-M4F in single precision:
//!
//! | instead of the plain loops | flash of a fit | stack of a fit | stack of a diagnosis | its instructions | can panic |
//! |---|---|---|---|---|---|
//! | nalgebra factors the normal equations | + 408 bytes | + 2356 bytes | + 1764 bytes | + 15 % | yes |
//! | nalgebra factors the curve's covariance | + 380 bytes | + 3160 bytes | + 3160 bytes | − 1 % | yes |
//! | squares store the normal equations | + 232 bytes | + 1056 bytes | + 464 bytes | − 13 % | no |
//! | this module | − 152 bytes | + 8 bytes | + 8 bytes | − 8 % | no |
//!
//! The flash is that of the image `footprint_fit`. The other columns are what the image `bench` prints.
//! `cargo xtask bench` measures both. This module takes 650 bytes of flash.

use crate::numerics::{
    algebra::{Number, Triangle, Vector, row_start},
    math,
    real::{Real, real},
};
use num_traits::AsPrimitive;

/// Replaces the first `n` rows of a matrix by those of its Cholesky factor. The diagonal holds the
/// reciprocals of the factor's diagonal. Returns `false` if the matrix is not positive definite; some
/// of its rows are overwritten then.
pub(crate) fn factor<const A: usize, const B: usize, E>(
    matrix: &mut Triangle<A, B, E>,
    n: usize,
) -> bool
where
    E: Number + AsPrimitive<Real>,
    Real: AsPrimitive<E>,
{
    factor_rows(matrix.rows_mut(), n)
}

/// Solves `L x = b` in place, for the factor `L` of [`factor`], in the precision of `x`.
pub(crate) fn forward<const A: usize, const B: usize, const K: usize, E, X>(
    factor: &Triangle<A, B, E>,
    n: usize,
    x: &mut Vector<K, X>,
) where
    E: Number + AsPrimitive<X>,
    X: Number,
{
    forward_rows(factor.rows(), n, x.as_mut_slice());
}

/// Solves `L'x = b` in place, for the factor `L` of [`factor`], in the precision of `x`.
pub(crate) fn backward<const A: usize, const B: usize, const K: usize, E, X>(
    factor: &Triangle<A, B, E>,
    n: usize,
    x: &mut Vector<K, X>,
) where
    E: Number + AsPrimitive<X>,
    X: Number,
{
    backward_rows(factor.rows(), n, x.as_mut_slice());
}

/// One row of a triangle: its diagonal element, and the elements before it.
fn row<E>(rows: &[E], i: usize) -> Option<(&E, &[E])> {
    rows.get(row_start(i)..)?.get(..=i)?.split_last()
}

#[inline(never)]
fn factor_rows<E>(rows: &mut [E], n: usize) -> bool
where
    E: Number + AsPrimitive<Real>,
    Real: AsPrimitive<E>,
{
    (0..n).all(|i| factor_row(rows, i).is_some())
}

/// Replaces row `i` by that of the factor. The rows above must have been replaced before. Returns
/// `None` if the matrix is not positive definite.
fn factor_row<E>(rows: &mut [E], i: usize) -> Option<()>
where
    E: Number + AsPrimitive<Real>,
    Real: AsPrimitive<E>,
{
    let (above, own) = rows.split_at_mut_checked(row_start(i))?;
    for j in 0..i {
        let (known, rest) = own.split_at_mut_checked(j)?;
        let (diagonal, other) = row(above, j)?;
        let element = rest.first_mut()?;
        *element = (reduced(*element, known, other) * diagonal.as_()).as_();
    }
    let (known, rest) = own.split_at_mut_checked(i)?;
    let element = rest.first_mut()?;
    let pivot = reduced(*element, known, known);
    if !(pivot > 0.0 && pivot.is_finite()) {
        return None;
    }
    *element = (1.0 / math::sqrt(pivot)).as_();
    Some(())
}

/// `a − Σ x_k y_k`.
fn reduced<E: Number + AsPrimitive<Real>>(a: E, x: &[E], y: &[E]) -> Real {
    let products = x.iter().zip(y).map(|(&x, &y)| real(x) * real(y));
    products.fold(a.as_(), |rest, product| rest - product)
}

#[inline(never)]
fn forward_rows<E: Number + AsPrimitive<X>, X: Number>(rows: &[E], n: usize, x: &mut [X]) {
    for i in 0..n {
        let parts = x.split_at_mut_checked(i).zip(row(rows, i));
        let Some(((known, [own, ..]), (diagonal, row))) = parts else {
            return;
        };
        for (&element, &known) in row.iter().zip(&*known) {
            *own -= element.as_() * known;
        }
        *own *= diagonal.as_();
    }
}

#[inline(never)]
fn backward_rows<E: Number + AsPrimitive<X>, X: Number>(rows: &[E], n: usize, x: &mut [X]) {
    for i in (0..n).rev() {
        let parts = x.split_at_mut_checked(i).zip(row(rows, i));
        let Some(((unknown, [own, ..]), (diagonal, row))) = parts else {
            continue;
        };
        *own *= diagonal.as_();
        for (&element, unknown) in row.iter().zip(unknown) {
            *unknown -= element.as_() * *own;
        }
    }
}

#[cfg(test)]
mod tests;
