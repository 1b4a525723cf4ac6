//! Stores snapshots in a flash whose power is cut at every operation.

#[path = "common/ram_flash.rs"]
mod ram_flash;

use allanite::{
    Accumulator,
    diagnosis::Verdict,
    storage::{
        AxisCertificate, Certificate, Conditions, Error, RateUnit, SnapshotStore, StoreError,
    },
};
use pollster::block_on;
use ram_flash::{PAGE, PowerCut, RamError, RamFlash};

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

    fn lose_nothing_to_power_cuts() {
        const SNAPSHOTS: usize = 12;
        let (all, whole) = Self::run(RamFlash::new(Self::PAGES), SNAPSHOTS);
        assert_eq!(all, SNAPSHOTS);
        assert!(whole.erasures > 0, "{} pages", Self::PAGES);
        let (mut old, mut new) = (0, 0);
        for (after, &length) in whole.operations.iter().enumerate() {
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

    /// Damages a flash in many ways. What is loaded was stored, and the next save succeeds, after a reset if the store asks
    /// for one. Returns how many stores asked.
    fn accept_the_next_save_after_damage(rounds: u32) -> u32 {
        const SNAPSHOTS: usize = 8;
        let (saved, flash) = Self::run(RamFlash::new(Self::PAGES), SNAPSHOTS);
        let mut seed = 1_u64;
        let mut random = |below: usize| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        let stored: Vec<Vec<Vec<u8>>> = (0..AXES)
            .map(|axis| (0..=saved / 2).map(|n| long(axis, n)).collect())
            .collect();
        let mut resets = 0;
        for round in 0..rounds {
            let mut damaged = flash.clone();
            let bytes = &mut damaged.bytes;
            let (length, page) = (bytes.len(), random(Self::PAGES) * PAGE);
            match round % 6 {
                0 => (0..1 + random(8)).for_each(|_| bytes[random(length)] ^= 1 << random(8)),
                1 => (0..1 + random(200)).for_each(|_| bytes[random(length)] = random(256) as u8),
                2 => bytes[page..page + PAGE].fill_with(|| random(256) as u8),
                3 => bytes.fill_with(|| random(256) as u8),
                4 => bytes[page..page + PAGE].fill([0, 0xFF][random(2)]),
                _ => {
                    for page in bytes.chunks_mut(PAGE) {
                        for k in (0..16).filter(|k| k % 3 != round as usize % 4) {
                            page[k] = random(256) as u8;
                            page[PAGE - 1 - k] = random(256) as u8;
                        }
                    }
                }
            }
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
                if let Err(error) = store.save(axis, n) {
                    let is_told = matches!(
                        error,
                        StoreError::Damaged | StoreError::Flash(_) | StoreError::Full
                    );
                    assert!(is_told, "round {round}: {error}");
                    resets += 1;
                    block_on(store.0.reset()).unwrap();
                    store
                        .save(axis, n)
                        .unwrap_or_else(|error| panic!("round {round}: {error}"));
                    assert_eq!(
                        store.load(axis).unwrap(),
                        Some(long(axis, n)),
                        "round {round}"
                    );
                }
            }
        }
        resets
    }
}

#[test]
fn long_snapshots_lose_nothing_to_power_cuts() {
    Long::<2048>::lose_nothing_to_power_cuts();
    Long::<4096>::lose_nothing_to_power_cuts();
}

#[test]
fn damaged_stores_of_long_snapshots_accept_the_next_save() {
    let resets = [
        Long::<2048>::accept_the_next_save_after_damage(3000),
        Long::<4096>::accept_the_next_save_after_damage(3000),
    ];
    assert!(
        resets.iter().all(|resets| (1..3000).contains(resets)),
        "{resets:?}"
    );
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
