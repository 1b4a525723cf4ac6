//! Several segments that are transformed at once.
//!
//! A processor of 64 bits usually computes with four numbers of single precision at once. The steps of one transform
//! are hard to arrange that way, but those of several transforms side by side are not. Every segment goes through the
//! same operations in the same order as alone, so that the sums are the same to the bit.

use super::{
    level::Level,
    transform::{Number, Segment},
    window::bins,
};
use core::{
    array::from_fn,
    ops::{Add, Mul, Neg, Sub},
};

/// The number of segments that are transformed at once.
const LANES: usize = 4;

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

/// Segments of any level that wait to be transformed together, in the order in which they were completed.
pub(super) struct Several<const P: usize> {
    values: [[f32; P]; LANES],
    levels: [usize; LANES],
    number: usize,
}

impl<const P: usize> Several<P> {
    pub(super) const fn new() -> Self {
        Self {
            values: [[0.0; P]; LANES],
            levels: [0; LANES],
            number: 0,
        }
    }

    /// Adds the segment of a level that ends before block `end`, for blocks of `2^block_bits` samples.
    pub(super) fn push(&mut self, levels: &mut [Level<P>], i: usize, block_bits: u32, end: u32) {
        let places = self.values.get_mut(self.number);
        if let (Some(values), Some(place), Some(level)) =
            (places, self.levels.get_mut(self.number), levels.get(i))
        {
            level.segment_values(end, block_bits, values);
            *place = i;
            self.number = self.number.wrapping_add(1);
        }
        if self.number >= LANES {
            self.transform(levels);
        }
    }

    /// Transforms as many segments as there are lanes.
    #[inline(never)]
    fn transform(&mut self, levels: &mut [Level<P>]) {
        let values = &self.values;
        let segment = Segment::<P, Lanes>::of_blocks(|j| Lanes(from_fn(|i| values[i][j % P])));
        let mut powers = [Lanes::ZERO; P];
        segment.for_each_power(powers.iter_mut().take(bins(P)), |power, place| {
            *place = power;
        });
        // The waiting values are not needed any more.
        for (j, power) in powers.iter().take(bins(P)).enumerate() {
            for (values, power) in self.values.iter_mut().zip(power.0) {
                values[j % P] = power;
            }
        }
        for (powers, &level) in self.values.iter().zip(&self.levels) {
            if let Some(level) = levels.get_mut(level) {
                level.add_powers(powers);
            }
        }
        self.number = 0;
    }

    /// Transforms the segments that still wait, one by one.
    pub(super) fn finish(&mut self, levels: &mut [Level<P>]) {
        for (values, &level) in self.values.iter().zip(&self.levels).take(self.number) {
            if let Some(level) = levels.get_mut(level) {
                level.add_values(values);
            }
        }
        self.number = 0;
    }
}
