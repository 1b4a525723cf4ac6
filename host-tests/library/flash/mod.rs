//! Stores snapshots in a flash whose power is cut at every operation.

mod damage;
mod long;

use crate::common::ram_flash::{PAGE, PowerCut, RamError, RamFlash};
use allanite::{
    Accumulator,
    diagnosis::Verdict,
    storage::{
        AxisCertificate, Certificate, Conditions, Error, RateUnit, SnapshotStore, StoreError,
    },
};
use pollster::block_on;

const OCTAVES: usize = 13;
const AXES: u8 = 2;
/// The number of snapshots of both axes that a run writes. It is large enough for pages to be
/// erased and used again.
const SNAPSHOTS: usize = 40;
const PAGES: usize = 3;

type Axis = Accumulator<OCTAVES>;

fn buffer() -> Vec<u8> {
    vec![0; SnapshotStore::<RamFlash>::buffer(Axis::SNAPSHOT_BYTES)]
}

fn store(flash: RamFlash) -> SnapshotStore<RamFlash> {
    SnapshotStore::new(flash, 0..(PAGES * PAGE) as u32).unwrap()
}

/// The accumulator of each axis at each of its snapshots.
fn states() -> Vec<[Axis; AXES as usize]> {
    let mut axes = [Axis::new(), Axis::new()];
    let mut random = 1_u32;
    (0..SNAPSHOTS)
        .map(|_| {
            for _ in 0..500 {
                for axis in &mut axes {
                    random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    axis.push((random >> 20) as i32 - 2048);
                }
            }
            axes.clone()
        })
        .collect()
}

/// Saves the snapshots one after the other. Returns how many were saved before the power failed,
/// and the flash.
fn run(flash: RamFlash, states: &[[Axis; AXES as usize]]) -> (usize, RamFlash) {
    let mut store = store(flash);
    let mut saved = 0;
    'all: for axes in states {
        for (axis, accumulator) in (0..AXES).zip(axes) {
            match block_on(store.save(axis, accumulator, &mut buffer())) {
                Ok(()) => saved += 1,
                Err(StoreError::Flash(_)) => break 'all,
                Err(error) => panic!("{error}"),
            }
        }
    }
    (saved, store.into_flash())
}

/// The accumulator that is restored for an axis.
fn load(store: &mut SnapshotStore<RamFlash>, axis: u8) -> Option<Axis> {
    block_on(store.load(axis, &mut buffer())).unwrap()
}

/// The newest snapshot of an axis after the given number of saves, in its state after a gap.
fn newest(states: &[[Axis; AXES as usize]], saved: usize, axis: u8) -> Option<Axis> {
    let count = (saved + usize::from(AXES - 1 - axis)) / usize::from(AXES);
    let mut newest = states[count.checked_sub(1)?][usize::from(axis)].clone();
    newest.gap();
    Some(newest)
}

#[test]
fn newest_snapshot_of_each_axis_is_restored() {
    let states = states();
    for count in 0..=SNAPSHOTS {
        let (saved, flash) = run(RamFlash::new(PAGES), &states[..count]);
        assert_eq!(saved, count * usize::from(AXES));
        let mut store = store(flash);
        for axis in 0..AXES {
            assert_eq!(load(&mut store, axis), newest(&states, saved, axis));
        }
        assert_eq!(load(&mut store, AXES), None);
    }
}

#[test]
fn power_cut_at_any_operation_leaves_the_old_or_the_new_snapshot() {
    let states = states();
    let (all, whole) = run(RamFlash::new(PAGES), &states);
    assert_eq!(all, SNAPSHOTS * usize::from(AXES));
    assert!(whole.erasures > 2 * PAGES, "{} erasures", whole.erasures);
    let (mut old, mut new) = (0, 0);
    for (after, &length) in whole.operations.iter().enumerate() {
        for torn in torn(length) {
            let power_cut = PowerCut { after, torn };
            let mut flash = RamFlash::new(PAGES);
            flash.power_cut = Some(power_cut);
            let (saved, mut flash) = run(flash, &states);
            flash.power_cut = None;
            let interrupted = (saved % usize::from(AXES)) as u8;
            let mut store = store(flash);
            for axis in 0..AXES {
                let found = load(&mut store, axis);
                let before = newest(&states, saved, axis);
                if axis == interrupted && saved < all && found == newest(&states, saved + 1, axis) {
                    new += 1;
                } else {
                    assert_eq!(found, before, "axis {axis}, {power_cut:?}, {saved} saved");
                    old += 1;
                }
            }
            // The store must also keep working afterwards.
            let last = states.last().unwrap();
            for (axis, accumulator) in (0..AXES).zip(last) {
                block_on(store.save(axis, accumulator, &mut buffer()))
                    .unwrap_or_else(|error| panic!("{power_cut:?}: {error}"));
            }
            for axis in 0..AXES {
                assert_eq!(load(&mut store, axis), newest(&states, all, axis));
            }
        }
    }
    assert!(new > 0 && old > new, "{old} old, {new} new");
}

