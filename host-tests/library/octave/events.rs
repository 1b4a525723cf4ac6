//! Events that can happen to a record.

use super::definition::{Record, octaves};
use allanite::Accumulator;
use proptest::{collection::vec, prelude::*};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A kind of stretch of counts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Counts {
    /// Any 32-bit counts, with full-scale ones among them.
    Wide { seed: u64 },
    /// The counts of a gyro at rest.
    Small { seed: u64 },
    /// Full scale with alternating sign.
    Square { half_period: usize },
}

impl Counts {
    pub(crate) fn take(self, len: usize) -> Vec<i32> {
        match self {
            Self::Wide { seed } => {
                let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
                let mut next = || match random.next_u32() {
                    bits if bits % 16 == 0 => i32::MIN,
                    bits if bits % 16 == 1 => i32::MAX,
                    bits => bits.rotate_left(7) as i32,
                };
                (0..len).map(|_| next()).collect()
            }
            Self::Small { seed } => {
                let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
                (0..len)
                    .map(|_| (random.next_u32() % 41) as i32 - 20)
                    .collect()
            }
            Self::Square { half_period } => (0..len)
                .map(|i| {
                    if i / half_period % 2 == 0 {
                        i32::MIN
                    } else {
                        i32::MAX
                    }
                })
                .collect(),
        }
    }
}

pub(crate) fn counts(longest: usize) -> impl Strategy<Value = Vec<i32>> {
    let shape = prop_oneof![
        any::<u64>().prop_map(|seed| Counts::Wide { seed }),
        any::<u64>().prop_map(|seed| Counts::Small { seed }),
        (1_usize..200).prop_map(|half_period| Counts::Square { half_period }),
    ];
    (shape, 0..=longest).prop_map(|(shape, len)| shape.take(len))
}

/// An event that happens to an accumulator.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    Push(Vec<i32>),
    PushSlice(Vec<i32>),
    Gap,
    Lost(u64),
    Read,
    Merge(Vec<Event>),
    /// The accumulator so far is merged into another one that has seen these events.
    MergeInto(Vec<Event>),
    Reset,
}

fn lost() -> impl Strategy<Value = Event> {
    prop_oneof![4 => 0..9_u64, 2 => 0..70_u64, 1 => any::<u64>()].prop_map(Event::Lost)
}

pub(crate) fn events() -> impl Strategy<Value = Vec<Event>> {
    let plain = prop_oneof![
        3 => counts(30).prop_map(Event::Push),
        3 => counts(30).prop_map(Event::PushSlice),
        2 => counts(900).prop_map(Event::PushSlice),
        1 => Just(Event::Gap),
        3 => lost(),
        2 => Just(Event::Read),
    ];
    let other = || {
        vec(
            prop_oneof![
                2 => counts(300).prop_map(Event::PushSlice),
                1 => Just(Event::Gap),
                1 => lost(),
            ],
            0..4,
        )
    };
    vec(
        prop_oneof![
            20 => plain,
            1 => other().prop_map(Event::Merge),
            1 => other().prop_map(Event::MergeInto),
            1 => Just(Event::Reset),
        ],
        0..24,
    )
}

pub(crate) fn play<const K: usize>(events: &[Event]) -> (Accumulator<K>, Record) {
    let (mut accumulator, mut record) = (Accumulator::<K>::new(), Record::default());
    for event in events {
        match event {
            Event::Push(counts) => {
                counts.iter().for_each(|&count| accumulator.push(count));
                record.running.counts.extend(counts);
            }
            Event::PushSlice(counts) => {
                accumulator.push_slice(counts);
                record.running.counts.extend(counts);
            }
            Event::Gap => {
                accumulator.gap();
                record.gap();
            }
            Event::Lost(samples) => {
                accumulator.lost(*samples);
                record.lost(*samples, K);
            }
            Event::Read => check(&accumulator, &record),
            Event::Merge(events) => {
                let (other, other_record) = play(events);
                accumulator.merge(&other);
                record.merge(other_record);
            }
            Event::MergeInto(events) => {
                let (mut other, mut other_record) = play(events);
                other.merge(&accumulator);
                other_record.merge(record);
                (accumulator, record) = (other, other_record);
            }
            Event::Reset => {
                accumulator.reset();
                record = Record::default();
            }
        }
    }
    (accumulator, record)
}

pub(crate) fn check<const K: usize>(accumulator: &Accumulator<K>, record: &Record) {
    assert_eq!(octaves(accumulator), record.octaves(K));
    assert_eq!(accumulator.samples(), record.samples(), "samples");
    assert_eq!(accumulator.gaps(), record.gaps, "gaps");
    assert_eq!(accumulator.bridged().lost(), record.filled(), "filled");
    assert!(accumulator.bridged().is_possible());
}
