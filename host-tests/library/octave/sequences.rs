//! Any sequence of counts, slices, gaps and merges gives the sums of the definition.

use super::{
    definition::{octaves, square},
    events::{check, counts, events, play},
};
use crate::common::seeded::seeded;
use allanite::Accumulator;
use proptest::{collection::vec, prelude::*};

/// Squares in four samples that swing by the whole range make the largest second differences for that range. 2^11 is
/// the last range that slices square in 16 bits.
#[test]
fn swings_of_any_range_give_the_same_sums_in_slices() {
    for half_period in [1, 2, 4, 8, 16] {
        for range in [1, 2046, 2047, 2048, 2049, 1 << 20] {
            for offset in [0, -5, i32::MAX - (1 << 20)] {
                let high = |n: i32| n / half_period % 2 == 1;
                let count = |n| offset + if high(n) { range } else { 0 };
                let counts: Vec<i32> = (0..3000).map(count).collect();
                let (mut singly, mut sliced) = (Accumulator::<9>::new(), Accumulator::<9>::new());
                counts.iter().for_each(|&count| singly.push(count));
                sliced.push_slice(&counts);
                assert_eq!(singly, sliced, "{half_period} {range} {offset}");
            }
        }
    }
}

/// Floats are read as counts of up to 2^30. The wider they are, the fewer of their differences have 32 bits.
#[test]
fn noise_of_any_width_gives_the_same_sums_in_slices() {
    for bits in 1..=32 {
        for offset in [0, 1 << 20, i32::MIN] {
            let mut random = 1_u64;
            let mut count = || {
                random = random
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                ((random >> 32) as u32 >> (32 - bits)).wrapping_add(offset as u32) as i32
            };
            let counts: Vec<i32> = (0..5000).map(|_| count()).collect();
            let (mut singly, mut sliced) = (Accumulator::<13>::new(), Accumulator::<13>::new());
            counts.iter().for_each(|&count| singly.push(count));
            sliced.push_slice(&counts);
            assert_eq!(singly, sliced, "{bits} {offset}");
        }
    }
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn any_sequence_of_events_gives_the_sums_of_the_definition(events in events()) {
        let (accumulator, record) = play::<13>(&events);
        check(&accumulator, &record);
        check(&play::<30>(&events).0, &record);
        // Fewer octaves give the first ones of more octaves, unless they are too few to fill a gap.
        let (few, record) = play::<2>(&events);
        check(&few, &record);
        check(&play::<3>(&events).0, &record);
        check(&play::<4>(&events).0, &record);
        let (some, record) = play::<7>(&events);
        check(&some, &record);
    }

    #[test]
    fn slices_of_any_length_give_the_same_state_as_single_counts(
        stretches in vec((counts(2000), vec(any::<prop::sample::Index>(), 0..8)), 1..3),
    ) {
        let (mut singly, mut sliced) = (Accumulator::<13>::new(), Accumulator::<13>::new());
        for (counts, cuts) in stretches {
            singly.gap();
            sliced.gap();
            counts.iter().for_each(|&count| singly.push(count));
            let mut cuts: Vec<_> = cuts.iter().map(|cut| cut.index(counts.len() + 1)).collect();
            cuts.extend([0, counts.len()]);
            cuts.sort_unstable();
            cuts.windows(2).for_each(|cut| sliced.push_slice(&counts[cut[0]..cut[1]]));
            prop_assert_eq!(&singly, &sliced);
        }
    }

    #[test]
    fn slices_between_losses_give_the_same_state_as_single_counts(
        stretches in vec((counts(1500), 0..70_u64), 1..6),
    ) {
        let (mut singly, mut sliced) = (Accumulator::<13>::new(), Accumulator::<13>::new());
        for (counts, lost) in stretches {
            counts.iter().for_each(|&count| singly.push(count));
            sliced.push_slice(&counts);
            singly.lost(lost);
            sliced.lost(lost);
            prop_assert_eq!(&singly, &sliced);
        }
    }

    #[test]
    fn a_copy_continues_where_the_original_stopped(before in counts(1500), after in counts(1500)) {
        let mut one = Accumulator::<13>::new();
        one.push_slice(&before);
        let mut restarted = one.clone();
        let mut whole = Accumulator::<13>::new();
        let all: Vec<i32> = before.iter().chain(&after).copied().collect();
        restarted.push_slice(&after);
        whole.push_slice(&all);
        prop_assert_eq!(restarted, whole);
    }

    #[test]
    fn merging_equals_one_record_with_a_gap_between(first in counts(1500), second in counts(1500)) {
        let accumulate = |counts: &[i32]| {
            let mut accumulator = Accumulator::<13>::new();
            accumulator.push_slice(counts);
            accumulator
        };
        let mut merged = accumulate(&first);
        merged.merge(&accumulate(&second));
        let mut batch = accumulate(&first);
        batch.gap();
        batch.push_slice(&second);
        // If the second record is empty, the first one stays open.
        prop_assert_eq!(octaves(&merged), octaves(&batch));
        if !second.is_empty() {
            batch.gap();
            prop_assert_eq!(merged, batch);
        }
    }

    #[test]
    fn the_order_of_merging_does_not_matter(first in events(), second in events()) {
        let ((mut one, _), (mut other, _)) = (play::<13>(&first), play::<13>(&second));
        let before = one.clone();
        one.merge(&other);
        other.merge(&before);
        prop_assert_eq!(octaves(&one), octaves(&other));
        prop_assert_eq!(one.samples(), other.samples());
    }

    #[test]
    fn a_constant_offset_cancels_exactly(counts in counts(2000), offset in any::<i32>()) {
        let halves = counts.iter().map(|count| count / 2);
        let mut plain = Accumulator::<13>::new();
        halves.clone().for_each(|count| plain.push(count));
        let mut shifted = Accumulator::<13>::new();
        halves.for_each(|count| shifted.push(count + offset / 2));
        prop_assert_eq!(octaves(&plain), octaves(&shifted));
    }

    #[test]
    fn sums_scale_with_the_square_of_the_counts(counts in counts(2000), factor in -63_i32..=64) {
        let narrow = counts.iter().map(|count| count / 64);
        let mut unit = Accumulator::<13>::new();
        narrow.clone().for_each(|count| unit.push(count));
        let mut scaled = Accumulator::<13>::new();
        narrow.for_each(|count| scaled.push(count * factor));
        for (unit, scaled) in octaves(&unit).into_iter().zip(octaves(&scaled)) {
            prop_assert_eq!(unit.1, scaled.1);
            prop_assert_eq!(unit.2 * square(i128::from(factor)), scaled.2);
        }
    }
}
