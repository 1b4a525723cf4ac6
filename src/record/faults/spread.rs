//! The sums from which the mean and the variance of the values follow.

use super::steps::CHUNK;

/// Sums of the values, relative to the first one.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Spread {
    first: Option<i32>,
    sum: i64,
    squares: u128,
}

impl Spread {
    pub(super) const NEW: Self = Self {
        first: None,
        sum: 0,
        squares: 0,
    };

    #[inline(always)]
    pub(super) fn push(&mut self, count: i32) {
        let first = *self.first.get_or_insert(count);
        let value = i64::from(count).wrapping_sub(first.into());
        self.sum = self.sum.saturating_add(value);
        let size = value.unsigned_abs();
        match size.checked_mul(size) {
            Some(square) => self.squares = self.squares.saturating_add(square.into()),
            None => self.squares = u128::MAX,
        }
    }

    /// Adds the values of a chunk behind the first value.
    pub(super) fn push_chunk(&mut self, counts: &[i32; CHUNK]) {
        let first = *self.first.get_or_insert(counts[0]);
        // The sum of sizes and the halves of squares, each below 2^32, stay below 2^38.
        let (mut sum, mut lower, mut upper) = (0_i64, 0_u64, 0_u64);
        for &count in counts {
            sum = sum.wrapping_add(i64::from(count).wrapping_sub(first.into()));
            let size = u64::from(count.abs_diff(first));
            let square = size.wrapping_mul(size);
            lower = lower.wrapping_add(square & 0xFFFF_FFFF);
            upper = upper.wrapping_add(square >> 32);
        }
        self.sum = self.sum.saturating_add(sum);
        let squares = (u128::from(upper) << 32).wrapping_add(lower.into());
        self.squares = self.squares.saturating_add(squares);
    }

    /// The first value, and the sums of the values and of their squares relative to it.
    pub(crate) fn sums(&self) -> (i64, i64, u128) {
        (self.first.unwrap_or(0).into(), self.sum, self.squares)
    }
}
