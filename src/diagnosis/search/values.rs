//! One number for every row of a search.

use crate::numerics::algebra::Vector;
use core::ops::Index;

/// The largest number of rows below the bins.
pub(crate) const LOW: usize = 56;

/// One number for every row: row `k` below [`LOW`] is a cosine coefficient or an octave, and row `LOW + b` is bin `b`. All
/// of them are relative to what was measured, so that single precision is enough.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values<const B: usize> {
    low: Vector<LOW, f32>,
    bins: Vector<B, f32>,
    /// The number of rows below the bins that are used, so that no work is done on the others.
    lows: usize,
}

impl<const B: usize> Values<B> {
    /// No rows below the bins, and zeros in these.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NONE: Self = Self {
        low: Vector::ZEROS,
        bins: Vector::ZEROS,
        lows: 0,
    };

    /// Zeros, in so many rows below the bins.
    pub(crate) const fn zeros(lows: usize) -> Self {
        Self {
            lows: if lows < LOW { lows } else { LOW },
            ..Self::NONE
        }
    }

    /// The same number in every row.
    pub(crate) fn constant(lows: usize, number: f32) -> Self {
        let mut all = Self::zeros(lows);
        all.low.as_mut_slice().fill(number);
        all.bins.as_mut_slice().fill(number);
        all
    }

    /// The number of rows below the bins that are used.
    pub(crate) const fn lows(&self) -> usize {
        self.lows
    }

    fn low(&self) -> &[f32] {
        self.low.as_slice().get(..self.lows).unwrap_or_default()
    }

    fn low_mut(&mut self) -> &mut [f32] {
        let used = self.low.as_mut_slice().get_mut(..self.lows);
        used.unwrap_or_default()
    }

    /// Sets the number of one row.
    pub(crate) fn put(&mut self, row: usize, value: f32) {
        match row.checked_sub(LOW) {
            None => self.low.put(row, value),
            Some(bin) => self.bins.put(bin, value),
        }
    }

    /// Changes every number by those of other rows.
    pub(crate) fn change_by(&mut self, other: &Self, change: impl Fn(f32, f32) -> f32) {
        let work = |own: &mut [f32], other: &[f32]| {
            for (own, &other) in own.iter_mut().zip(other) {
                *own = change(*own, other);
            }
        };
        work(self.low_mut(), other.low());
        work(self.bins.as_mut_slice(), other.bins.as_slice());
    }

    /// Adds a multiple of other rows.
    pub(crate) fn add_scaled(&mut self, other: &Self, factor: f32) {
        self.change_by(other, |own, other| own + other * factor);
    }

    /// Hands the numbers of three rows to `each`, row by row.
    pub(crate) fn each_with(
        &self,
        second: &Self,
        third: &Self,
        mut each: impl FnMut(f32, f32, f32),
    ) {
        let mut work = |first: &[f32], second: &[f32], third: &[f32]| {
            for ((&first, &second), &third) in first.iter().zip(second).zip(third) {
                each(first, second, third);
            }
        };
        work(self.low(), second.low(), third.low());
        work(
            self.bins.as_slice(),
            second.bins.as_slice(),
            third.bins.as_slice(),
        );
    }

    /// The sum of the products of rows.
    pub(crate) fn dot(&self, other: &Self) -> f32 {
        let low = self.low().iter().zip(other.low());
        let low: f32 = low.map(|(own, other)| own * other).sum();
        low + self.bins.dot(&other.bins)
    }
}

impl<const B: usize> Index<usize> for Values<B> {
    type Output = f32;

    fn index(&self, row: usize) -> &f32 {
        match row.checked_sub(LOW) {
            None => &self.low[row],
            Some(bin) => &self.bins[bin],
        }
    }
}
