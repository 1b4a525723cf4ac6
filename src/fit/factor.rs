//! The Cholesky factor of the covariance of octaves and bins.

use super::rows::Rows;
use crate::{
    numerics::{
        algebra::{Number, Triangle, Vector},
        cholesky, math,
        real::{Real, real, single},
    },
    spectrum::BAND,
};
use num_traits::AsPrimitive;

/// The covariance of a curve and of a density, or its Cholesky factor. Octaves and bins are independent of each
/// other, so that each has a factor of its own: a triangle for the octaves, a band for the bins. Single precision
/// is enough, because the covariance itself is no more precise.
pub(super) struct Factor<const K: usize, const B: usize> {
    octaves: Triangle<K, K, f32>,
    /// The diagonal of the bins, whose reciprocal the factor has, and the diagonals below it: element `d` of bin
    /// `b` belongs to the bins `b` and `b − d`.
    bins: [Vector<B, f32>; BAND],
}

impl<const K: usize, const B: usize> Factor<K, B> {
    /// Zeros: a constant, so that they are set where they stay and not moved there.
    pub(super) const ZEROS: Self = Self {
        octaves: Triangle::ZEROS,
        bins: [Vector::ZEROS; BAND],
    };

    /// Sets the covariance of two octaves.
    pub(super) fn put_octaves(&mut self, at: (usize, usize), value: f32) {
        self.octaves.put(at, value);
    }

    /// Sets the covariance of bin `b` and the bin `d` places before it.
    pub(super) fn put_bins(&mut self, b: usize, d: usize, value: f32) {
        if let Some(diagonal) = self.bins.get_mut(d) {
            diagonal.put(b, value);
        }
    }

    /// The diagonal element of a row: the reciprocal of that of the factor.
    pub(super) fn diagonal(&self, row: usize) -> f32 {
        match row.checked_sub(K) {
            None => self.octaves[(row, row)],
            Some(bin) => self.bins[0][bin],
        }
    }

    /// Replaces the covariance of the first `octaves` and `bins` by its factor. Returns `false` if it is not
    /// positive definite.
    pub(super) fn factor(&mut self, octaves: usize, bins: usize) -> bool {
        cholesky::factor(&mut self.octaves, octaves) && (B == 0 || self.factor_bins(bins))
    }

    fn factor_bins(&mut self, count: usize) -> bool {
        let [diagonal, first, second] = &mut self.bins;
        for b in 0..count {
            let before = |d: usize| b.checked_sub(d);
            let mut two = 0.0;
            if let Some(at) = before(2) {
                two = second[b] * diagonal[at];
                second.put(b, two);
            }
            let mut one = 0.0;
            if let Some(at) = before(1) {
                one = (first[b] - two * first[at]) * diagonal[at];
                first.put(b, one);
            }
            let pivot = diagonal[b] - one * one - two * two;
            if !(pivot > 0.0 && pivot.is_finite()) {
                return false;
            }
            diagonal.put(b, single(1.0 / math::sqrt(real(pivot))));
        }
        true
    }

    /// Solves `L x = b` in place.
    pub(super) fn forward<X>(&self, octaves: usize, bins: usize, x: &mut Rows<K, B, X>)
    where
        X: Number,
        f32: AsPrimitive<X>,
    {
        cholesky::forward(&self.octaves, octaves, &mut x.octaves);
        if B == 0 {
            return;
        }
        let [diagonal, first, second] = &self.bins;
        let (mut one, mut two) = (*X::ZERO, *X::ZERO);
        for b in 0..bins {
            let own = x.bins[b] - first[b].as_() * one - second[b].as_() * two;
            (one, two) = (own * diagonal[b].as_(), one);
            x.bins.put(b, one);
        }
    }

    /// Solves `L'x = b` in place.
    pub(super) fn backward(&self, octaves: usize, bins: usize, x: &mut Rows<K, B>) {
        cholesky::backward(&self.octaves, octaves, &mut x.octaves);
        if B == 0 {
            return;
        }
        let [diagonal, first, second] = &self.bins;
        for b in (0..bins).rev() {
            let (next, after) = (b.saturating_add(1), b.saturating_add(2));
            let mut own = x.bins[b];
            if next < bins {
                own -= real(first[next]) * x.bins[next];
            }
            if after < bins {
                own -= real(second[after]) * x.bins[after];
            }
            x.bins.put(b, own * real(diagonal[b]));
        }
    }

    /// The product `L'x`.
    #[cfg(test)]
    pub(super) fn transposed_times(
        &self,
        octaves: usize,
        bins: usize,
        x: &Rows<K, B>,
    ) -> Rows<K, B> {
        let mut product: Rows<K, B> = Rows::ZEROS;
        for j in 0..octaves.min(K) {
            let below = j.saturating_add(1)..octaves.min(K);
            let below = below.map(|k| real(self.octaves[(k, j)]) * x.octaves[k]);
            let own = x.octaves[j] / real(self.octaves[(j, j)]);
            product.octaves.put(j, own + below.sum::<Real>());
        }
        let [diagonal, first, second] = &self.bins;
        for b in 0..bins.min(B) {
            let mut sum = x.bins[b] / real(diagonal[b]);
            let (next, after) = (b.saturating_add(1), b.saturating_add(2));
            if next < bins {
                sum += real(first[next]) * x.bins[next];
            }
            if after < bins {
                sum += real(second[after]) * x.bins[after];
            }
            product.bins.put(b, sum);
        }
        product
    }

    /// The root of a row's element on the diagonal of the covariance that was factored.
    pub(super) fn standard_error(&self, row: usize) -> Real {
        let pivot = 1.0 / real(self.diagonal(row));
        let before: Real = match row.checked_sub(K) {
            None => (0..row).map(|j| square(self.octaves[(row, j)])).sum(),
            Some(bin) => square(self.bins[1][bin]) + square(self.bins[2][bin]),
        };
        math::sqrt(before + pivot * pivot)
    }
}

fn square(x: f32) -> Real {
    real(x) * real(x)
}

#[cfg(test)]
mod tests;
