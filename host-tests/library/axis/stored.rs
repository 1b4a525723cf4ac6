//! Axes after a reset, a merge, or a snapshot that is restored.

use super::{Counts, OCTAVES, Whole, plan, rest, scale};
use crate::common::seeded::seeded;
use allanite::{
    Axes, Axis,
    axis::{Courses, GatePart},
    integrity::Limits,
    self_test::{Plan, SelfTest},
    storage::Error,
};
use proptest::{collection::vec, prelude::*};

#[test]
fn limits_survive_a_reset() {
    static LIMITS: Limits = Limits {
        spike_factor: 200,
        ..Limits::DEFAULT
    };
    let mut axes = Axes::<OCTAVES, 1>::with_limits(&LIMITS).unwrap();
    let fresh = axes.clone();
    rest()
        .iter()
        .take(500)
        .for_each(|&sample| axes.push(sample));
    axes.reset();
    assert_eq!((&axes, axes.limits()), (&fresh, &LIMITS));
    static IMPOSSIBLE: Limits = Limits {
        spike_factor: 2,
        ..Limits::DEFAULT
    };
    assert!(Axes::<OCTAVES>::with_limits(&IMPOSSIBLE).is_err());
}

#[test]
fn snapshots_of_other_parts_and_plans_are_refused_and_leave_nothing() {
    let mut gyro = Axes::<OCTAVES, 1>::new();
    rest()
        .iter()
        .take(5000)
        .for_each(|&sample| gyro.push(sample));
    let test = SelfTest::<OCTAVES>::new(plan(), scale()).unwrap();
    let mut buffer = [0; 16_384];
    let stored = gyro
        .snapshot(std::slice::from_ref(&test), &mut buffer)
        .unwrap();

    let mut other = Axes::<OCTAVES, 1>::new();
    assert_eq!(other.restore(&mut [], stored), Err(Error::OtherParts));
    let longer = Plan {
        longest_s: 200.0,
        ..plan()
    };
    let mut tests = [SelfTest::<OCTAVES>::new(longer, scale()).unwrap()];
    assert_eq!(other.restore(&mut tests, stored), Err(Error::OtherPlan));
    assert_eq!(other, Axes::new());
    let mut tests = [test];
    let mut without = Axes::<OCTAVES, 1, ()>::new();
    assert_eq!(without.restore(&mut tests, stored), Err(Error::OtherParts));
    let mut without = Axes::<OCTAVES, 0>::new();
    assert_eq!(without.restore(&mut tests, stored), Err(Error::OtherParts));
    let mut fewer = Axes::<10, 1>::new();
    let refused = fewer.restore(&mut [], stored).unwrap_err();
    let octaves = Error::WrongOctaves {
        found: OCTAVES,
        wanted: 10,
    };
    assert_eq!(refused, octaves);
    for length in 0..stored.len() {
        assert!(other.restore(&mut tests, &stored[..length]).is_err());
    }
    assert_eq!(other.restore(&mut tests, stored), Ok(()));
}

#[test]
fn snapshot_of_an_accumulator_is_restored_into_an_axis_without_other_parts() {
    let mut accumulator = allanite::Accumulator::<OCTAVES>::new();
    accumulator.push_slice(&[3, 1, -2, 4, 0, 7, 2, 2]);
    let mut buffer = [0; 1000];
    let stored = accumulator.snapshot(&mut buffer).unwrap();
    let mut axis = Axis::<OCTAVES, 0, (), ()>::new();
    axis.restore(&mut [], stored).unwrap();
    accumulator.gap();
    assert_eq!(axis.accumulators(), [&accumulator]);
    let mut more = Axis::<OCTAVES>::new();
    assert_eq!(more.restore(&mut [], stored), Err(Error::OtherParts));
}

/// Stretches of three axes and a covariate with any counts.
fn stretches() -> impl Strategy<Value = Vec<Vec<Counts>>> {
    let count = || prop_oneof![4 => -100..100, 1 => any::<i32>(), 1 => Just(i32::MIN)];
    let sample = ([count(), count(), count()], [count()]);
    vec(vec(sample, 0..300), 1..4)
}

proptest! {
    #![proptest_config(seeded(60))]

    #[test]
    fn merging_and_restoring_are_gaps(stretches in stretches(), gated in any::<bool>()) {
        if gated {
            merge_and_restore::<allanite::axis::Gated>(&stretches)?;
        } else {
            merge_and_restore::<()>(&stretches)?;
        }
    }
}

fn merge_and_restore<G: GatePart>(stretches: &[Vec<Counts>]) -> Result<(), TestCaseError> {
    type Gyro<G> = Whole<G, Courses>;
    let mut batch = Gyro::<G>::new();
    let mut merged = Gyro::<G>::new();
    let mut restored = Gyro::<G>::new();
    let mut buffer = vec![0; Gyro::<G>::snapshot_bytes(0)];
    for stretch in stretches {
        let mut part = Gyro::<G>::new();
        for &sample in stretch {
            batch.push(sample);
            part.push(sample);
            restored.push(sample);
        }
        batch.release();
        batch.gap();
        merged.merge(&part);
        restored.release();
        let stored = restored.snapshot(&[], &mut buffer).unwrap();
        let mut next = Gyro::<G>::new();
        next.restore(&mut [], stored).unwrap();
        restored = next;
    }
    batch.release();
    merged.release();
    prop_assert_eq!(restored.accumulators(), batch.accumulators());
    prop_assert_eq!(restored.integrity(), batch.integrity());
    prop_assert_eq!(restored.left_out(), batch.left_out());
    prop_assert_eq!(restored.courses(), batch.courses());
    for axis in 0..3 {
        let expected = batch.record_so_far(axis, (scale(), [0.01])).unwrap();
        let after = restored.record_so_far(axis, (scale(), [0.01])).unwrap();
        prop_assert_eq!(&after, &expected);
        // The noise level that a merged record has learnt reaches the other record late, so that
        // their gates may decide differently.
        if std::mem::size_of::<G>() == 0 && merged.left_out() == batch.left_out() {
            let merged = merged.record_so_far(axis, (scale(), [0.01])).unwrap();
            if merged.samples == expected.samples {
                prop_assert_eq!(merged.curve, expected.curve);
                prop_assert_eq!(merged.covariates, expected.covariates);
                prop_assert_eq!(merged.kurtosis, expected.kurtosis);
            }
        }
    }
    Ok(())
}
