//! Vectors and matrices that cannot be asked for too much.
//!
//! An index that may panic brings a way to panic into firmware, with its messages. Here, what lies beyond
//! the end is zero, and what is put there is dropped; debug assertions tell of either.

use crate::real::Real;
use core::ops::{Deref, Index};
use nalgebra::{RealField, SMatrix, SVector};

/// A number to index: single or double precision.
pub(crate) trait Number: RealField + Copy {
    /// What lies beyond the end.
    const NOTHING: &'static Self;
}

impl Number for f64 {
    const NOTHING: &'static Self = &0.0;
}

impl Number for f32 {
    const NOTHING: &'static Self = &0.0;
}

/// A column of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<const N: usize, E = Real>(SVector<E, N>);

impl<const N: usize, E: Number> Vector<N, E> {
    pub(crate) fn zeros() -> Self {
        Self(SVector::zeros())
    }

    pub(crate) fn from_fn(mut element: impl FnMut(usize) -> E) -> Self {
        Self(SVector::from_fn(|i, _| element(i)))
    }

    /// Puts a number in its place.
    pub(crate) fn put(&mut self, i: usize, value: E) {
        debug_assert!(i < N);
        if let Some(slot) = self.0.get_mut(i) {
            *slot = value;
        }
    }
}

impl<const N: usize, E: Number> Index<usize> for Vector<N, E> {
    type Output = E;

    fn index(&self, i: usize) -> &E {
        debug_assert!(i < N);
        self.0.get(i).unwrap_or(E::NOTHING)
    }
}

impl<const N: usize, E> Deref for Vector<N, E> {
    type Target = SVector<E, N>;

    fn deref(&self) -> &SVector<E, N> {
        &self.0
    }
}

impl<const N: usize, E> From<SVector<E, N>> for Vector<N, E> {
    fn from(vector: SVector<E, N>) -> Self {
        Self(vector)
    }
}

/// As many rows as columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Square<const N: usize, E = Real>(SMatrix<E, N, N>);

impl<const N: usize, E: Number> Square<N, E> {
    pub(crate) fn zeros() -> Self {
        Self(SMatrix::zeros())
    }

    /// Puts a number in its place.
    pub(crate) fn put(&mut self, at: (usize, usize), value: E) {
        debug_assert!(at.0 < N && at.1 < N);
        if let Some(slot) = self.0.get_mut(at) {
            *slot = value;
        }
    }
}

impl<const N: usize, E: Number> Index<(usize, usize)> for Square<N, E> {
    type Output = E;

    fn index(&self, at: (usize, usize)) -> &E {
        debug_assert!(at.0 < N && at.1 < N);
        self.0.get(at).unwrap_or(E::NOTHING)
    }
}

/// A symmetric matrix or its factor: what is on the diagonal and below, row by row, in `LENGTH` places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<const LENGTH: usize>([Real; LENGTH]);

impl<const LENGTH: usize> Triangle<LENGTH> {
    pub(crate) fn zeros() -> Self {
        Self([0.0; LENGTH])
    }

    const fn place(i: usize, j: usize) -> usize {
        let (row, column) = if i < j { (j, i) } else { (i, j) };
        (row.saturating_mul(row.saturating_add(1)) / 2).saturating_add(column)
    }
}

/// Elements by row and column.
pub(crate) trait Elements {
    type Element: Number;

    fn at(&self, i: usize, j: usize) -> Self::Element;

    fn put_at(&mut self, i: usize, j: usize, value: Self::Element);
}

impl<const LENGTH: usize> Elements for Triangle<LENGTH> {
    type Element = Real;

    fn at(&self, i: usize, j: usize) -> Real {
        let element = self.0.get(Self::place(i, j));
        debug_assert!(element.is_some());
        element.copied().unwrap_or(0.0)
    }

    fn put_at(&mut self, i: usize, j: usize, value: Real) {
        let slot = self.0.get_mut(Self::place(i, j));
        debug_assert!(slot.is_some());
        if let Some(slot) = slot {
            *slot = value;
        }
    }
}

impl<const N: usize, E: Number> Elements for Square<N, E> {
    type Element = E;

    fn at(&self, i: usize, j: usize) -> E {
        self[(i, j)]
    }

    fn put_at(&mut self, i: usize, j: usize, value: E) {
        self.put((i, j), value);
    }
}

/// A choice among unknowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Choice(u16);

impl Choice {
    /// Those for which `chosen` is true.
    pub(crate) fn of(chosen: impl Fn(usize) -> bool) -> Self {
        let mut choice = Self::default();
        for i in 0..u16::BITS as usize {
            if chosen(i) {
                choice.add(i);
            }
        }
        choice
    }

    /// Those of these bits.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// A bit for each.
    #[cfg(feature = "storage")]
    pub(crate) const fn bits(self) -> u16 {
        self.0
    }

    const fn bit(i: usize) -> u16 {
        if i < u16::BITS as usize { 1 << i } else { 0 }
    }

    pub(crate) const fn has(self, i: usize) -> bool {
        self.0 & Self::bit(i) != 0
    }

    pub(crate) const fn add(&mut self, i: usize) {
        self.0 |= Self::bit(i);
    }

    pub(crate) const fn drop(&mut self, i: usize) {
        self.0 &= !Self::bit(i);
    }

    /// And one more.
    #[must_use]
    pub(crate) const fn with(self, i: usize) -> Self {
        Self(self.0 | Self::bit(i))
    }
}
