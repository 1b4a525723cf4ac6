//! Turns floats into counts. Whole numbers stay exact, and any other number is rounded far below
//! its noise.

use super::field::Exact;

/// The range of the values of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    lowest: f64,
    highest: f64,
    /// Whether every value is a whole number within `i32`.
    whole: bool,
    /// The lowest and the highest of the whole numbers that a float does not hold.
    large: Option<(i128, i128)>,
}

impl Range {
    /// The range of no values.
    pub(super) const EMPTY: Self = Self {
        lowest: f64::INFINITY,
        highest: f64::NEG_INFINITY,
        whole: true,
        large: None,
    };

    /// The range from the lowest to the highest of some floats. `whole` tells whether all of them are whole numbers, as
    /// far as they lie within `i32`.
    pub(super) fn of_floats(lowest: f64, highest: f64, whole: bool) -> Self {
        Self {
            lowest,
            highest,
            whole: whole && lowest >= i32::MIN.into() && highest <= i32::MAX.into(),
            large: None,
        }
    }

    /// Widens the range to include that of other floats.
    pub(super) fn include_floats(&mut self, floats: &Self) {
        self.lowest = self.lowest.min(floats.lowest);
        self.highest = self.highest.max(floats.highest);
        self.whole &= floats.whole;
    }

    /// Widens the range to include a value.
    #[inline]
    pub(super) fn include(&mut self, value: Exact) {
        match value {
            Exact::Float(value) => {
                self.lowest = self.lowest.min(value);
                self.highest = self.highest.max(value);
                self.whole &= f64::from(value as i32) == value;
            }
            Exact::Whole(value) => {
                let (lowest, highest) = self.large.unwrap_or((value, value));
                self.large = Some((lowest.min(value), highest.max(value)));
            }
        }
    }

    /// The same range relative to a whole number in its middle, and that number. It is 0 unless the
    /// range has whole numbers that a float does not hold.
    fn centred(self) -> (Self, i128) {
        let Some((mut lowest, mut highest)) = self.large else {
            return (self, 0);
        };
        if self.lowest <= self.highest {
            // A float beyond all integers saturates; the range is then too wide in any case.
            lowest = lowest.min(self.lowest.floor() as i128);
            highest = highest.max(self.highest.ceil() as i128);
        }
        let origin = lowest / 2 + highest / 2;
        let [low, high] = [lowest, highest].map(|end| end.saturating_sub(origin) as f64);
        let centred = Self {
            lowest: low,
            highest: high,
            whole: self.whole && low >= i32::MIN.into() && high <= i32::MAX.into(),
            large: None,
        };
        (centred, origin)
    }
}

/// How the numbers of one axis become counts: `count = round((value − base) / step) − origin`.
///
/// The step is a power of two between 2^-30 and 2^-29 of the range. Division by it is therefore
/// exact, and values that are multiples of it become exact counts. The origin subtracts a constant
/// offset, which does not change any Allan variance. The base does the same for whole numbers that a
/// float does not hold, and is subtracted while they are still integers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quantum {
    step: f64,
    origin: f64,
    base: i128,
}

impl Quantum {
    /// The quantum of whole numbers, which are counts already.
    pub(super) const WHOLE: Self = Self {
        step: 1.0,
        origin: 0.0,
        base: 0,
    };

    /// The quantum of values within a range. Returns `None` for a range beyond 1e300 or below
    /// 1e-290, where floats overflow or underflow.
    pub(super) fn of(range: Range) -> Option<Self> {
        let (range, base) = range.centred();
        let width = range.highest - range.lowest;
        if range.whole || width == 0.0 {
            return Some(Self {
                origin: if range.whole { 0.0 } else { range.lowest },
                base,
                ..Self::WHOLE
            });
        }
        if !(1e-290..=1e300).contains(&width) {
            return None;
        }
        let exponent = width.log2().ceil() as i32 - 30;
        let step = 2f64.powi(exponent);
        let middle = 0.5 * range.lowest + 0.5 * range.highest;
        let origin = (middle / step).round_ties_even();
        origin.is_finite().then_some(Self { step, origin, base })
    }

