//! An exact sum of squares, wide enough for every record.

/// An exact sum of squared differences. Its 158 bits are kept in digits of 63, 63 and 32 bits, so that
/// a carry shows as a sign.
///
/// A cluster of `m ≤ 2^29` counts differs from its neighbour by less than `m · 2^32`, so one square is
/// below `m² · 2^64`. At quarter overlap, `n` samples give `4n/m` differences, whose squares add up to
/// less than `n · m · 2^66`. With `n < 2^63`, this is below `2^158`: no input can overflow the sum for
/// as long as the sample counter itself lasts. The sum of a gyro at rest stays within the lowest digit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SquareSum {
    low: u64,
    middle: u64,
    high: u32,
}

/// The largest value of a digit of 63 bits.
const DIGIT: u64 = u64::MAX >> 1;

impl SquareSum {
    /// The sum of no squares.
    pub const ZERO: Self = Self {
        low: 0,
        middle: 0,
        high: 0,
    };

    /// Adds `difference²`. The difference must lie within ±2^62.
    #[inline(always)]
    pub(crate) fn add_square(&mut self, difference: i64) {
        // The difference is upper · 2^32 + lower, with both parts signed.
        let lower = difference as i32;
        let upper = ((difference >> 32) as i32).wrapping_add(i32::from(lower < 0));
        if upper == 0 {
            // A gyro at rest takes this path, with one multiplication and one digit.
            self.add_low(product(lower, lower) as u64);
        } else {
            self.add_wide(lower, upper);
        }
    }

    /// Adds the square of `upper · 2^32 + lower`. Apart, so that a push does not hold it once for each octave.
    #[cold]
    #[inline(never)]
    fn add_wide(&mut self, lower: i32, upper: i32) {
        // The square is split into a digit of 64 bits and the one above it.
        let square = product(lower, lower) as u64;
        let cross = sum_signed(product(lower, upper.wrapping_mul(2)), (square >> 32) as i64);
        let sum_low = square & 0xFFFF_FFFF | (cross as u64) << 32;
        let sum_high = sum_signed(product(upper, upper), cross >> 32) as u64;
        let low = sum(self.low, sum_low & DIGIT);
        let carried = sum(sum_high << 1 | sum_low >> 63, low >> 63);
        let middle = sum(self.middle, carried);
        self.low = low & DIGIT;
        self.middle = middle & DIGIT;
        self.high = self.high.wrapping_add((middle >> 63) as u32);
    }

    /// Adds a sum of squares of at most 2^63.
    #[inline(always)]
    pub(crate) fn add_low(&mut self, squares: u64) {
        let low = sum(self.low, squares);
        if low > DIGIT {
            self.carry(low);
        } else {
            self.low = low;
        }
    }

    #[cold]
    #[inline(never)]
    fn carry(&mut self, low: u64) {
        self.low = low & DIGIT;
        let middle = sum(self.middle, 1);
        self.middle = middle & DIGIT;
        self.high = self.high.wrapping_add((middle >> 63) as u32);
    }

    /// Adds another sum of squares.
    pub(crate) fn add_sum(&mut self, other: &Self) {
        let low = sum(self.low, other.low);
        let middle = sum(sum(self.middle, other.middle), low >> 63);
        self.low = low & DIGIT;
        self.middle = middle & DIGIT;
        // If sums are merged without end, this wraps before the sample counter stops being credible.
        self.high = self
            .high
            .wrapping_add(other.high)
            .wrapping_add((middle >> 63) as u32);
    }

    /// The sum in three limbs of 64 bits, least significant first.
    pub const fn limbs(&self) -> [u64; 3] {
        let high = self.high as u64;
        [
            self.low | self.middle << 63,
            self.middle >> 1 | high << 62,
            high >> 2,
        ]
    }

    /// The sum that has these limbs. `None` from 2^158 on, which no sum reaches.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_limbs([low, middle, high]: [u64; 3]) -> Option<Self> {
        if high >> 30 != 0 {
            return None;
        }
        Some(Self {
            low: low & DIGIT,
            middle: (low >> 63 | middle << 1) & DIGIT,
            high: (middle >> 62 | high << 2) as u32,
        })
    }

    /// The sum as one integer. `None` above 128 bits, which only full-scale input that lasts for days
    /// can reach.
    pub fn to_u128(&self) -> Option<u128> {
        let [low, middle, high] = self.limbs();
        (high == 0).then(|| u128::from(middle) << 64 | u128::from(low))
    }
}

impl From<u128> for SquareSum {
    fn from(value: u128) -> Self {
        Self {
            low: value as u64 & DIGIT,
            middle: (value >> 63) as u64 & DIGIT,
            high: (value >> 126) as u32,
        }
    }
}

/// A sum that stays below 2^64, as the documentation of [`SquareSum`] proves. On a target it needs no
/// check of its own.
#[inline(always)]
const fn sum(a: u64, b: u64) -> u64 {
    debug_assert!(a.checked_add(b).is_some());
    a.wrapping_add(b)
}

/// A sum that stays within ±2^63.
#[inline(always)]
const fn sum_signed(a: i64, b: i64) -> i64 {
    debug_assert!(a.checked_add(b).is_some());
    a.wrapping_add(b)
}

/// An exact product, which takes one multiplication on a 32-bit core.
#[inline(always)]
fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}
