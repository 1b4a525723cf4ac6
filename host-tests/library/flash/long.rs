//! Stores snapshots that are longer than a page.

use super::{
    AXES,
    damage::{Damage, Random, damage},
};
use crate::common::ram_flash::{PowerCut, RamError, RamFlash};
use allanite::storage::{Error, SnapshotStore, StoreError};
use pollster::block_on;

/// The longest snapshot of three axes with every part and a spectrum.
const LONG: usize = 6412;

/// The bytes of a long snapshot of an axis.
fn long(axis: u8, n: usize) -> Vec<u8> {
    let mut random = (n as u32) << 8 | u32::from(axis);
    let byte = |_| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 24) as u8
    };
    (0..LONG - 7 * n).map(byte).collect()
}

/// Hands bytes out as a snapshot.
fn written<'b>(bytes: &[u8], buffer: &'b mut [u8]) -> Result<&'b [u8], Error> {
    let needed = bytes.len();
    let place = buffer.get_mut(..needed);
    let place = place.ok_or(Error::BufferTooSmall { needed })?;
    place.copy_from_slice(bytes);
    Ok(place)
}

/// A store of long snapshots, on pages of one size.
struct Long<const PAGE: usize>(SnapshotStore<RamFlash<PAGE>>, Vec<u8>);

impl<const PAGE: usize> Long<PAGE> {
    const PAGES: usize = SnapshotStore::<RamFlash<PAGE>>::pages(LONG, AXES as usize);

    fn new(flash: RamFlash<PAGE>) -> Self {
        let store = SnapshotStore::new(flash, 0..(Self::PAGES * PAGE) as u32).unwrap();
        Self(
            store,
            vec![0; SnapshotStore::<RamFlash<PAGE>>::buffer(LONG)],
        )
    }

    fn save(&mut self, axis: u8, n: usize) -> Result<(), StoreError<RamError>> {
        let bytes = long(axis, n);
        let Self(store, buffer) = self;
        block_on(store.save_with(axis, |buffer| written(&bytes, buffer), buffer))
    }

    fn load(&mut self, axis: u8) -> Result<Option<Vec<u8>>, StoreError<RamError>> {
        let Self(store, buffer) = self;
        let loaded = block_on(store.load_bytes(axis, buffer));
        loaded.map(|bytes| bytes.map(<[u8]>::to_vec))
    }

    /// Saves snapshots of all axes. Returns how many were saved before the power failed, and the flash.
    fn run(flash: RamFlash<PAGE>, snapshots: usize) -> (usize, RamFlash<PAGE>) {
        let mut store = Self::new(flash);
        let mut saved = 0;
        while saved < snapshots {
            let (axis, n) = ((saved % AXES as usize) as u8, saved / AXES as usize);
            match store.save(axis, n) {
                Ok(()) => saved += 1,
                Err(StoreError::Flash(RamError::NoPower)) => break,
                Err(error) => panic!("{saved}: {error}"),
            }
        }
        (saved, store.0.into_flash())
    }

    /// The number of the newest snapshot of an axis after so many saves.
    fn newest(saved: usize, axis: u8) -> Option<usize> {
        ((saved + usize::from(AXES - 1 - axis)) / usize::from(AXES)).checked_sub(1)
    }

    /// Cuts the power at every operation, or at each one of so many.
    fn lose_nothing_to_power_cuts(step: usize) {
        const SNAPSHOTS: usize = 12;
        let (all, whole) = Self::run(RamFlash::new(Self::PAGES), SNAPSHOTS);
        assert_eq!(all, SNAPSHOTS);
        assert!(whole.erasures > 0, "{} pages", Self::PAGES);
        let (mut old, mut new) = (0, 0);
        for (after, &length) in whole.operations.iter().enumerate().step_by(step) {
            for torn in [0, length / 2, length] {
                let power_cut = PowerCut { after, torn };
                let mut flash = RamFlash::new(Self::PAGES);
                flash.power_cut = Some(power_cut);
                let (saved, mut flash) = Self::run(flash, SNAPSHOTS);
                flash.power_cut = None;
                let mut store = Self::new(flash);
                for axis in 0..AXES {
                    let found = store.load(axis).unwrap();
                    let bytes = |saved| Self::newest(saved, axis).map(|n| long(axis, n));
                    if found != bytes(saved) {
                        assert_eq!(found, bytes(saved + 1), "axis {axis}, {power_cut:?}");
                        new += 1;
                    } else {
                        old += 1;
                    }
                }
                store
                    .save(0, 100)
                    .unwrap_or_else(|error| panic!("{power_cut:?}: {error}"));
                assert_eq!(store.load(0).unwrap(), Some(long(0, 100)));
                let of_other = Self::newest(saved, 1).map(|n| long(1, n));
                let found = store.load(1).unwrap();
                let more = Self::newest(saved + 1, 1).map(|n| long(1, n));
                assert!(found == of_other || found == more, "{power_cut:?}");
            }
        }
        assert!(new > 0 && old > new, "{old} old, {new} new");
    }

