//! Vectors and triangles whose indices cannot panic.
//!
//! nalgebra stores the numbers and computes with whole vectors: sums, products and norms. Its own index
//! panics beyond the end, and code that may panic adds messages and a panic handler to the firmware.
//! Here, an element beyond the end reads as zero, and a number that is put there is dropped. Debug
//! assertions report both.

use crate::numerics::real::Real;
use core::ops::{Deref, Index};
use nalgebra::{ArrayStorage, RealField, SMatrix, SVector};

/// An element of a vector or a triangle: single or double precision.
pub(crate) trait Number: RealField + Copy {
    /// The element beyond the end.
    const ZERO: &'static Self;
}

impl Number for f64 {
    const ZERO: &'static Self = &0.0;
}

impl Number for f32 {
    const ZERO: &'static Self = &0.0;
}

/// A column of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<const N: usize, E = Real>(SVector<E, N>);

impl<const N: usize, E: Number> Vector<N, E> {
    /// Zeros: a constant, so that they are set where they stay and not moved there.
    pub(crate) const ZEROS: Self = Self(SVector::from_array_storage(ArrayStorage(
        [[*E::ZERO; N]; 1],
    )));

    pub(crate) fn zeros() -> Self {
        Self::ZEROS
    }

    pub(crate) fn from_fn(mut element: impl FnMut(usize) -> E) -> Self {
        Self(SVector::from_fn(|i, _| element(i)))
    }

    /// Sets one element.
    pub(crate) fn put(&mut self, i: usize, value: E) {
        debug_assert!(i < N);
        if let Some(slot) = self.0.get_mut(i) {
            *slot = value;
        }
    }

    pub(crate) fn as_mut_slice(&mut self) -> &mut [E] {
        self.0.as_mut_slice()
    }
}

impl<const N: usize, E: Number> Index<usize> for Vector<N, E> {
    type Output = E;

    fn index(&self, i: usize) -> &E {
        debug_assert!(i < N);
        self.0.get(i).unwrap_or(E::ZERO)
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

/// The lower triangle of a symmetric matrix, or its Cholesky factor. The rows lie one behind the other,
/// each from its first element to the diagonal, in the storage of an `A` by `B` matrix.
///
/// `n` rows need `n (n + 1)/2` places. A constant, even `n` has `A = n + 1` and `B = n/2`. A generic
/// `n` has `A = B = n`, because a generic constant cannot be computed from another one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle<const A: usize, const B: usize, E = Real>(SMatrix<E, A, B>);

impl<const A: usize, const B: usize, E: Number> Triangle<A, B, E> {
    /// Zeros: a constant, so that they are set where they stay and not moved there.
    pub(crate) const ZEROS: Self = Self(SMatrix::from_array_storage(ArrayStorage(
        [[*E::ZERO; A]; B],
    )));

    #[cfg(test)]
    pub(crate) fn zeros() -> Self {
        Self::ZEROS
    }

    const fn place((i, j): (usize, usize)) -> usize {
        let (row, column) = if i < j { (j, i) } else { (i, j) };
        row_start(row).saturating_add(column)
    }

    /// Sets one element.
    pub(crate) fn put(&mut self, at: (usize, usize), value: E) {
        let slot = self.0.get_mut(Self::place(at));
        debug_assert!(slot.is_some());
        if let Some(slot) = slot {
            *slot = value;
        }
    }

    /// All rows, one behind the other.
    pub(crate) fn rows(&self) -> &[E] {
        self.0.as_slice()
    }

    pub(crate) fn rows_mut(&mut self) -> &mut [E] {
        self.0.as_mut_slice()
    }
}

impl<const A: usize, const B: usize, E: Number> Index<(usize, usize)> for Triangle<A, B, E> {
    type Output = E;

    fn index(&self, at: (usize, usize)) -> &E {
        let element = self.0.get(Self::place(at));
        debug_assert!(element.is_some());
        element.unwrap_or(E::ZERO)
    }
}

/// The place of a row's first element among the rows of a triangle.
pub(crate) const fn row_start(row: usize) -> usize {
    row.saturating_mul(row.saturating_add(1)) / 2
}

/// A choice among unknowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Choice(u16);

impl Choice {
    /// No unknown.
    pub(crate) const NONE: Self = Self(0);

    /// The choice of all unknowns for which `chosen` is true.
    pub(crate) fn of(chosen: impl Fn(usize) -> bool) -> Self {
        let mut choice = Self::default();
        for i in 0..u16::BITS as usize {
            if chosen(i) {
                choice.add(i);
            }
        }
        choice
    }

    /// The choice in which unknown `i` is chosen if bit `i` is set.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The choice as bits: bit `i` is set if unknown `i` is chosen.
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

    /// The choice with unknown `i` added.
    #[must_use]
    pub(crate) const fn with(self, i: usize) -> Self {
        Self(self.0 | Self::bit(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::test_random::Random;

    #[test]
    fn a_triangle_has_an_element_of_its_own_for_every_pair() {
        let mut triangle = Triangle::<8, 3>::zeros();
        let number = |i: usize, j: usize| (10 * i.max(j) + i.min(j) + 1) as Real;
        for i in 0..6 {
            for j in 0..=i {
                assert_eq!(triangle[(i, j)], 0.0, "{i}, {j} is the place of another");
                triangle.put((i, j), number(i, j));
            }
        }
        for i in 0..6 {
            for j in 0..6 {
                assert_eq!(triangle[(i, j)], number(i, j));
            }
            let row = &triangle.rows()[row_start(i)..=row_start(i) + i];
            assert!(row.iter().zip(0..).all(|(&x, j)| x == number(i, j)));
        }
        // The 21 elements leave the last of the 24 places empty.
        assert!(triangle.rows()[21..].iter().all(|&x| x == 0.0));
    }

    #[test]
    fn a_vector_returns_the_elements_that_were_put() {
        let mut vector = Vector::<5>::from_fn(|i| i as Real);
        vector.put(3, -7.0);
        assert_eq!(
            [0, 1, 2, 3, 4].map(|i| vector[i]),
            [0.0, 1.0, 2.0, -7.0, 4.0]
        );
    }

    #[test]
    #[cfg_attr(debug_assertions, should_panic)]
    fn putting_beyond_the_end_panics_in_debug_builds_and_is_ignored_in_others() {
        let mut vector = Vector::<2>::zeros();
        vector.put(2, 1.0);
        assert_eq!([vector[0], vector[1], vector[2]], [0.0; 3]);
    }

    #[test]
    fn a_choice_contains_what_was_added_until_it_is_dropped() {
        let mut random = Random::new(41);
        for _ in 0..100 {
            let (mut choice, mut expected) = (Choice::default(), [false; 16]);
            for _ in 0..30 {
                let i = random.below(16);
                expected[i] = match random.below(3) {
                    0 => {
                        choice.drop(i);
                        false
                    }
                    1 => {
                        choice.add(i);
                        true
                    }
                    _ => {
                        choice = choice.with(i);
                        true
                    }
                };
                assert!((0..16).all(|i| choice.has(i) == expected[i]));
            }
            assert_eq!(Choice::of(|i| expected[i]), choice);
        }
        let mut none = Choice::default();
        none.add(16);
        assert_eq!(none, Choice::default(), "there are sixteen places");
    }
}
