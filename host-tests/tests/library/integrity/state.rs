//! The state of the integrity check: what it reports, counts, merges and forgets.

use super::{disturb, integrity, mems};
use crate::seeded::seeded;
use allanite::integrity::{Integrity, Limits, Observation};
use proptest::{collection::vec, prelude::*};

/// Limits with a static lifetime, like those in the flash of a product.
fn leaked(limits: Limits) -> &'static Limits {
    Box::leak(Box::new(limits))
}

#[test]
fn an_observation_identifies_the_odd_sample() {
    let mut counts = mems(6);
    counts[20_000] = 9000;
    disturb(&mut counts, 30_000, 1000, |_| 20.0);
    let value = counts[50_000];
    counts[50_000..51_000].fill(value);
    counts[60_000] = i32::MIN;
    let mut integrity = Integrity::default();
    for (n, &count) in counts.iter().enumerate() {
        let odd = integrity.push(count);
        let moving = (30_128..31_000).contains(&n);
        match n {
            20_000 => assert!(odd.outlying && !odd.railed),
            60_000 => assert!(odd.outlying && odd.railed),
            50_300..51_000 => assert!(odd.stuck),
            30_000..34_000 => {
                assert_eq!(odd.outlying, n % 1000 < 4 && n < 31_004, "{n}");
                assert!(!moving || odd.moving, "{n}");
            }
            50_000..50_300 => {}
            _ => assert_eq!(odd, Observation::default(), "{n}"),
        }
        assert_eq!(odd.is_odd(), odd != Observation::default());
    }
    let tally = integrity.tally();
    assert_eq!((tally.spikes, tally.steps, tally.motions), (2, 2, 1));
    assert_eq!((tally.stuck_runs, tally.rail_hits), (1, 1));
}

#[test]
fn slices_lead_to_the_state_of_single_counts() {
    let quiet = |seed, divisor| mems(seed).into_iter().map(move |count| count / divisor);
    let mut odd = mems(3);
    for (n, size) in [
        (5000, 9000),
        (9000, 500),
        (9001, -500),
        (20_000, i32::MAX),
        (20_001, i32::MIN),
    ] {
        odd[n] = size;
    }
    disturb(&mut odd, 30_000, 1000, |_| 20.0);
    disturb(&mut odd, 50_000, 15_000, |x| 3.0 * x);
    odd.copy_within(40_000..40_001, 40_001);
    let (value, pair) = (odd[44_000], odd[45_000]);
    odd[44_000..44_400].fill(value);
    odd[45_000..45_003].fill(pair);
    let records: [Vec<i32>; 5] = [
        odd,
        quiet(4, 40).collect(),
        quiet(5, 400).collect(),
        // As floats are rounded, and with differences beyond 32 bits.
        mems(6).iter().map(|count| count << 16).collect(),
        mems(7).iter().map(|count| count << 24).collect(),
    ];
    for (i, counts) in records.iter().enumerate() {
        for length in [1, 7, 8, 63, 64, 65, 100, 1000, counts.len()] {
            let (mut singly, mut sliced) = (Integrity::default(), Integrity::default());
            for (n, slice) in counts.chunks(length).enumerate() {
                for &count in slice {
                    singly.push(count);
                }
                sliced.push_slice(slice);
                if n % 300 == 299 {
                    singly.gap();
                    sliced.gap();
                }
            }
            assert_eq!(format!("{singly:?}"), format!("{sliced:?}"), "{i} {length}");
        }
    }
}

#[test]
fn contradictory_limits_are_refused_by_name() {
    let refuse = |limits| {
        Integrity::with_limits(leaked(limits))
            .expect_err("refused")
            .to_string()
    };
    let limits = Limits::default();
    assert_eq!(
        refuse(Limits {
            spike_factor: 2,
            ..limits
        }),
        "the limit spike_factor = 2 is impossible: choose 8 to 256"
    );
    assert_eq!(
        refuse(Limits {
            missing_per_mille: 1001,
            ..limits
        }),
        "the limit missing_per_mille = 1001 is impossible: choose 0 to 1000"
    );
    assert_eq!(
        Integrity::with_limits(leaked(limits)),
        Ok(Integrity::default())
    );
}

#[test]
fn a_reason_is_one_sentence_with_numbers_and_a_remedy() {
    let mut counts = mems(8);
    counts[1000] = 20_000;
    let reason = integrity(&counts).verdict().expect("a reason").to_string();
    assert_eq!(
        reason,
        "the record has spikes: single samples far beyond the noise (1) explain 98 % of the variance \
         of one sample; check the supply and the bus, or leave the spikes out as gaps"
    );
}

