//! Positions, powers and sums of the lattice are compared with direct evaluation.

use super::*;
use crate::numerics::{
    real::{by_precision, double},
    test_random::Random,
};

/// The tolerance for the rounding errors of a sum or a product.
const ROUNDING: Real = by_precision(1e-13, 1e-5);

/// Averaging factors, including the short ones whose quarters are not whole samples.
const FACTORS: [u32; 5] = [1, 2, 4, 8, 1024];

#[test]
fn positions_are_consecutive_up_to_sixteen_and_then_four_per_octave() {
    let mut expected = 0_u32;
    for slot in 0..LEN {
        assert_eq!(position(slot), expected, "slot {slot}");
        // The distance is a quarter of the greatest power of two that does not exceed the position.
        expected += if expected < 16 {
            1
        } else {
            (1 << expected.ilog2()) / 4
        };
    }
    assert_eq!(position(LEN - 1), END);
}

#[test]
fn powers_equal_repeated_multiplication() {
    let mut random = Random::new(21);
    for _ in 0..20 {
        // The numbers lie on the unit circle or inside it: the first stand for a line, the others for a
        // resonance that dies away.
        let angle = 0.01 * random.signed();
        let size = libm::exp(-1e-4 * (random.signed() + 1.0));
        let w = Complex::new(real(size * libm::cos(angle)), real(size * libm::sin(angle)));
        let exact = Complex::new(double(w.re), double(w.im));
        let (mut powers, mut expected, mut at) = (Powers::new(w), Complex::new(1.0, 0.0), 0);
        for slot in 0..LEN {
            let position = position(slot);
            if position > 1 << 16 {
                break;
            }
            while at < position {
                expected *= exact;
                at += 1;
            }
            let found = powers.next(slot);
            let off = Complex::new(double(found.re), double(found.im)) - expected;
            // Each squaring doubles the relative error.
            let most = double(by_precision(1e-15, 1.2e-7)) * (f64::from(position) + 4.0);
            let off = libm::hypot(off.re, off.im);
            assert!(off <= most, "{position}: {off:e}");
            if slot <= 16 {
                assert_eq!(powers.near(slot), found);
            }
        }
    }
}

/// A smooth even function of the lag in samples.
fn bump(lag: Real) -> Real {
    1.0 / (1.0 + 1e-3 * lag * lag)
}

/// The value of every slot.
fn values(differences: &SecondDifferences) -> [Real; LEN] {
    differences.values
}

/// The slots whose lag is a whole number of samples, with that lag.
fn whole(m: u32) -> impl Iterator<Item = (usize, Real)> {
    let slots =
        (0..LEN).filter(move |&slot| (u64::from(position(slot)) * u64::from(m)).is_multiple_of(4));
    slots.map(move |slot| (slot, 0.25 * real(position(slot)) * real(m)))
}

#[test]
fn lags_of_whole_samples_are_evaluated_and_no_others() {
    for m in FACTORS {
        let mut sum = SecondDifferences::zero(m, END);
        sum.add(real(m), bump);
        let found = values(&sum);
        let mut evaluated = 0;
        for (slot, lag) in whole(m) {
            let expected = bump(lag);
            assert!(
                (found[slot] - expected).abs() <= ROUNDING * expected,
                "m {m}, {lag}"
            );
            evaluated += 1;
        }
        let others = found.iter().filter(|value| **value == 0.0);
        assert_eq!(others.count(), LEN - evaluated, "m {m}");
    }
}

#[test]
fn sums_cover_exactly_the_lags_below_an_end_or_from_a_start() {
    for m in FACTORS {
        for end in [0.5, 1.0, 3.0, 8.0, 1000.0] {
            let end = end * real(m);
            let mut below = SecondDifferences::zero(m, END);
            below.add_below(real(m), end, |_| 1.0);
            let mut from = SecondDifferences::zero(m, END);
            from.add_from(real(m), |_| 1.0);
            for (slot, lag) in whole(m) {
                let expected = real(u8::from(lag < end));
                assert_eq!(values(&below)[slot], expected, "m {m}, {lag} of {end}");
                let expected = real(u8::from(lag >= real(m)));
                assert_eq!(values(&from)[slot], expected, "m {m}, {lag}");
            }
        }
    }
}

