//! Snapshots are exact, and are refused if anything has changed.

use crate::common::precision::double;
use crate::common::sealed::sealed;
use crate::common::seeded::seeded;
use allanite::{
    Accumulator, Scale,
    storage::{Error, Snapshot, SnapshotInterval},
};
use proptest::{collection::vec, prelude::*};
use std::num::NonZeroU64;

fn snapshot<const OCTAVES: usize>(accumulator: &Accumulator<OCTAVES>) -> Vec<u8> {
    let mut buffer = vec![0; Accumulator::<OCTAVES>::SNAPSHOT_BYTES];
    accumulator.snapshot(&mut buffer).unwrap().to_vec()
}

/// Counts that look like noise.
fn noise(seed: u32) -> impl Iterator<Item = i32> {
    let step = |random: &u32| Some(random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    std::iter::successors(Some(seed), step).map(|random| (random >> 20) as i32 - 2048)
}

fn recorded<const OCTAVES: usize>(samples: usize) -> Accumulator<OCTAVES> {
    let mut accumulator = Accumulator::new();
    accumulator.push_slice(&noise(1).take(samples).collect::<Vec<_>>());
    accumulator
}

/// Checks that an accumulator is restored from its snapshot in its state after a gap, and that both
/// continue alike.
fn check<const OCTAVES: usize>(stretches: &[Vec<i32>], later: &[i32]) {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    for (i, stretch) in stretches.iter().enumerate() {
        if i > 0 {
            accumulator.gap();
        }
        accumulator.push_slice(stretch);
    }
    let before = accumulator.clone();
    let bytes = snapshot(&accumulator);
    assert_eq!(accumulator, before);
    assert!(bytes.len() <= Accumulator::<OCTAVES>::SNAPSHOT_BYTES);

    let mut restored = Accumulator::<OCTAVES>::restore(&bytes).unwrap();
    accumulator.gap();
    assert_eq!(restored, accumulator);
    let read = Snapshot::open(&bytes).unwrap();
    assert_eq!(read.samples(), accumulator.samples());
    assert_eq!(read.gaps(), accumulator.gaps());
    assert!(read.octaves().eq(accumulator.octaves()));

    restored.push_slice(later);
    accumulator.push_slice(later);
    let scale = Scale::new(0.01, 100.0).unwrap();
    assert_eq!(restored.curve(scale), accumulator.curve(scale));
    assert_eq!(snapshot(&restored), snapshot(&accumulator));
}

fn stretches() -> impl Strategy<Value = Vec<Vec<i32>>> {
    let count = prop_oneof![-100..100, any::<i32>(), Just(i32::MIN), Just(i32::MAX)];
    vec(vec(count, 0..600), 0..4)
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn restored_accumulator_equals_the_old_one_after_a_gap(
        stretches in stretches(),
        later in vec(any::<i32>(), 0..300),
    ) {
        check::<2>(&stretches, &later);
        check::<13>(&stretches, &later);
        check::<20>(&stretches, &later);
        check::<30>(&stretches, &later);
    }

    #[test]
    fn arbitrary_bytes_are_refused(bytes in vec(any::<u8>(), 0..400)) {
        prop_assert!(Accumulator::<20>::restore(&bytes).is_err());
        let mut bytes = bytes;
        bytes.splice(0..0, *b"ALNT");
        prop_assert!(Accumulator::<20>::restore(&bytes).is_err());
    }
}

#[test]
fn record_merged_beyond_all_counters_is_restored() {
    let mut accumulator = recorded::<13>(1 << 14);
    for doublings in 0..70 {
        let restored = Accumulator::<13>::restore(&snapshot(&accumulator)).unwrap();
        accumulator.gap();
        assert_eq!(restored, accumulator, "{doublings} doublings");
        accumulator.merge(&restored);
    }
    assert_eq!(accumulator.samples(), u64::MAX);
}

#[test]
fn every_change_of_one_byte_is_refused() {
    let bytes = snapshot(&recorded::<20>(100_000));
    let mut changed = bytes.clone();
    for i in 0..bytes.len() {
        for difference in 1..=u8::MAX {
            changed[i] = bytes[i] ^ difference;
            let error = Accumulator::<20>::restore(&changed).unwrap_err();
            let expected = match i {
                0..4 => matches!(error, Error::UnknownMagic),
                6..8 => matches!(error, Error::WrongLength { .. }),
                _ => error == Error::Corrupt,
            };
            assert!(expected, "byte {i} ^ {difference}: {error:?}");
        }
        changed[i] = bytes[i];
    }
}

#[test]
fn every_missing_and_every_additional_byte_is_refused() {
    let mut bytes = snapshot(&recorded::<20>(100_000));
    for length in 0..bytes.len() {
        let error = Accumulator::<20>::restore(&bytes[..length]).unwrap_err();
        let wrong = matches!(error, Error::WrongLength { found, .. } if found == length);
        assert!(wrong, "{length} bytes: {error:?}");
    }
    bytes.push(0);
    let error = Accumulator::<20>::restore(&bytes).unwrap_err();
    assert!(matches!(error, Error::WrongLength { .. }), "{error:?}");
}

#[test]
fn snapshot_of_twenty_octaves_takes_a_quarter_of_a_kilobyte() {
    let accumulator = recorded::<20>(1 << 22);
    assert_eq!(snapshot(&accumulator).len(), 252);
    assert_eq!(Accumulator::<20>::SNAPSHOT_BYTES, 913);
}

#[test]
fn buffer_that_is_too_small_is_refused() {
    let accumulator = recorded::<20>(100_000);
    let length = snapshot(&accumulator).len();
    let mut buffer = vec![0; length];
    assert_eq!(accumulator.snapshot(&mut buffer).unwrap().len(), length);
    let needed = Accumulator::<20>::SNAPSHOT_BYTES;
    for shorter in 0..length {
        let error = accumulator.snapshot(&mut buffer[..shorter]).unwrap_err();
        assert_eq!(error, Error::BufferTooSmall { needed });
    }
}

#[test]
fn other_kind_version_and_number_of_octaves_are_named() {
    let bytes = snapshot(&recorded::<20>(1000));
    let restore = |bytes: &[u8]| Accumulator::<20>::restore(bytes).unwrap_err();
    let kind = restore(&sealed(2, 1, &bytes[8..bytes.len() - 4]));
    assert_eq!(
        kind,
        Error::WrongKind {
            found: 2,
            wanted: 1
        }
    );
    let version = restore(&sealed(1, 2, &bytes[8..bytes.len() - 4]));
    assert_eq!(version, Error::UnknownVersion { found: 2, known: 7 });
    let octaves = restore(&snapshot(&recorded::<19>(1000)));
    assert_eq!(
        octaves,
        Error::WrongOctaves {
            found: 19,
            wanted: 20
        }
    );
    for error in [
        kind,
        version,
        octaves,
        Error::UnknownMagic,
        Error::Corrupt,
        Error::Impossible,
    ] {
        let line = error.to_string();
        assert!(line.contains(": ") && !line.contains('\n'), "{line}");
    }
}

#[test]
fn contents_that_no_record_has_are_refused() {
    // The snapshot has two octaves of one stretch of 4 samples, with 3 differences and 1.
    let possible = [2, 4, 1, 3, 9, 0, 0, 1, 4, 0, 0];
    let restore = |payload: &[u8]| Accumulator::<2>::restore(&sealed(1, 1, payload));
    assert_eq!(restore(&possible).unwrap().samples(), 4);
    let change = |i: usize, value: u8| {
        let mut payload = possible;
        payload[i] = value;
        restore(&payload)
    };
    // The changes are too many octaves, no octaves, and other numbers of samples, gaps and
    // differences.
    for (i, value) in [
        (0, 3),
        (0, 1),
        (0, 31),
        (1, 0),
        (1, 5),
        (2, 0),
        (2, 5),
        (3, 4),
        (7, 0),
    ] {
        assert_eq!(
            change(i, value).unwrap_err(),
            Error::Impossible,
            "{i}: {value}"
        );
    }
    // The sums exceed what three differences of 32 bits can give, and 158 bits.
    assert!(change(5, 2).is_ok());
    assert_eq!(change(5, 3).unwrap_err(), Error::Impossible);
    assert_eq!(change(6, 1).unwrap_err(), Error::Impossible);
    // Without differences, the sum must be zero.
    assert!(restore(&[2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]).is_ok());
    assert_eq!(
        restore(&[2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]),
        Err(Error::Impossible)
    );
    // The bytes are too few or too many.
    assert_eq!(restore(&possible[..10]), Err(Error::Impossible));
    assert_eq!(
        restore(&[&possible[..], &[0]].concat()),
        Err(Error::Impossible)
    );
}

#[test]
fn arbitrary_contents_are_refused_or_give_a_valid_snapshot() {
    let bytes = snapshot(&recorded::<13>(1000));
    let payload = &bytes[8..bytes.len() - 4];
    let mut accepted = 0;
    for i in 0..payload.len() {
        for value in 0..=u8::MAX {
            let mut payload = payload.to_vec();
            payload[i] = value;
            match Accumulator::<13>::restore(&sealed(1, 7, &payload)) {
                Ok(restored) => {
                    let again = Accumulator::restore(&snapshot(&restored));
                    assert_eq!(again, Ok(restored), "byte {i} = {value}");
                    accepted += 1;
                }
                Err(Error::Impossible | Error::WrongOctaves { .. }) => {}
                Err(error) => panic!("byte {i} = {value}: {error:?}"),
            }
        }
    }
    assert!(accepted > payload.len());
}

#[test]
fn format_has_not_changed_since_it_was_frozen() {
    let mut accumulator = Accumulator::<3>::new();
    accumulator.push_slice(&[3, -1, 4, 1_000_000, -5, 9, 2, 6, -5, 3]);
    accumulator.gap();
    accumulator.push_slice(&[i32::MIN, i32::MAX, i32::MIN]);
    let hex: String = snapshot(&accumulator)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    assert_eq!(hex, FROZEN);
    accumulator.gap();
    let restored = |hex: &str| {
        let bytes: Vec<u8> = (0..hex.len())
            .step_by(2)
            .map(|i| u8::from_str_radix(&hex[i..i + 2], 16).unwrap())
            .collect();
        Accumulator::<3>::restore(&bytes).unwrap()
    };
    assert_eq!(restored(FROZEN), accumulator);
    let scale = Scale::new(1.0, 100.0).unwrap();
    assert!(accumulator.mean_rate(scale).is_some());
    // An earlier one has the same octaves, and no mean.
    let earlier = restored(EARLIER);
    assert_eq!(earlier.samples(), accumulator.samples());
    assert!(earlier.octaves().eq(accumulator.octaves()));
    assert_eq!(earlier.mean_rate(scale), None);
}

#[test]
fn the_mean_is_that_of_all_samples_across_gaps_snapshots_and_merged_records() {
    let scale = Scale::new(0.5, 100.0).unwrap();
    let mut accumulator = Accumulator::<10>::new();
    assert_eq!(accumulator.mean_rate(scale), None);
    let counts: Vec<i32> = noise(5).take(5000).collect();
    let mean = 0.5 * counts.iter().map(|&count| f64::from(count)).sum::<f64>() / 5000.0;
    let is_mean = |accumulator: &Accumulator<10>, tolerance: f64| {
        let found = double(accumulator.mean_rate(scale).unwrap());
        assert!((found - mean).abs() < tolerance, "{found} {mean}");
    };
    accumulator.push_slice(&counts[..2000]);
    accumulator.gap();
    accumulator.push_slice(&counts[2000..3000]);
    let mut other = Accumulator::restore(&snapshot(&accumulator)).unwrap();
    let mut last = Accumulator::new();
    last.push_slice(&counts[3000..]);
    other.merge(&last);
    is_mean(&other, 1e-4);
    // Values that fill the place of lost samples are means of those before.
    last.lost(3);
    last.push_slice(&counts);
    other = accumulator;
    other.push_slice(&counts[3000..4000]);
    other.lost(2);
    other.push_slice(&counts[4000..]);
    is_mean(&other, 0.5 * 1200.0 * 2.0 / 5000.0);
}

/// Snapshots of three octaves with 10 and 3 samples, in versions 7 and 1 of the format.
const FROZEN: &str = "414c4e5401072300030d020b92cda2cbda390200079cbed3ffb474000003ecbfa7dea7570000e1f685ff0f7a800539";
const EARLIER: &str =
    "414c4e5401011e00030d020b92cda2cbda390200079cbed3ffb474000003ecbfa7dea757000085b0d929";

#[test]
fn snapshot_interval_counts_from_the_current_sample() {
    let mut interval = SnapshotInterval::new(NonZeroU64::new(100).unwrap(), 1050);
    let due: Vec<u64> = (1051..1400)
        .filter(|&samples| interval.is_due(samples))
        .collect();
    assert_eq!(due, [1150, 1250, 1350]);
    assert!(interval.is_due(5), "reset");
    assert!(!interval.is_due(5));
}
