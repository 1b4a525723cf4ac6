//! Finds the range of many floats and rounds them to counts, in loops that the compiler spreads over vectors. The results
//! are those of the same floats one by one.

use super::{
    OCTAVES,
    grid::Grid,
    quantum::{LARGE, Quantum, Range},
};
use allanite::{
    Accumulator,
    integrity::{Limits, Reason},
};
use std::num::NonZeroU32;

/// The number of floats that are compared side by side. Vectors of two floats then have enough of them to hide how
/// long a comparison takes.
const LANES: usize = 8;

/// The differences that are needed to tell whether numbers are too coarse for their noise, as many as for counts.
const JUDGED: u64 = 1000;

/// The changes that show that all numbers are multiples of a step. One that is not rounded is near such a multiple by a
/// chance of one in 32.
const CHANGES: u64 = 64;

/// The largest mean square of the differences of neighbours, in steps, with which rounding to these matters: it then raises
/// angle random walk by half a per cent.
const MOST_SQUARES: f64 = 16.0;

/// The range of floats, or `None` if some of them are not finite.
pub(super) fn range_of(floats: &[f64]) -> Option<Range> {
    let mut lowest = [f64::INFINITY; LANES];
    let mut highest = [f64::NEG_INFINITY; LANES];
    // Masks of whole words, because the compiler keeps those in vectors.
    let mut odd = [0_u64; LANES];
    let mut endless = [0_u64; LANES];
    let (chunks, rest) = floats.as_chunks::<LANES>();
    let mut last = [floats.first().copied().unwrap_or(0.0); LANES];
    last[..rest.len()].copy_from_slice(rest);
    let last = if rest.is_empty() {
        &[][..]
    } else {
        &[last][..]
    };
    for chunk in chunks.iter().chain(last) {
        for i in 0..LANES {
            let float = chunk[i];
            lowest[i] = if float < lowest[i] { float } else { lowest[i] };
            highest[i] = if float > highest[i] {
                float
            } else {
                highest[i]
            };
            // A whole number beyond ±2^51 may seem to be none here. It is not within `i32` anyway.
            odd[i] |= u64::from((float + LARGE) - LARGE != float).wrapping_neg();
            endless[i] |= u64::from(!float.is_finite()).wrapping_neg();
        }
    }
    if endless != [0; LANES] {
        return None;
    }
    Some(Range::of_floats(
        lowest.into_iter().fold(f64::INFINITY, f64::min),
        highest.into_iter().fold(f64::NEG_INFINITY, f64::max),
        odd == [0; LANES],
    ))
}

impl Quantum {
    /// Rounds floats within the range to counts. Does nothing and returns `false` if some of them are not finite, or
    /// if whole numbers that a float does not hold belong to the range.
    pub(super) fn count_all(&self, floats: &[f64], counts: &mut [i32]) -> bool {
        if self.has_base()
            || !floats
                .iter()
                .fold(true, |all, float| all & float.is_finite())
        {
            return false;
        }
        // The step is a power of two, of which the inverse is exact.
        let (inverse, origin) = (1.0 / self.step(), self.origin());
        for (count, float) in counts.iter_mut().zip(floats) {
            // The sum is a multiple of its last bit, which is 1. So the lower half of its bits are those of the count.
            *count = ((float * inverse - origin) + LARGE).to_bits() as i32;
        }
        true
    }
}

/// The differences between neighbouring values of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Steps {
    last: Option<(f64, i32)>,
    /// The number of differences that are not zero as numbers.
    pub(super) changes: u64,
    /// The number of these that are zero as counts.
    pub(super) lost: u64,
    /// The smallest difference of counts that is not zero.
    least: Option<NonZeroU32>,
    grid: Grid,
}

impl Steps {
    #[inline]
    pub(super) fn step_to(&mut self, number: f64, count: i32) {
        if let Some((last, last_count)) = self.last {
            let changes = number != last;
            self.changes += u64::from(changes);
            self.lost += u64::from(changes && count == last_count);
            self.include(count.abs_diff(last_count));
        }
        self.last = Some((number, count));
    }

    /// Steps to all numbers in their order.
    pub(super) fn step_through(&mut self, numbers: &[f64], counts: &[i32]) {
        /// The number of pairs of neighbours that are looked at together. Few of them then hold a pair of equal counts.
        const PAIRS: usize = 16;
        let mut at = 0;
        while at < numbers.len() {
            // Counts that differ are those of numbers that differ.
            let differ = at > 0
                && !self.grid.is_open()
                && at + PAIRS <= counts.len()
                && (at..at + PAIRS).fold(true, |all, i| all & (counts[i] != counts[i - 1]));
            let end = (at + PAIRS).min(numbers.len());
            if differ {
                self.changes += PAIRS as u64;
                let pairs = at..at + PAIRS;
                let least = pairs.fold(u32::MAX, |least, i| {
                    least.min(counts[i].abs_diff(counts[i - 1]))
                });
                self.include(least);
                self.last = Some((numbers[end - 1], counts[end - 1]));
            } else {
                for i in at..end {
                    self.step_to(numbers[i], counts[i]);
                }
            }
            at = end;
        }
    }

