//! The sums from which the mean and the variance of the values follow.

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

    /// The first value.
    pub(super) const fn first(&self) -> Option<i32> {
        self.first
    }

    /// Adds the sums of some values and of their squares, relative to the first one.
    pub(super) fn push_sums(&mut self, sum: i64, squares: u64) {
        self.sum = self.sum.saturating_add(sum);
        self.squares = self.squares.saturating_add(squares.into());
    }

    /// The first value, and the sums of the values and of their squares relative to it.
    pub(crate) fn sums(&self) -> (i64, i64, u128) {
        (self.first.unwrap_or(0).into(), self.sum, self.squares)
    }
}
