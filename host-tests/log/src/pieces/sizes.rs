//! Sizes of differences.

use serde::{Deserialize, Serialize};

/// Numbers and sums of squares of differences, by the binary order of their sizes: 0, 1, 2 to 3, 4 to 7 and so on.
///
/// Of most differences one order is as usual. What lies many orders above are single samples or blocks unlike all others, which
/// a sum of squares does not tell from noise.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Sizes {
    /// The last order is not empty.
    orders: Vec<(u64, u128)>,
}

/// The number of orders of sizes of 64 bits.
const ORDERS: usize = 65;

/// Some differences.
#[derive(Clone, Copy)]
pub(super) struct Together {
    /// All bits that are set in any of their sizes.
    pub(super) bits: u64,
    /// The sum of their squares.
    pub(super) squares: u128,
}

/// Differences of which most others are a small part.
pub(super) struct Outliers {
    pub(super) number: u64,
    pub(super) squares: u128,
}

impl Sizes {
    /// Adds differences as one, by the order of the largest of them.
    pub(super) fn add_all(&mut self, together: Together) {
        self.put(order(together.bits), 1, together.squares);
    }

    fn put(&mut self, order: usize, number: u64, squares: u128) {
        if order >= self.orders.len() {
            self.orders.resize(order + 1, (0, 0));
        }
        if let Some(own) = self.orders.get_mut(order) {
            own.0 = own.0.saturating_add(number);
            own.1 = own.1.saturating_add(squares);
        }
    }

    /// Adds other differences.
    pub(super) fn join(&mut self, other: &Self) {
        for (order, &(number, squares)) in other.orders.iter().enumerate() {
            if number > 0 {
                self.put(order, number, squares);
            }
        }
    }

    /// The number of differences.
    pub(super) fn number(&self) -> u64 {
        let numbers = self.orders.iter().map(|(number, _)| *number);
        numbers.fold(0, u64::saturating_add)
    }

    /// The sum of the squares of all differences.
    pub(super) fn squares(&self) -> u128 {
        let squares = self.orders.iter().map(|(_, squares)| *squares);
        squares.fold(0, u128::saturating_add)
    }

    /// What lies more than so many orders above the median of the differences that are not zero.
    pub(super) fn outliers(&self, above: usize) -> Outliers {
        let zeros = self.orders.first().map_or(0, |(number, _)| *number);
        let others = self.number().saturating_sub(zeros);
        let mut below = 0;
        let mut orders = self.orders.iter().enumerate().skip(1);
        let median = orders.find(|(_, (number, _))| {
            below += number;
            2 * below >= others
        });
        let first = median.map_or(ORDERS, |(order, _)| order + above + 1);
        let beyond = self.orders.get(first..).unwrap_or_default();
        Outliers {
            number: beyond.iter().fold(0, |sum, one| sum.saturating_add(one.0)),
            squares: beyond.iter().fold(0, |sum, one| sum.saturating_add(one.1)),
        }
    }

    /// Whether these can be so many, each of at most so many differences.
    pub(super) fn is_possible(&self, number: u64, most: u64) -> bool {
        let mut orders = self.orders.iter().enumerate();
        self.number() == number
            && self.orders.len() <= ORDERS
            && self.orders.last().is_none_or(|(number, _)| *number > 0)
            && orders.all(|(order, &(number, squares))| match order.checked_sub(1) {
                None => squares == 0,
                Some(below) => {
                    let least = (1_u128 << (2 * below)).saturating_mul(number.into());
                    (least..=least.saturating_mul(4 * u128::from(most))).contains(&squares)
                }
            })
    }
}

/// The number of bits of a size.
#[inline(always)]
pub(super) fn order(size: u64) -> usize {
    (u64::BITS - size.leading_zeros()) as usize
}