/// The numbers of bytes that an interrupted operation changes: every possible number for a write,
/// and a selection for an erasure.
fn torn(length: usize) -> impl Iterator<Item = usize> {
    let step = if length < PAGE { 1 } else { 31 };
    (0..=length).step_by(step).chain([length])
}

/// A certificate has a number of its own in the same store, where snapshots are written around it.
#[test]
fn certificate_stays_beside_snapshots_that_come_and_go() {
    const NUMBER: u8 = AXES;
    let conditions = Conditions {
        temperature_c: None,
        duration_s: 100.0,
        rate_hz: 100.0,
        samples: 10_000,
        gaps: 0,
    };
    let unit = RateUnit::DegreesPerSecond;
    let mut certificate = Certificate::new(b"SN-7", [1, 0, 0], conditions, unit).unwrap();
    let mut axis = AxisCertificate::empty();
    axis.verdict = Some(Verdict::TooShort);
    axis.findings.events = Some(Default::default());
    certificate.axes.push(axis).unwrap();
    let mut buffer = vec![0; PAGE];
    let mut encoded = vec![0; Certificate::MAX_BYTES];
    let written = certificate.encode(&mut encoded).unwrap();

    let mut store = store(RamFlash::new(PAGES));
    let saved = store.save_with(NUMBER, |buffer| certificate.encode(buffer), &mut buffer);
    block_on(saved).unwrap();
    let (saved, flash) = run(store.into_flash(), &states());
    assert_eq!(saved, SNAPSHOTS * usize::from(AXES));
    let mut store = self::store(flash);
    let read = block_on(store.load_bytes(NUMBER, &mut buffer)).unwrap();
    assert_eq!(read, Some(written));
    let read = Certificate::decode(read.unwrap()).unwrap();
    assert_eq!(read.axes[0].findings.is_stationary(), Some(true));
}

#[test]
fn damage_in_flash_is_never_restored() {
    let states = states();
    let (saved, flash) = run(RamFlash::new(PAGES), &states);
    for i in 0..flash.bytes.len() {
        for bit in 0..8 {
            let mut damaged = flash.clone();
            damaged.bytes[i] ^= 1 << bit;
            let mut store = store(damaged);
            for axis in 0..AXES {
                // The result may be an older snapshot, none or an error, but never a state that was
                // not stored.
                if let Ok(Some(found)) = block_on(store.load::<OCTAVES>(axis, &mut buffer())) {
                    let mut stored = (1..=saved).filter_map(|saved| newest(&states, saved, axis));
                    assert!(stored.any(|one| one == found), "byte {i}, bit {bit}");
                }
            }
        }
    }
}

#[test]
fn impossible_range_and_small_buffer_are_refused() {
    for range in [0..0, 0..PAGE as u32, 7..4096, 0..4 * PAGE as u32] {
        let store = SnapshotStore::new(RamFlash::<PAGE>::new(PAGES), range.clone());
        assert!(matches!(store, Err(StoreError::InvalidRange)), "{range:?}");
    }
    let mut store = store(RamFlash::new(PAGES));
    let states = states();
    let save = block_on(store.save(0, &states[0][0], &mut [0; 64]));
    let is_small = |error: &StoreError<RamError>| {
        matches!(
            error,
            StoreError::Snapshot(Error::BufferTooSmall { .. }) | StoreError::BufferTooSmall { .. }
        )
    };
    assert!(save.as_ref().is_err_and(is_small), "{save:?}");
    assert_eq!(load(&mut store, 0), None);
    block_on(store.save(0, &states[0][0], &mut buffer())).unwrap();
    let other = block_on(store.load::<20>(0, &mut buffer()));
    let wanted = Error::WrongOctaves {
        found: OCTAVES,
        wanted: 20,
    };
    assert!(matches!(other, Err(StoreError::Snapshot(error)) if error == wanted));
}
