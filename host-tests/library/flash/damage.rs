//! Damages stores at random. Every one of them saves again, and keeps what was not damaged.

use super::{AXES, Axis, OCTAVES, PAGES, buffer, newest, run, states, store};
use crate::common::ram_flash::{PAGE, PowerCut, RamFlash};
use allanite::storage::{SnapshotStore, StoreError};
use pollster::block_on;

/// Random numbers of a linear congruential generator.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, below: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % below
    }

    fn byte(&mut self) -> u8 {
        self.below(256) as u8
    }
}

/// What happens to a flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Damage {
    FlippedBits,
    Bytes,
    Page,
    AllPages,
    ErasedOrZeroedPage,
    EndsOfPages,
}

impl Damage {
    pub(crate) fn of(round: usize) -> Self {
        match round % 6 {
            0 => Self::FlippedBits,
            1 => Self::Bytes,
            2 => Self::Page,
            3 => Self::AllPages,
            4 => Self::ErasedOrZeroedPage,
            _ => Self::EndsOfPages,
        }
    }
}

pub(crate) fn damage(random: &mut Random, kind: Damage, page: usize, bytes: &mut [u8]) {
    let length = bytes.len();
    let start = random.below(length / page) * page;
    let one = start..start + page;
    match kind {
        Damage::FlippedBits => {
            (0..1 + random.below(8))
                .for_each(|_| bytes[random.below(length)] ^= 1 << random.below(8));
        }
        Damage::Bytes => {
            (0..1 + random.below(200)).for_each(|_| bytes[random.below(length)] = random.byte());
        }
        Damage::Page => bytes[one].fill_with(|| random.byte()),
        Damage::AllPages => bytes.fill_with(|| random.byte()),
        Damage::ErasedOrZeroedPage => bytes[one].fill([0, 0xFF][random.below(2)]),
        Damage::EndsOfPages => {
            for bytes in bytes.chunks_mut(page) {
                for k in (0..16).filter(|_| random.below(3) == 0).collect::<Vec<_>>() {
                    bytes[k] = random.byte();
                    bytes[page - 1 - k] = random.byte();
                }
            }
        }
    }
}

/// The number of saves after which the newest snapshot of an axis was stored that damage left as it was.
fn undamaged(
    states: &[[Axis; AXES as usize]],
    saved: usize,
    axis: u8,
    before: &[u8],
    after: &[u8],
) -> Option<usize> {
    /// The checksum and the length before an item.
    const HEADER: usize = 8;
    (1..=saved).rev().find(|saved| {
        let (count, of) = (
            (saved - 1) / usize::from(AXES),
            (saved - 1) % usize::from(AXES),
        );
        let mut encoded = buffer();
        let snapshot = states[count][of].snapshot(&mut encoded).unwrap();
        let item = [&[axis, 255, 0], snapshot].concat();
        let places = before.windows(item.len()).enumerate();
        let mut places = places.filter(|(_, bytes)| *bytes == item);
        let is_whole = |start: usize| {
            let place = start - HEADER..start + item.len();
            before[place.clone()] == after[place]
        };
        of == usize::from(axis) && places.any(|(start, _)| is_whole(start))
    })
}

fn saves(store: &mut SnapshotStore<RamFlash>, axis: u8, state: &Axis) {
    block_on(store.save(axis, state, &mut buffer())).unwrap();
    let found: Option<Axis> = block_on(store.load(axis, &mut buffer())).unwrap();
    let mut wanted = state.clone();
    wanted.gap();
    assert_eq!(found, Some(wanted));
}

/// The number of stores in which an undamaged snapshot of the other axis was still lost, for each kind of damage.
fn lost(rounds: usize, overwrites: bool) -> Vec<(Damage, usize)> {
    let states = states();
    let mut lost: Vec<_> = (0..6).map(|round| (Damage::of(round), 0)).collect();
    for round in 0..rounds {
        let (mut random, kind) = (Random(round as u64), Damage::of(round));
        // At any time of the life of a store.
        let (saved, mut flash) = run(RamFlash::new(PAGES), &states[..4 + random.below(36)]);
        flash.overwrites = overwrites;
        let before = flash.bytes.clone();
        damage(&mut random, kind, PAGE, &mut flash.bytes);
        let kept = undamaged(&states, saved, 1, &before, &flash.bytes);
        flash.operations.clear();
        let mut store = store(flash);
        saves(&mut store, 0, &states[0][0]);
        match block_on(store.load::<OCTAVES>(1, &mut buffer())) {
            Ok(None) | Err(StoreError::Damaged) => {
                lost[round % 6].1 += usize::from(kept.is_some());
            }
            Ok(found) => {
                let mut stored = (1..=saved).map(|saved| newest(&states, saved, 1));
                assert!(stored.any(|one| one == found), "{round}, {kind:?}");
                let is_newest = kept.is_none_or(|kept| found == newest(&states, kept, 1));
                lost[round % 6].1 += usize::from(!is_newest);
            }
            Err(error) => panic!("{round}, {kind:?}: {error}"),
        }
        for n in 0..20 {
            saves(&mut store, n % AXES, &states[usize::from(n)][1]);
        }
        let operations = store.into_flash().operations.len();
        assert!(operations < 300, "{round}, {kind:?}: {operations}");
    }
    lost
}

#[test]
fn damaged_store_saves_again_and_keeps_what_was_not_damaged() {
    // Most flash does not notice that a word is not erased before it is written.
    for overwrites in [false, true] {
        let rounds = 900;
        for (kind, lost) in lost(rounds, overwrites) {
            // If the ends of all pages are damaged, their order may be lost.
            let most = if kind == Damage::EndsOfPages {
                rounds / 6 / 20
            } else {
                0
            };
            assert!(lost <= most, "{kind:?}: {lost} of {}", rounds / 6);
        }
    }
}

/// The power may fail while a store repairs its pages.
#[test]
fn damaged_store_saves_again_after_a_power_cut() {
    let states = states();
    let mut cuts = 0;
    for round in 0..1200 {
        let (mut random, kind) = (Random(round as u64), Damage::of(round));
        let (_, mut flash) = run(RamFlash::new(PAGES), &states[..4 + random.below(36)]);
        damage(&mut random, kind, PAGE, &mut flash.bytes);
        flash.operations.clear();
        let (after, torn) = (random.below(8), random.below(PAGE));
        flash.power_cut = Some(PowerCut { after, torn });
        let mut cut = store(flash);
        cuts += usize::from(block_on(cut.save(0, &states[0][0], &mut buffer())).is_err());
        let mut flash = cut.into_flash();
        flash.power_cut = None;
        let mut store = store(flash);
        for axis in 0..AXES {
            saves(&mut store, axis, &states[1][usize::from(axis)]);
        }
    }
    assert!(cuts > 400, "{cuts}");
}
