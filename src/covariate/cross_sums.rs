//! The sums of products that a gyro shares with a covariate.

use crate::{octave::Accumulator, real::Real};

/// Σ D_g D_x of every octave: 24 bytes an octave.
///
/// The accumulators of the gyro and of the covariate run through one schedule, so that the differences of
/// an octave are there at the same sample and can be multiplied. The sums are exact: the product of two
/// differences within ±2^62 fits 124 bits, and fewer than 2^63 of them fit 187.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CrossSums<const OCTAVES: usize> {
    sums: [ProductSum; OCTAVES],
}

/// A signed sum: `low + 2^64 upper`, where `low` is signed as well, so that a carry happens when it
/// overflows and at no other time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ProductSum {
    low: i64,
    /// The upper 128 bits, lower half first.
    upper: [u64; 2],
}

impl ProductSum {
    const ZERO: Self = Self {
        low: 0,
        upper: [0; 2],
    };

    #[inline(always)]
    fn add_product(&mut self, one: i64, other: i64) {
        let (short, other_short) = (one as i32, other as i32);
        // The path of a gyro at rest: one multiplication, one limb.
        if is_short(one) && is_short(other) {
            let product = i64::from(short) * i64::from(other_short);
            if let Some(low) = self.low.checked_add(product) {
                self.low = low;
                return;
            }
        }
        self.add_long(i128::from(one) * i128::from(other));
    }

    #[cold]
    #[inline(never)]
    fn add_long(&mut self, product: i128) {
        let low = product as i64;
        // What the signed lower limb leaves.
        self.add(low, product.wrapping_sub(i128::from(low)) >> 64);
    }

    fn add(&mut self, low: i64, upper: i128) {
        let (sum, overflows) = self.low.overflowing_add(low);
        let carry = match (overflows, low < 0) {
            (false, _) => 0,
            (true, true) => -1,
            (true, false) => 1,
        };
        self.low = sum;
        let all = self.upper().wrapping_add(upper).wrapping_add(carry);
        self.upper = [all as u64, (all >> 64) as u64];
    }

    const fn upper(&self) -> i128 {
        let [low, high] = self.upper;
        (low as u128 | (high as u128) << 64) as i128
    }

    pub(crate) fn to_real(self) -> Real {
        const LIMB: Real = 18_446_744_073_709_551_616.0; // 2^64
        self.upper() as Real * LIMB + self.low as Real
    }

    /// The lower limb, and what is above it.
    #[cfg(feature = "storage")]
    pub(crate) const fn parts(&self) -> (i64, i128) {
        (self.low, self.upper())
    }

    /// The sum of these parts.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_parts(low: i64, upper: i128) -> Self {
        Self {
            low,
            upper: [upper as u64, (upper >> 64) as u64],
        }
    }
}

/// Whether a number fits 32 bits: in this form the compiler multiplies what is short as such.
#[inline(always)]
const fn is_short(x: i64) -> bool {
    (x >> 32) as i32 == (x as i32) >> 31
}

impl<const OCTAVES: usize> CrossSums<OCTAVES> {
    /// Nothing summed yet.
    pub(crate) const NEW: Self = Self {
        sums: [ProductSum::ZERO; OCTAVES],
    };

    /// Adds the product of the differences that both completed in an octave.
    #[inline(always)]
    pub(crate) fn add(&mut self, octave: usize, gyro: i64, covariate: i64) {
        if let Some(sum) = self.sums.get_mut(octave) {
            sum.add_product(gyro, covariate);
        }
    }

    /// Adds the sums of another record.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            own.add(other.low, other.upper());
        }
    }

    /// The sum of octave `k` as of now, with the product that both still have pending.
    pub(crate) fn read(
        &self,
        k: usize,
        gyro: &Accumulator<OCTAVES>,
        covariate: &Accumulator<OCTAVES>,
    ) -> ProductSum {
        let mut sum = self.sums.get(k).copied().unwrap_or(ProductSum::ZERO);
        let pending = (gyro.pending_difference(k), covariate.pending_difference(k));
        if let (Some(gyro), Some(covariate)) = pending {
            sum.add_product(gyro, covariate);
        }
        sum
    }

    /// The sums, to be restored.
    #[cfg(feature = "storage")]
    pub(crate) fn sums_mut(&mut self) -> &mut [ProductSum; OCTAVES] {
        &mut self.sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_either_sign_are_exact_however_large() {
        let factors = [
            (3, -5),
            (i64::from(i32::MAX), i64::from(i32::MAX)),
            (-(1 << 62), 1 << 62),
            (i64::from(i32::MIN), i64::from(i32::MIN)),
            (-(1 << 40), -(1 << 62)),
            (1 << 40, -(1 << 23) + 1),
        ];
        let (mut sum, mut low, mut expected) = (ProductSum::ZERO, ProductSum::ZERO, 0_i128);
        for _ in 0..5 {
            for (one, other) in factors {
                sum.add_product(one, other);
                expected += i128::from(one) * i128::from(other);
                assert_eq!((sum.upper() << 64) + i128::from(sum.low), expected);
            }
            low.add_product(-1, 1 << 30);
            low.add_product(1 << 30, 1);
        }
        assert_eq!(low, ProductSum::ZERO);
    }
}
