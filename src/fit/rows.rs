//! Numbers of the octaves and bins that a fit works on.

use crate::numerics::{
    algebra::{Number, Vector},
    real::Real,
};
use core::ops::Index;

/// One number for every octave of a curve and for every bin of a density. Row `k` below `K` belongs to octave
/// `k`, and row `K + b` to bin `b`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<const K: usize, const B: usize, E = Real> {
    pub(super) octaves: Vector<K, E>,
    pub(super) bins: Vector<B, E>,
}

impl<const K: usize, const B: usize, E: Number> Rows<K, B, E> {
    /// Zeros: a constant, so that they are set where they stay and not moved there.
    pub(crate) const ZEROS: Self = Self {
        octaves: Vector::ZEROS,
        bins: Vector::ZEROS,
    };

    /// The numbers of some rows; zero in all others.
    pub(crate) fn of(rows: impl Iterator<Item = usize>, number: impl Fn(usize) -> E) -> Self {
        let mut all = Self::ZEROS;
        for row in rows {
            all.put(row, number(row));
        }
        all
    }

    /// Sets the number of one row.
    pub(crate) fn put(&mut self, row: usize, value: E) {
        match row.checked_sub(K) {
            None => self.octaves.put(row, value),
            Some(bin) => self.bins.put(bin, value),
        }
    }

    /// The same rows with other numbers.
    pub(crate) fn map<F: Number>(&self, mut other: impl FnMut(E) -> F) -> Rows<K, B, F> {
        Rows {
            octaves: self.octaves.map(&mut other).into(),
            bins: self.bins.map(&mut other).into(),
        }
    }

    /// The sum of the products of rows.
    pub(crate) fn dot(&self, other: &Self) -> E {
        self.octaves.dot(&other.octaves) + self.bins.dot(&other.bins)
    }

    /// The sum of the squares of the rows.
    pub(crate) fn norm_squared(&self) -> E {
        self.octaves.norm_squared() + self.bins.norm_squared()
    }
}

impl<const K: usize, const B: usize> Rows<K, B> {
    /// The largest absolute value.
    pub(crate) fn amax(&self) -> Real {
        if B == 0 {
            return self.octaves.amax();
        }
        self.octaves.amax().max(self.bins.amax())
    }
}

impl<const K: usize, const B: usize, E: Number> Index<usize> for Rows<K, B, E> {
    type Output = E;

    fn index(&self, row: usize) -> &E {
        match row.checked_sub(K) {
            None => &self.octaves[row],
            Some(bin) => &self.bins[bin],
        }
    }
}