#[test]
fn reset_forgets_everything_except_the_limits() {
    let limits = Limits {
        run_factor: 200,
        ..Limits::default()
    };
    let fresh = Integrity::with_limits(leaked(limits)).expect("valid limits");
    let mut used = fresh.clone();
    used.push(3);
    used.lost(4);
    used.reset();
    assert_eq!(used, fresh);
    assert_eq!(used.limits(), &limits);
}

#[test]
fn the_state_is_small() {
    assert!(size_of::<Integrity>() <= 512, "{}", size_of::<Integrity>());
}

#[derive(Clone, Debug)]
enum Event {
    Push(Vec<i32>),
    Hold(i32, u16),
    Square(i32, i32, u8, u16),
    Missing(u64),
    Gap,
    Merge(Vec<Event>),
    MergeSelf,
}

fn events() -> impl Strategy<Value = Vec<Event>> {
    let count = || {
        prop_oneof![
            3 => any::<i32>(),
            3 => -20_i32..20,
            1 => prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(-32_768), Just(32_767)],
        ]
    };
    let plain = prop_oneof![
        4 => vec(count(), 0..300).prop_map(Event::Push),
        2 => (count(), any::<u16>()).prop_map(|(count, times)| Event::Hold(count, times)),
        2 => (count(), count(), 1_u8..255, any::<u16>())
            .prop_map(|(a, b, period, times)| Event::Square(a, b, period, times)),
        1 => any::<u64>().prop_map(Event::Missing),
        1 => Just(Event::Gap),
        1 => Just(Event::MergeSelf),
    ];
    let other = vec(plain.clone(), 0..4).prop_map(Event::Merge);
    vec(prop_oneof![9 => plain, 1 => other], 0..16)
}

fn play(integrity: &mut Integrity, events: &[Event]) {
    let push = |integrity: &mut Integrity, count: i32| {
        let odd = integrity.push(count);
        assert_eq!(odd.is_odd(), odd != Observation::default());
    };
    for event in events {
        match event {
            Event::Push(counts) => counts.iter().for_each(|&count| push(integrity, count)),
            Event::Hold(count, times) => (0..*times).for_each(|_| push(integrity, *count)),
            Event::Square(a, b, period, times) => (0..*times).for_each(|n| {
                let up = n / u16::from(*period) % 2 == 0;
                push(integrity, if up { *a } else { *b });
            }),
            Event::Missing(samples) => integrity.lost(*samples),
            Event::Gap => integrity.gap(),
            Event::Merge(events) => {
                let mut other = Integrity::default();
                play(&mut other, events);
                integrity.merge(&other);
            }
            Event::MergeSelf => {
                let other = integrity.clone();
                integrity.merge(&other);
            }
        }
        let tally = integrity.tally();
        assert!(tally.repeats <= tally.samples && tally.rail_hits <= tally.samples);
        assert!(tally.stuck_samples <= tally.samples);
        if let Some(reason) = integrity.verdict() {
            assert!(!reason.to_string().contains('\n'));
        }
    }
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn no_sequence_of_events_overflows(events in events(), factor in 8_u16..=256) {
        let limits = Limits {
            run_factor: factor,
            spike_factor: factor,
            motion_factor: factor,
            ..Limits::default()
        };
        play(&mut Integrity::with_limits(leaked(limits)).expect("valid limits"), &events);
    }
}

proptest! {
    #![proptest_config(seeded(20))]

    #[test]
    fn merging_counts_the_same_as_one_record_with_a_gap(first in 0_u64..50, second in 50_u64..100) {
        let (one, other) = (mems(first), mems(second));
        let mut merged = integrity(&one[..20_000]);
        merged.merge(&integrity(&other[..20_000]));
        let mut batch = integrity(&one[..20_000]);
        batch.gap();
        other[..20_000].iter().for_each(|&count| {
            batch.push(count);
        });
        prop_assert_eq!(merged.verdict(), batch.verdict());
        prop_assert_eq!(merged.tally(), batch.tally());
    }

    #[test]
    fn an_offset_changes_nothing(seed in any::<u64>(), offset in -1_000_000_i32..1_000_000) {
        let mut counts = mems(seed);
        counts[3000] = 2000;
        let limits = Limits { rails: &[i32::MIN, i32::MAX], ..Limits::default() };
        let mut plain = Integrity::with_limits(leaked(limits)).expect("valid limits");
        let mut shifted = plain.clone();
        for &count in &counts[..8000] {
            prop_assert_eq!(plain.push(count), shifted.push(count + offset));
        }
        prop_assert_eq!(plain.tally(), shifted.tally());
        prop_assert_eq!(plain.verdict(), shifted.verdict());
    }
}
