//! An exact sum of squares, wide enough for every record.

/// A sum of squared differences, exact: 192 bits in three limbs, least significant first.
///
/// A cluster of `m ≤ 2^29` counts differs from its neighbour by less than `m · 2^32`, so one
/// square is below `m² · 2^64`, and `n` samples at quarter overlap, `4n/m` differences, add up to
/// less than `n · m · 2^66`. With `n < 2^64` this is below `2^159`: no input can overflow the sum,
/// for as long as the sample counter itself lasts. A gyro at rest stays within the lowest limb.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SquareSum {
    limbs: [u64; 3],
}

impl SquareSum {
    /// Nothing summed yet.
    pub const ZERO: Self = Self { limbs: [0; 3] };

    /// Adds `difference²`.
    #[inline(always)]
    pub(crate) fn add_square(&mut self, difference: i64) {
        let magnitude = difference.unsigned_abs();
        if let Ok(small) = u32::try_from(magnitude) {
            // The path of a gyro at rest: one multiplication, one limb.
            let (low, carry) = self.limbs[0].overflowing_add(u64::from(small) * u64::from(small));
            self.limbs[0] = low;
            if carry {
                self.add_high(1);
            }
        } else {
            self.add(square(magnitude));
        }
    }

    #[inline(always)]
    fn add(&mut self, value: u128) {
        let (low, carry) = self.limbs[0].overflowing_add(value as u64);
        self.limbs[0] = low;
        // A square is below 2^124, so its upper half has room for the carry.
        self.add_high((value >> 64) as u64 + u64::from(carry));
    }

    #[inline(always)]
    fn add_high(&mut self, value: u64) {
        let (middle, carry) = self.limbs[1].overflowing_add(value);
        self.limbs[1] = middle;
        // Cannot wrap: see the bound in the type's documentation.
        self.limbs[2] = self.limbs[2].wrapping_add(u64::from(carry));
    }

    /// Adds another sum of squares.
    pub(crate) fn add_sum(&mut self, other: &Self) {
        let mut carry = false;
        for (limb, &more) in self.limbs.iter_mut().zip(&other.limbs) {
            let (sum, first) = limb.overflowing_add(more);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            *limb = sum;
            carry = first || second;
        }
    }

    /// The sum in three limbs of 64 bits, least significant first.
    pub const fn limbs(&self) -> [u64; 3] {
        self.limbs
    }

    /// The sum as one integer, or `None` above 128 bits, which only full-scale input kept up for
    /// days can reach.
    pub fn to_u128(&self) -> Option<u128> {
        (self.limbs[2] == 0).then(|| u128::from(self.limbs[1]) << 64 | u128::from(self.limbs[0]))
    }

    /// The sum, rounded to within one unit in the last place.
    pub fn to_f64(&self) -> f64 {
        const LIMB: f64 = 18_446_744_073_709_551_616.0; // 2^64
        (self.limbs[2] as f64 * LIMB + self.limbs[1] as f64) * LIMB + self.limbs[0] as f64
    }
}

impl From<u128> for SquareSum {
    fn from(value: u128) -> Self {
        Self {
            limbs: [value as u64, (value >> 64) as u64, 0],
        }
    }
}

/// `magnitude²` by three 32-bit multiplications: a general 128-bit product costs twice as much on
/// a 32-bit core.
#[inline(always)]
fn square(magnitude: u64) -> u128 {
    let low = magnitude & 0xFFFF_FFFF;
    let high = magnitude >> 32;
    // |difference| < 2^62, so high < 2^30 and twice the cross product fits 64 bits.
    let cross = 2 * high * low;
    (u128::from(high * high) << 64) + (u128::from(cross) << 32) + u128::from(low * low)
}
