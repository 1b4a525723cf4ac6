//! Geometric series, summed by doubling.

use nalgebra::Complex;

pub(super) const ONE: Complex<f32> = Complex::new(1.0, 0.0);
pub(super) const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// The sums of `n` terms of a series of two ratios `a` and `b`. The ratios lie within the unit circle or on it,
/// and enter as `1 − a` and `1 − b`, which keeps slow decays exact where single precision would round them
/// away.
///
/// Series of adjacent ranges are joined by multiplications alone, so that nothing is divided by a small
/// difference of two ratios.
#[derive(Clone, Copy)]
pub(super) struct Series {
    /// `n`.
    pub(super) count: f32,
    /// `1 − aⁿ`.
    pub(super) rest: Complex<f32>,
    /// `1 − bⁿ`.
    other_rest: Complex<f32>,
    /// `Σ aⁱ bⁿ⁻¹⁻ⁱ` over `0 ≤ i < n`.
    pub(super) sum: Complex<f32>,
    /// `Σ i aⁱ` if `b` is one, and no use otherwise.
    pub(super) moment: Complex<f32>,
}

impl Series {
    const EMPTY: Self = Self {
        count: 0.0,
        rest: ZERO,
        other_rest: ZERO,
        sum: ZERO,
        moment: ZERO,
    };

    /// The first term alone.
    pub(super) const fn first(rest: Complex<f32>, other_rest: Complex<f32>) -> Self {
        Self {
            count: 1.0,
            rest,
            other_rest,
            sum: ONE,
            moment: ZERO,
        }
    }

    /// The terms of this series followed by as many as the next one has.
    pub(super) fn then(&self, next: &Self) -> Self {
        let power = ONE - self.rest;
        Self {
            count: self.count + next.count,
            rest: joined(self.rest, next.rest),
            other_rest: joined(self.other_rest, next.other_rest),
            sum: self.sum * (ONE - next.other_rest) + power * next.sum,
            moment: self.moment + power * (next.moment + next.sum * self.count),
        }
    }

    /// The first `count` terms.
    pub(super) fn of(rest: Complex<f32>, other_rest: Complex<f32>, count: u32) -> Self {
        let (mut sum, mut next) = (Self::EMPTY, Self::first(rest, other_rest));
        let mut left = count;
        while left > 0 {
            if left & 1 == 1 {
                sum = sum.then(&next);
            }
            left >>= 1;
            if left > 0 {
                next = next.then(&next);
            }
        }
        sum
    }
}

/// `1 − ab` for `1 − a` and `1 − b`.
pub(super) fn joined(a: Complex<f32>, b: Complex<f32>) -> Complex<f32> {
    a + b - a * b
}