    /// The quantum of values within a range that are all multiples of about this step, but for a constant. Returns `None`
    /// if the range has whole numbers that a float does not hold.
    pub(super) fn of_steps(range: Range, step: f64) -> Option<Self> {
        let (range, base) = range.centred();
        let width = range.highest - range.lowest;
        let steps = (width / step).round();
        if base != 0 || !(1.0..1e9).contains(&steps) {
            return None;
        }
        let step = decimal(width / steps);
        Some(Self {
            step,
            origin: range.lowest / step,
            base,
        })
    }

    /// The quantum of values that are counted from zero in steps of this size, which is a power of two.
    pub(super) const fn with_step(step: f64) -> Self {
        Self {
            step,
            ..Self::WHOLE
        }
    }

    /// The size of one count.
    pub(super) const fn step(&self) -> f64 {
        self.step
    }

    /// Whether the counts are the values themselves but for a constant.
    pub(super) fn is_whole(&self) -> bool {
        self.step == 1.0 && self.origin == 0.0
    }

    /// Whether whole numbers that a float does not hold are within the range.
    pub(super) const fn has_base(&self) -> bool {
        self.base != 0
    }

    /// The number of counts that is subtracted.
    pub(super) const fn origin(&self) -> f64 {
        self.origin
    }

    /// The value less the base.
    #[inline]
    pub(super) fn relative(&self, value: Exact) -> f64 {
        match value {
            Exact::Float(value) if self.base == 0 => value,
            Exact::Float(value) if value.fract() == 0.0 => {
                (value as i128).saturating_sub(self.base) as f64
            }
            // The range is then so wide that the rounding here is far below a count.
            Exact::Float(value) => value - self.base as f64,
            Exact::Whole(value) => value.saturating_sub(self.base) as f64,
        }
    }

    /// The value of a count or of a mean of counts.
    pub(super) fn value(&self, count: f64) -> f64 {
        (count + self.origin) * self.step + self.base as f64
    }

    /// The count of a relative value within the range. Its magnitude is at most 2^29, or that of a
    /// whole number.
    #[inline]
    pub(super) fn count(&self, relative: f64) -> i32 {
        round(relative / self.step - self.origin) as i32
    }
}

/// The decimal number of few digits that is nearly this one, or else this one.
fn decimal(number: f64) -> f64 {
    /// More digits are taken for chance.
    const MOST: f64 = 1000.0;
    let decimals = (0..=12).map(|digits| {
        let power = 10f64.powi(digits);
        ((number * power).round(), power)
    });
    let mut near = decimals.filter(|(whole, power)| {
        (1.0..=MOST).contains(whole) && (number * power / whole - 1.0).abs() < 1e-6
    });
    near.next().map_or(number, |(whole, power)| whole / power)
}

/// Next to this number, floats are whole.
pub(super) const LARGE: f64 = (3_u64 << 51) as f64;

