//! Four transforms side by side.
//!
//! A processor of 64 bits usually computes with four numbers of single precision at once. The steps of one transform
//! are hard to arrange that way, but those of several transforms side by side are not. Every segment goes through the
//! same operations in the same order as alone, so that its powers are the same to the bit.

use super::{
    transform::{Number, Segment},
    window::{bins, is_possible},
};
use core::{
    array::from_fn,
    ops::{Add, Mul, Neg, Sub},
};

/// The number of segments that are transformed at once.
pub(super) const LANES: usize = 4;

/// The same place of several segments.
#[derive(Clone, Copy)]
#[repr(align(16))]
struct Lanes([f32; LANES]);

impl Add for Lanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul<f32> for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f32) -> Self {
        Self(self.0.map(|number| number * factor))
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(f32::neg))
    }
}

impl Number for Lanes {
    const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    fn squared(self) -> Self {
        Self(self.0.map(|number| number * number))
    }
}

/// Replaces the values of four segments of `P` blocks by the powers of their bins,
///
/// ```text
/// |8 Σ_j w_j y_j e^(−2πijk/P)|²,      w_j = ½ − ½ cos(2πj/P),  k = P/16 … P/2 − 1
/// ```
///
/// in the first `7P/16` places of each. The values may have any unit and any offset; the first block is best taken off
/// before they are rounded to floats. A [`SpectrumAccumulator`](super::SpectrumAccumulator) adds the same powers, to the bit,
/// segment by segment. What sums the segments of a record in another way, such as parts of it on several machines, starts
/// from them.
#[inline(never)]
pub fn segment_powers<const P: usize>(segments: &mut [[f32; P]; 4]) {
    const { assert!(is_possible(P)) };
    let segment = {
        let values = &*segments;
        Segment::<P, Lanes>::of_blocks(|j| Lanes(from_fn(|i| values[i][j % P])))
    };
    let mut powers = [Lanes::ZERO; P];
    segment.for_each_power(powers.iter_mut().take(bins(P)), |power, place| {
        *place = power;
    });
    for (j, power) in powers.iter().take(bins(P)).enumerate() {
        for (values, power) in segments.iter_mut().zip(power.0) {
            values[j % P] = power;
        }
    }
}