#[test]
fn positions_beyond_the_longest_lag_stay_zero() {
    for (end, last) in [(0, 0), (1, 1), (16, 16), (17, 20), (33, 40), (END, END)] {
        let mut sum = SecondDifferences::zero(4, end);
        sum.add_slots(|_| 1.0);
        for (slot, value) in values(&sum).into_iter().enumerate() {
            assert_eq!(value, real(u8::from(position(slot) <= last)), "{slot}");
        }
    }
}

#[test]
fn contributions_of_several_calls_are_added() {
    let mut random = Random::new(22);
    let table: [Real; LEN] = core::array::from_fn(|_| random.real());
    let mut sum = SecondDifferences::zero(8, END);
    sum.add(8.0, bump);
    sum.add_scaled(-3.0, &table);
    sum.add_slots(|slot| real(slot as f64));
    sum.add_at(3, 100.0);
    sum.add_at(17, 1000.0);
    for (slot, lag) in whole(8) {
        let at = match slot {
            3 => 100.0,
            // There is no place of its own beyond 16 quarters.
            16 => 1000.0,
            _ => 0.0,
        };
        let expected = bump(lag) - 3.0 * table[slot] + real(slot as f64) + at;
        let off = (values(&sum)[slot] - expected).abs();
        assert!(off <= ROUNDING * (1.0 + expected.abs()), "slot {slot}");
    }
}

#[test]
fn rounded_second_differences_are_in_units_of_the_variance() {
    for unit in [3.0, 1e-7] {
        // The effect has a second difference of `unit` at one cluster, and of 0 elsewhere.
        let mut sum = SecondDifferences::zero(4, END);
        sum.add_at(4, unit);
        let rounded = sum.rounded(sum.unit());
        assert_eq!(rounded.unit(), unit);
        assert!((f64::from(rounded.at(4)) - 1.0).abs() <= 1e-6);
        assert_eq!(rounded.at(5), 0.0);
    }
}

#[test]
fn values_between_positions_are_interpolated_linearly() {
    let mut random = Random::new(23);
    let mut sum = SecondDifferences::zero(4, END);
    sum.add_at(4, 1.0); // the unit
    let table: [Real; LEN] = core::array::from_fn(|slot| match slot {
        0 | 4 => 0.0,
        _ => random.real(),
    });
    sum.add_scaled(1.0, &table);
    let rounded = sum.rounded(sum.unit());
    let value = |slot: usize| double(table[slot]) + f64::from(u8::from(slot == 4));
    let far = core::iter::repeat_with(|| random.bits() % END).take(2000);
    for lag in (0..4096).chain(far).chain([END - 1]) {
        // This is the last position that is not beyond the lag, found one by one.
        let low = (0..LEN).take_while(|&slot| position(slot) <= lag).count() - 1;
        let (from, to) = (position(low), position((low + 1).min(LEN - 1)));
        let share = match to - from {
            0 => 0.0,
            width => f64::from(lag - from) / f64::from(width),
        };
        let expected = value(low) + share * (value((low + 1).min(LEN - 1)) - value(low));
        let off = (f64::from(rounded.at(lag)) - expected).abs();
        assert!(off < 1e-6, "at {lag}: {off:e}");
    }
}

#[test]
fn the_stride_is_the_smallest_number_of_quarters_that_is_whole_samples() {
    for m in FACTORS {
        // The stride is the smallest number of quarters that is a whole number of samples.
        let first = (1..=4).find(|quarters| (quarters * m).is_multiple_of(4));
        assert_eq!(Some(stride(m)), first, "m {m}");
    }
}