/// The nearest whole number to one within ±2^51, the even one of two. Where the processor that a program is built for
/// has no instruction for it, `round_ties_even` is a call.
#[inline]
fn round(number: f64) -> f64 {
    // The sum is rounded to a whole number, and the difference is exact.
    (number + LARGE) - LARGE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantum(values: &[f64]) -> Quantum {
        let mut range = Range::EMPTY;
        values
            .iter()
            .for_each(|&value| range.include(Exact::Float(value)));
        Quantum::of(range).unwrap()
    }

    #[test]
    fn numbers_are_rounded_to_the_nearest_even_one() {
        for halves in -9..9 {
            for near in [-1e-9, 0.0, 1e-9] {
                let number = f64::from(halves) / 2.0 + near;
                assert_eq!(round(number), number.round_ties_even());
            }
        }
        for number in [f64::from(i32::MIN), f64::from(i32::MAX), 2e9 + 0.5] {
            assert_eq!(round(number), number.round_ties_even());
        }
    }

    #[test]
    fn whole_numbers_are_counts_as_they_are() {
        let values = [f64::from(i32::MIN), 0.0, 17.0, f64::from(i32::MAX)];
        let quantum = quantum(&values);
        assert_eq!(quantum, Quantum::WHOLE);
        assert_eq!(
            values.map(|value| quantum.count(value)),
            [i32::MIN, 0, 17, i32::MAX]
        );
    }

    #[test]
    fn step_lies_between_2_to_minus_30_and_2_to_minus_29_of_the_range() {
        for width in [1e-280, 3e-7, 0.5, 1.0, 1.000001, 77.7, 1e300] {
            let relative = quantum(&[0.25 * width, 1.25 * width]).step() / width;
            assert!((2f64.powi(-30)..=2f64.powi(-29)).contains(&(relative * (1.0 + 1e-15))));
        }
    }

    #[test]
    fn offset_of_a_million_times_the_range_costs_no_resolution() {
        let values = [1e6 + 0.25, 1e6 + 0.5, 1e6 + 1.25];
        let quantum = quantum(&values);
        let counts = values.map(|value| quantum.count(value));
        let rate = |i: usize, j: usize| f64::from(counts[i] - counts[j]) * quantum.step();
        assert_eq!((rate(1, 0), rate(2, 1)), (0.25, 0.75));
    }

    #[test]
    fn values_of_counts_are_those_that_were_counted() {
        for values in [[0.25, 0.5, 1.25], [-3.0, 4.0, 9.0], [1e6, 1e6, 1e6]] {
            let quantum = quantum(&values);
            for value in values {
                let again = quantum.value(quantum.count(value).into());
                assert!((again - value).abs() < 1e-9, "{again} {value}");
            }
        }
    }

    #[test]
    fn counts_stay_within_half_of_i32() {
        let quantum = quantum(&[-0.7, 0.3]);
        assert!(quantum.count(0.3).abs() <= 1 << 29 && quantum.count(-0.7).abs() <= 1 << 29);
    }

    #[test]
    fn rounded_decimals_become_counts_of_their_step() {
        for (step, offset) in [
            (0.01, 0.0),
            (0.002, -7.0),
            (0.05, 0.013),
            (1.0 / 131.0, 0.0),
        ] {
            let values: Vec<f64> = (0..30)
                .map(|i| offset + step * f64::from(i * 7 % 30))
                .collect();
            let mut range = Range::EMPTY;
            let all = values.iter();
            all.for_each(|&value| range.include(Exact::Float(value)));
            let quantum = Quantum::of_steps(range, step * (1.0 + 1e-7)).unwrap();
            assert!((quantum.step() / step - 1.0).abs() < 1e-12, "{step}");
            for (i, &value) in (0..30).zip(&values) {
                let count = quantum.count(value);
                assert_eq!(count, i * 7 % 30, "{step}");
                assert!((quantum.value(count.into()) - value).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn range_beyond_floats_has_no_quantum() {
        let mut range = Range::EMPTY;
        range.include(Exact::Float(f64::MAX));
        range.include(Exact::Float(f64::MIN));
        assert_eq!(Quantum::of(range), None);
    }

    #[test]
    fn whole_numbers_beyond_floats_lose_no_digit() {
        let base = 1_i128 << 60;
        let mut range = Range::EMPTY;
        for value in [base - 7, base, base + 12] {
            range.include(Exact::Whole(value));
        }
        let quantum = Quantum::of(range).unwrap();
        let count = |value| quantum.count(quantum.relative(Exact::Whole(value)));
        assert!(quantum.is_whole());
        assert_eq!(count(base + 12) - count(base), 12);
        assert_eq!(count(base) - count(base - 7), 7);
    }
}