    /// Takes account of a difference of counts.
    fn include(&mut self, difference: u32) {
        let least = NonZeroU32::new(difference).into_iter();
        self.least = least.chain(self.least).min();
        self.grid.include(difference);
    }

    /// The step in counts to which the numbers were rounded before they were written, if it is large enough beside their
    /// noise to matter: `sums` are those of their counts.
    pub(super) fn grid(&self, sums: &Accumulator<OCTAVES>) -> Option<f64> {
        let step = f64::from(self.grid.step().filter(|_| self.changes >= CHANGES)?);
        let octave = sums.octave(0)?;
        let mean = octave.sum.to_real() / octave.differences as f64;
        (mean < MOST_SQUARES * step * step).then_some(step)
    }

    /// Why the numbers are too coarse for their noise; `None` if they are not. `sums` are those of their counts.
    ///
    /// Numbers that were rounded before they were written are multiples of a step that is many counts long. No
    /// difference of neighbours but zero is then smaller than the step. If their mean square is below the limit that
    /// holds for whole numbers, most neighbours are equal, which noise that is not rounded never shows.
    pub(super) fn coarse(&self, sums: &Accumulator<OCTAVES>) -> Option<Reason> {
        let limits = Limits::DEFAULT;
        let step = f64::from(self.least?.get());
        let octave = sums.octave(0)?;
        let mean = octave.sum.to_real() / octave.differences as f64;
        let per_mille = 1000.0 * mean / (step * step);
        let is_judged = octave.differences >= JUDGED;
        let is_coarse = is_judged && per_mille < f64::from(limits.difference_per_mille);
        (is_coarse && !sums.carries_rounding()).then_some(Reason::Coarse {
            per_mille: per_mille as u16,
        })
    }

    /// Tells that samples are missing before the next number.
    pub(super) fn gap(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::{super::field::Exact, *};

    /// Floats of many sizes, whole numbers, halves and both zeros.
    fn floats(number: usize, size: f64) -> Vec<f64> {
        let mut random = 1_u64;
        let mut next = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let float = size * ((random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0);
            match random >> 61 {
                0 => float.round(),
                1 => float.round() + 0.5,
                2 => -0.0,
                _ => float,
            }
        };
        (0..number).map(|_| next()).collect()
    }

    const SIZES: [f64; 6] = [1e-280, 3.0, 1e5, 2_147_483_648.0, 4e15, 1e290];

    fn one_by_one(floats: &[f64]) -> Range {
        let mut range = Range::EMPTY;
        for &float in floats {
            range.include(Exact::Float(float));
        }
        range
    }

    #[test]
    fn range_is_that_of_the_floats_one_by_one() {
        for size in SIZES {
            for number in [1, 7, 8, 9, 1000] {
                let floats = floats(number, size);
                let whole: Vec<f64> = floats.iter().map(|float| float.round()).collect();
                for floats in [floats, whole] {
                    let found = range_of(&floats).unwrap();
                    assert_eq!(found, one_by_one(&floats), "{size} {number}");
                    let mut range = one_by_one(&[1.5]);
                    range.include_floats(&found);
                    assert_eq!(range, one_by_one(&[&[1.5], &floats[..]].concat()));
                }
            }
        }
        for whole in [i32::MIN, i32::MAX].map(f64::from) {
            for float in [whole, whole - 1.0, whole + 1.0, whole + 0.5] {
                let found = range_of(&[float]).unwrap();
                assert_eq!(found, one_by_one(&[float]), "{float}");
            }
        }
        assert_eq!(range_of(&[]), Some(Range::EMPTY));
    }

    #[test]
    fn numbers_that_are_not_finite_have_no_range_and_no_count() {
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for place in [0, 8, 18] {
                let mut floats = floats(19, 3.0);
                floats[place] = odd;
                assert_eq!(range_of(&floats), None);
                assert!(!Quantum::WHOLE.count_all(&floats, &mut [0; 19]));
            }
        }
    }

    #[test]
    fn counts_and_steps_are_those_of_the_floats_one_by_one() {
        for size in SIZES {
            let mut floats = floats(1000, size);
            // Numbers that repeat, and some that differ by less than a count.
            for i in (0..990).step_by(13) {
                floats[i + 1] = floats[i];
                floats[i + 3] = floats[i + 2] * (1.0 + 1e-15);
            }
            let Some(quantum) = Quantum::of(one_by_one(&floats)) else {
                panic!("a quantum for {size}");
            };
            let mut counts = vec![0; floats.len()];
            assert!(quantum.count_all(&floats, &mut counts));
            let (mut singly, mut together) = (Steps::default(), Steps::default());
            for (&float, &count) in floats.iter().zip(&counts) {
                assert_eq!(quantum.count(float), count, "{float}");
                singly.step_to(float, count);
            }
            for (numbers, counts) in floats.chunks(70).zip(counts.chunks(70)) {
                together.step_through(numbers, counts);
            }
            assert!(singly.changes > 500, "{singly:?}");
            assert_eq!(singly, together, "{size}");
        }
    }
}
