//! The factor of the covariance of octaves, in half the memory of a square.

/// The numbers below the diagonal, row by row. Each takes two halves, because a square of halves has room for them, and a
/// triangle of numbers has no length that a type can name.
pub(super) struct Factor<'a> {
    numbers: &'a mut [Halves],
}

type Halves = [u16; 2];

/// The number of elements in front of row `k`.
const fn before(k: usize) -> usize {
    k.wrapping_mul(k.wrapping_sub(1)).wrapping_shr(1)
}

const fn joined([low, high]: Halves) -> i32 {
    (low as u32 | (high as u32).wrapping_shl(16)) as i32
}

impl<'a> Factor<'a> {
    /// In the memory of a square of `K` rows and columns.
    pub(super) fn new<const K: usize>(square: &'a mut [[u16; K]; K]) -> Self {
        let (numbers, _) = square.as_flattened_mut().as_chunks_mut();
        Self { numbers }
    }

    /// Sets all elements to zero.
    pub(super) fn clear(&mut self) {
        self.numbers.fill([0; 2]);
    }

    pub(super) fn put(&mut self, k: usize, j: usize, number: i32) {
        if let Some(place) = self.numbers.get_mut(before(k).wrapping_add(j)) {
            let number = number as u32;
            *place = [number as u16, number.wrapping_shr(16) as u16];
        }
    }

    /// The elements of row `k`.
    pub(super) fn row(&self, k: usize) -> impl Iterator<Item = i32> {
        let (_, rest) = self.numbers.split_at_checked(before(k)).unwrap_or_default();
        let row = rest.get(..k).unwrap_or_default();
        row.iter().map(|&halves| joined(halves))
    }

    /// What is left of a number, in units of 2^-60, without the products of row `k` with as many others.
    pub(super) fn left(&self, number: i64, k: usize, others: impl Iterator<Item = i32>) -> i64 {
        let mut left = number;
        for (own, other) in self.row(k).zip(others) {
            left = left.wrapping_sub(i64::from(own).wrapping_mul(other.into()));
        }
        left
    }
}