    /// Damages a flash in many ways. What is loaded was stored, and the next save succeeds.
    fn accept_the_next_save_after_damage(rounds: usize) {
        const SNAPSHOTS: usize = 8;
        let (saved, flash) = Self::run(RamFlash::new(Self::PAGES), SNAPSHOTS);
        let mut random = Random(1);
        let stored: Vec<Vec<Vec<u8>>> = (0..AXES)
            .map(|axis| (0..=saved / 2).map(|n| long(axis, n)).collect())
            .collect();
        for round in 0..rounds {
            let mut damaged = flash.clone();
            damage(&mut random, Damage::of(round), PAGE, &mut damaged.bytes);
            let mut store = Self::new(damaged);
            for axis in 0..AXES {
                // A snapshot has a checksum of its own. Here, its pieces are compared.
                if let Ok(Some(found)) = store.load(axis) {
                    let is_stored = stored[usize::from(axis)].contains(&found);
                    assert!(is_stored, "round {round}, axis {axis}");
                }
            }
            for n in 0..4 {
                let axis = n as u8 % AXES;
                store
                    .save(axis, n)
                    .unwrap_or_else(|error| panic!("round {round}: {error}"));
                let found = store.load(axis).unwrap();
                assert_eq!(found, Some(long(axis, n)), "round {round}");
            }
        }
    }
}

#[test]
fn long_snapshots_lose_nothing_to_power_cuts() {
    Long::<2048>::lose_nothing_to_power_cuts(3);
    Long::<4096>::lose_nothing_to_power_cuts(3);
}

#[test]
fn damaged_stores_of_long_snapshots_accept_the_next_save() {
    Long::<2048>::accept_the_next_save_after_damage(60);
    Long::<4096>::accept_the_next_save_after_damage(60);
}

mod thorough {
    use super::*;

    #[test]
    fn long_snapshots_lose_nothing_to_a_power_cut_at_any_operation() {
        Long::<2048>::lose_nothing_to_power_cuts(1);
        Long::<4096>::lose_nothing_to_power_cuts(1);
    }

    #[test]
    fn stores_of_long_snapshots_that_are_damaged_in_every_way_accept_the_next_save() {
        Long::<2048>::accept_the_next_save_after_damage(600);
        Long::<4096>::accept_the_next_save_after_damage(600);
    }
}

#[test]
fn snapshots_of_any_length_are_stored_beside_each_other() {
    let mut store = Long::<2048>::new(RamFlash::new(Long::<2048>::PAGES));
    let piece = SnapshotStore::<RamFlash<2048>>::PIECE;
    for (round, length) in [1, piece, piece + 1, 2 * piece, LONG, piece - 1, LONG - 1]
        .into_iter()
        .enumerate()
    {
        let bytes = long(1, round)[..length.min(LONG - 7 * round)].to_vec();
        let Long(flash, buffer) = &mut store;
        let saved = flash.save_with(1, |buffer| written(&bytes, buffer), buffer);
        block_on(saved).unwrap();
        assert_eq!(store.load(1).unwrap(), Some(bytes), "{length}");
        store.save(0, round).unwrap();
    }
    assert_eq!(store.load(0).unwrap(), Some(long(0, 6)));
    let too_long = vec![7; 101 * piece];
    let Long(flash, _) = &mut store;
    let mut buffer = vec![0; 2 * too_long.len()];
    let refused = block_on(flash.save_with(1, |buffer| written(&too_long, buffer), &mut buffer));
    let (found, longest) = (too_long.len(), 100 * piece);
    assert_eq!(refused, Err(StoreError::TooLong { found, longest }));
    let small = block_on(flash.load_bytes(0, &mut buffer[..LONG]));
    assert!(
        matches!(small, Err(StoreError::BufferTooSmall { .. })),
        "{small:?}"
    );
}
