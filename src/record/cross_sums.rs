//! The sums of products of a gyro's and a covariate's differences.

use super::octave::Accumulator;

/// The sum Σ D_g D_x of every octave, which takes 24 bytes per octave.
///
/// The accumulators of the gyro and of the covariate follow one schedule. So both complete the
/// differences of an octave at the same sample, and the two can be multiplied. The sums are exact: the
/// product of two differences within ±2^62 fits in 124 bits, and fewer than 2^63 of them fit in 187.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CrossSums<const OCTAVES: usize> {
    sums: [ProductSum; OCTAVES],
}

/// A signed sum, `low + 2^64 upper`. `low` is signed as well, so that there is a carry only when it
/// overflows.
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
        // A gyro at rest takes this path, with one multiplication and one limb.
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
        // This is what the signed lower limb leaves to the upper limbs.
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

    /// The number formed by the limbs above the lowest.
    pub(crate) const fn upper(&self) -> i128 {
        let [low, high] = self.upper;
        (low as u128 | (high as u128) << 64) as i128
    }

    /// The lower limb, and the number formed by the limbs above it.
    pub(crate) const fn parts(&self) -> (i64, i128) {
        (self.low, self.upper())
    }

    /// The sum that has these parts.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_parts(low: i64, upper: i128) -> Self {
        Self {
            low,
            upper: [upper as u64, (upper >> 64) as u64],
        }
    }
}

/// Whether a number fits in 32 bits. In this form, the compiler multiplies short numbers as such.
#[inline(always)]
const fn is_short(x: i64) -> bool {
    (x >> 32) as i32 == (x as i32) >> 31
}

impl<const OCTAVES: usize> CrossSums<OCTAVES> {
    /// Sums of no product yet.
    pub(crate) const NEW: Self = Self {
        sums: [ProductSum::ZERO; OCTAVES],
    };

    /// Adds the product of the two differences that were completed in an octave.
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

    /// The present sum of octave `k`. It includes the product of the differences that are still pending
    /// in both.
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

    /// The sums, for a snapshot that restores them.
    #[cfg(feature = "storage")]
    pub(crate) fn sums_mut(&mut self) -> &mut [ProductSum; OCTAVES] {
        &mut self.sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_products_of_either_sign_are_exact() {
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
