//! Sums of floats that do not depend on the order.

use serde::{Deserialize, Serialize};

/// The exact sum of numbers of single precision that are not negative, of which none is infinite.
///
/// Numbers of neighbouring exponents are added as integers, eight exponents to a place. So a place takes 2^33 numbers before
/// it overflows, and no order of them and no grouping changes a bit.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ExactSum {
    /// The lowest place that has a number.
    lowest: u8,
    /// The sums of the places from the lowest to the highest one that has a number.
    places: Vec<u64>,
}

/// The number of exponents of a place, as a power of two.
const PLACE_BITS: u32 = 3;

/// The number of places that all exponents make.
const PLACES: usize = 1 << (8 - PLACE_BITS);

/// The number of bits behind the leading one.
const MANTISSA_BITS: u32 = f32::MANTISSA_DIGITS - 1;

/// The exponent of the last bit of a number whose exponent is written as 0.
const LAST_BIT: i32 = 150;

/// All places of a sum, for numbers that are added one after the other.
#[derive(Clone, Copy)]
pub(super) struct Places([u64; PLACES]);

impl Places {
    /// The sum of no numbers.
    pub(super) const EMPTY: Self = Self([0; PLACES]);

    /// Adds a number.
    #[inline]
    pub(super) fn add(&mut self, number: f32) {
        let bits = number.to_bits();
        let exponent = bits >> MANTISSA_BITS;
        let fraction = bits & ((1 << MANTISSA_BITS) - 1);
        // A number without a leading one has the exponent of the smallest that has.
        let mantissa = fraction | u32::from(exponent > 0) << MANTISSA_BITS;
        let exponent = exponent.max(1);
        let shift = exponent % (1 << PLACE_BITS);
        let place = (exponent >> PLACE_BITS) as usize % PLACES;
        self.0[place] += u64::from(mantissa) << shift;
    }
}

impl ExactSum {
    /// Adds the sum of these places.
    pub(super) fn add(&mut self, places: &Places) {
        let mut numbers = (0..PLACES as u8)
            .zip(&places.0)
            .filter(|(_, sum)| **sum > 0);
        let Some((lowest, _)) = numbers.next() else {
            return;
        };
        let highest = numbers.next_back().map_or(lowest, |(place, _)| place);
        let sums = &places.0[usize::from(lowest)..=usize::from(highest)];
        if self.places.is_empty() {
            // In one allocation: a piece has hundreds of sums.
            (self.lowest, self.places) = (lowest, sums.to_vec());
            return;
        }
        for (place, &sum) in (lowest..).zip(sums) {
            self.add_to(place, sum);
        }
    }

    fn add_to(&mut self, place: u8, sum: u64) {
        if sum > 0 {
            let own = self.place(place);
            *own = own.saturating_add(sum);
        }
    }

    /// A place, which is made if it is not yet there.
    #[inline]
    fn place(&mut self, place: u8) -> &mut u64 {
        if self.places.is_empty() {
            self.lowest = place;
        }
        if place < self.lowest {
            let missing = usize::from(self.lowest - place);
            self.places.splice(0..0, std::iter::repeat_n(0, missing));
            self.lowest = place;
        }
        let index = usize::from(place - self.lowest);
        if index >= self.places.len() {
            self.places.resize(index + 1, 0);
        }
        &mut self.places[index]
    }

    /// Adds another sum.
    pub(super) fn join(&mut self, other: &Self) {
        for (place, &sum) in (other.lowest..).zip(&other.places) {
            self.add_to(place, sum);
        }
    }

    /// The sum in double precision.
    pub(super) fn value(&self) -> f64 {
        let unit = |place: usize| {
            let place = i32::from(self.lowest) + place as i32;
            2f64.powi((place << PLACE_BITS) - LAST_BIT)
        };
        let places = self.places.iter().enumerate().rev();
        places.fold(0.0, |all, (place, &sum)| all + sum as f64 * unit(place))
    }

    /// Whether these places can be.
    pub(super) fn is_possible(&self) -> bool {
        let ends = [self.places.first(), self.places.last()];
        usize::from(self.lowest) + self.places.len() <= PLACES
            && ends.into_iter().flatten().all(|&sum| sum > 0)
            && (self.lowest == 0 || !self.places.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_exact_for_every_exponent() {
        let numbers = [
            f32::MIN_POSITIVE / 8.0,
            f32::MIN_POSITIVE,
            1e-20,
            0.1,
            1.0,
            3e7,
            f32::MAX,
        ];
        for number in numbers {
            let mut places = Places::EMPTY;
            for _ in 0..3 {
                places.add(number);
            }
            let mut sum = ExactSum::default();
            sum.add(&places);
            assert_eq!(sum.value(), 3.0 * f64::from(number));
            assert!(sum.is_possible());
        }
    }

    #[test]
    fn no_order_changes_a_bit() {
        let numbers: Vec<f32> = (0..999_u32)
            .map(|i| f32::from_bits(i.wrapping_mul(2_654_435_761) % (255 << 23)))
            .collect();
        let sum = |numbers: &mut dyn Iterator<Item = f32>| {
            let mut sum = ExactSum::default();
            let mut places = Places::EMPTY;
            numbers.for_each(|number| places.add(number));
            sum.add(&places);
            sum
        };
        let forwards = sum(&mut numbers.iter().copied());
        let backwards = sum(&mut numbers.iter().rev().copied());
        let mut halves = sum(&mut numbers[500..].iter().copied());
        halves.join(&sum(&mut numbers[..500].iter().copied()));
        assert_eq!(forwards, backwards);
        assert_eq!(forwards, halves);
        assert_eq!(forwards.places.len(), PLACES);
    }
}
