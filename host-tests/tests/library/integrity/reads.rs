//! What a reader made of the samples is recognised on the device, and survives a snapshot and a merge.

use super::{RATE_HZ, SAMPLES, counts_per_rate, quantised};
use allanite::{Axes, Scale, axis::Axis, integrity::Reason};
use allanite_host::simulate::{Preset, Simulator};

type Gyro = Axes<16, 0>;

/// The counts of three axes at rest, with an offset.
fn counts(preset: Preset, seed: u64, offset: i32) -> Vec<[i32; 3]> {
    let per_rate = counts_per_rate(preset, 10.0);
    let axes = [0, 1, 2].map(|axis| {
        let simulator = Simulator::new(preset.coefficients(), RATE_HZ, 3 * seed + axis);
        quantised(simulator.take(SAMPLES), per_rate)
    });
    let [x, y, z] = &axes;
    let rows = x.iter().zip(y).zip(z);
    rows.map(|((&x, &y), &z)| [x + offset, y - offset, z + offset / 2])
        .collect()
}

fn scale(preset: Preset) -> Scale {
    let per_rate = counts_per_rate(preset, 10.0);
    Scale::new((1.0 / per_rate) as _, RATE_HZ as _).unwrap()
}

fn judged(preset: Preset, rows: &[[i32; 3]]) -> [Option<Reason>; 3] {
    let mut gyro = Gyro::new();
    rows.iter().for_each(|&row| gyro.push(row));
    // What a snapshot holds says the same.
    let mut buffer = vec![0; Gyro::snapshot_bytes(0)];
    let stored = gyro.snapshot(&[], &mut buffer).unwrap();
    let mut restored = Gyro::new();
    restored.restore(&mut [], stored).unwrap();
    let verdicts = [0, 1, 2].map(|axis| gyro.record(axis, scale(preset)).unwrap().invalid);
    let again = [0, 1, 2].map(|axis| restored.record(axis, scale(preset)).unwrap().invalid);
    let kinds = |verdicts: [Option<Reason>; 3]| {
        verdicts.map(|one| one.map(|reason| std::mem::discriminant(&reason)))
    };
    assert_eq!(kinds(again), kinds(verdicts));
    verdicts
}

#[test]
fn reads_without_an_answer_are_recognised() {
    for (value, one_in) in [(0, 100), (-1, 300)] {
        let mut rows = counts(Preset::Mems, 11, 30);
        let spoilt = rows.iter_mut().skip(700).step_by(one_in);
        spoilt.for_each(|row| *row = [value; 3]);
        let number = SAMPLES.saturating_sub(700).div_ceil(one_in) as u64;
        for verdict in judged(Preset::Mems, &rows) {
            let Some(Reason::Unanswered { reads, samples }) = verdict else {
                panic!("{value}: {verdict:?}");
            };
            // The gate leaves out those that are spikes.
            assert!(
                reads <= number && samples <= SAMPLES as u64,
                "{reads} of {samples}"
            );
        }
    }
}

#[test]
fn reads_without_an_answer_that_are_spikes_are_left_out_by_a_gate() {
    let mut rows = counts(Preset::Mems, 11, 30);
    let spoilt = rows.iter_mut().skip(700).step_by(200);
    spoilt.for_each(|row| *row = [0x5A5A; 3]);
    assert_eq!(judged(Preset::Mems, &rows), [None; 3]);
    let mut ungated = Axes::<16, 0, ()>::new();
    rows.iter().for_each(|&row| ungated.push(row));
    let verdict = ungated.verdict(0);
    let Some(Reason::Unanswered { reads, .. }) = verdict else {
        panic!("{verdict:?}");
    };
    assert_eq!(reads, (SAMPLES as u64 - 700).div_ceil(200));
}

#[test]
fn repeats_of_all_axes_are_recognised() {
    // A reader that is 4 % faster than the sensor.
    let rows = counts(Preset::Mems, 12, 0);
    let read: Vec<_> = (0..SAMPLES).map(|n| rows[n * 25 / 26]).collect();
    for verdict in judged(Preset::Mems, &read) {
        let Some(Reason::Repeated {
            changes, samples, ..
        }) = verdict
        else {
            panic!("{verdict:?}");
        };
        let share = 1.0 - changes as f64 / samples as f64;
        assert!((share - 1.0 / 26.0).abs() < 0.004, "{share}");
    }
}

#[test]
fn halves_of_a_buffer_that_were_not_refilled_are_recognised() {
    for length in [16, 32, 64] {
        let fresh = counts(Preset::Mems, 13, 5);
        let mut rows = fresh.clone();
        for block in (3..SAMPLES / length).step_by(10) {
            let (from, to) = ((block - 2) * length, block * length);
            rows[to..to + length].copy_from_slice(&fresh[from..from + length]);
        }
        for verdict in judged(Preset::Mems, &rows) {
            let Some(Reason::Stale {
                stale,
                distance,
                samples,
            }) = verdict
            else {
                panic!("{length}: {verdict:?}");
            };
            assert_eq!(usize::from(distance), 2 * length);
            let share = stale as f64 / samples as f64;
            assert!((0.05..0.12).contains(&share), "{share}");
        }
    }
    // A single axis, too.
    let fresh = counts(Preset::Tactical, 14, 0);
    let mut gyro = Axis::<16, 0, ()>::new();
    for (n, row) in fresh.iter().enumerate() {
        let (block, within) = (n / 32, n % 32);
        let is_stale = block >= 2 && block % 10 == 3;
        gyro.push([if is_stale {
            fresh[(block - 2) * 32 + within][0]
        } else {
            row[0]
        }]);
    }
    let verdict = gyro.verdict(0);
    assert!(
        matches!(verdict, Some(Reason::Stale { distance: 64, .. })),
        "{verdict:?}"
    );
}

#[test]
fn a_gyro_at_rest_and_the_pulses_of_an_angle_have_nothing_wrong() {
    for preset in Preset::TYPICAL {
        for seed in 0..4 {
            assert_eq!(
                judged(preset, &counts(preset, seed, 0)),
                [None; 3],
                "{preset:?} {seed}"
            );
        }
    }
    for seed in 0..8_u32 {
        // An angle that turns by 0.1 to 0.9 pulses a sample, with a dither.
        let mut random = seed;
        let mut angles = [0.0_f64; 3];
        let mut pulses = [0; 3];
        let mut reads = allanite::faults::Reads::<3>::new();
        for _ in 0..SAMPLES {
            let mut next = [0; 3];
            for (axis, next) in next.iter_mut().enumerate() {
                let mut uniform = || {
                    random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    f64::from(random >> 8) / f64::from(1 << 24) - 0.5
                };
                angles[axis] += 0.1 + 0.1 * f64::from(seed) + 0.03 * axis as f64 + 0.1 * uniform();
                let counted = (angles[axis] + 0.4 * uniform()).floor() as i32;
                *next = counted - pulses[axis];
                pulses[axis] = counted;
            }
            reads.push(next);
        }
        assert_eq!(reads.verdict(), None, "{seed}");
    }
}

#[test]
fn what_was_read_is_merged() {
    let rows = counts(Preset::Mems, 15, 30);
    let mut halves = [Gyro::new(), Gyro::new()];
    for (n, row) in rows.iter().enumerate() {
        let row = if n % 300 == 299 { [-1; 3] } else { *row };
        halves[n * 2 / SAMPLES].push(row);
    }
    let [mut first, second] = halves;
    first.merge(&second);
    assert!(
        matches!(first.verdict(1), Some(Reason::Unanswered { .. })),
        "{:?}",
        first.verdict(1)
    );
}
