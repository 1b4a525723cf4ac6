//! Disturbed records are refused.

use super::{
    FINE, SAMPLES, assert_unremarkable, assert_valid, disturb, integrity, mems, quantised, rest,
};
use allanite::{
    Accumulator,
    integrity::{Integrity, Limits, Reason},
};
use allanite_host::simulate::{Preset, Simulator};

fn is_moved(reason: Option<Reason>) -> bool {
    matches!(reason, Some(Reason::Moved { .. }))
}

#[test]
fn a_moved_gyro_is_refused() {
    use std::f64::consts::PI;
    for seed in 0..3 {
        let rest = mems(seed);
        for rate in [10.0, 30.0, 90.0, -90.0] {
            for seconds in [1, 3, 5, 30] {
                let shapes: [&dyn Fn(f64) -> f64; 4] = [
                    &|_| rate,
                    &|x| rate * (PI * x).sin().powi(2),
                    &|x| rate * (2.0 * PI * x).sin(),
                    &|x| rate * (2.0 * PI * 7.0 * x).sin() * (PI * x).sin(),
                ];
                for (shape, rate_at) in shapes.iter().enumerate() {
                    // A shake can be recognised only after the noise level is known.
                    let first = if shape == 3 { 3000 } else { 200 };
                    for start in [first, 8000, 32_000, SAMPLES - 3500] {
                        let mut counts = rest.clone();
                        disturb(&mut counts, start, seconds * 100, rate_at);
                        let verdict = integrity(&counts).verdict();
                        // A shake may look like spikes.
                        let spiked = shape == 3 && matches!(verdict, Some(Reason::Spiked { .. }));
                        assert!(
                            is_moved(verdict) || spiked,
                            "{rate} deg/s, {seconds} s, shape {shape}, from {start}: {verdict:?} {:?}",
                            integrity(&counts).tally()
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn motion_is_seen_at_eight_kilohertz() {
    for seed in 0..5 {
        let simulator = Simulator::new(Preset::Mems.coefficients(), 8000.0, seed);
        let mut counts = quantised(simulator, FINE);
        disturb(&mut counts, 30_000, 8000, |x| {
            90.0 * (x * std::f64::consts::PI).sin().powi(2)
        });
        assert!(
            is_moved(integrity(&counts).verdict()),
            "{:?}",
            integrity(&counts)
        );
    }
}

#[test]
fn stuck_values_are_refused() {
    for seed in 0..5 {
        for scale in [FINE, 20.0] {
            let counts = rest(Preset::Mems, scale, seed);
            for (start, length) in [
                (0, SAMPLES),
                (5, SAMPLES - 5),
                (100, SAMPLES - 100),
                (40_000, SAMPLES - 40_000),
                (65_000, SAMPLES - 65_000),
                (0, 20_000),
                (5, 1000),
                (30_000, 400),
            ] {
                let mut counts = counts.clone();
                let value = counts[start];
                counts[start..start + length].fill(value);
                let verdict = integrity(&counts).verdict();
                assert!(
                    matches!(verdict, Some(Reason::Stuck { longest_run, .. }) if longest_run as usize >= length),
                    "from {start}, {length}: {verdict:?}"
                );
            }
        }
    }
}

#[test]
fn a_gyro_that_hangs_repeatedly_is_refused() {
    let mut counts = mems(1);
    for start in (10_000..60_000).step_by(10_000) {
        let value = counts[start];
        counts[start..start + 2000].fill(value);
    }
    let integrity = integrity(&counts);
    assert!(matches!(integrity.verdict(), Some(Reason::Stuck { .. })));
    assert_eq!(integrity.tally().stuck_runs, 5);
    assert!(integrity.tally().stuck_samples >= 10_000);
}

#[test]
fn a_converter_too_coarse_for_its_noise_is_refused() {
    let counts = rest(Preset::Fog, 20.0, 1);
    assert!(matches!(
        integrity(&counts).verdict(),
        Some(Reason::Stuck { .. })
    ));
}

#[test]
fn a_single_huge_spike_is_refused() {
    for seed in 0..4 {
        let rest = mems(seed);
        for position in [0, 1, 2, 30, 62, 63, 64, 65, 66, 200, 30_000, SAMPLES - 2] {
            for spike in [1000, -5000, 32_000, i32::MAX, i32::MIN] {
                for width in [1, 3] {
                    let mut counts = rest.clone();
                    let end = (position + width).min(SAMPLES - 1);
                    counts[position..end].fill(spike);
                    let integrity = integrity(&counts);
                    assert!(
                        match integrity.verdict() {
                            Some(Reason::Spiked { spikes, .. }) => spikes == 1,
                            // There is no known level yet that the rate could return to.
                            Some(Reason::Moved { .. }) => (61..=64).contains(&position),
                            _ => false,
                        },
                        "{spike} at {position}: {:?} {:?}",
                        integrity.verdict(),
                        integrity.tally()
                    );
                }
            }
        }
    }
}

#[test]
fn a_spike_is_refused_by_its_share_of_the_squares() {
    let mut counts = mems(7);
    let mut accumulator = Accumulator::<2>::new();
    accumulator.push_slice(&counts);
    let quiet = accumulator
        .octaves()
        .next()
        .expect("an octave")
        .sum
        .to_real();
    // A spike S adds two squared differences, so its share is 2 S² / (2 S² + quiet). The shares are
    // 4 % and 6 %.
    for (share, refused) in [(0.04, false), (0.06, true)] {
        let size = (0.5 * quiet * share / (1.0 - share)).sqrt();
        counts[50_000] = counts[49_999] + size as i32;
        let integrity = integrity(&counts);
        assert_eq!(integrity.tally().spikes, 1);
        assert_eq!(integrity.verdict().is_some(), refused, "{share}");
    }
}

#[test]
fn rails_are_refused() {
    for seed in 0..10 {
        // Half of the samples are clipped, or all of them. In the case after the loop, a sensor marks
        // a few bad samples with the most negative count.
        for offset in [i32::from(i16::MAX), 40_000, -32_768, -40_000] {
            let counts: Vec<_> = mems(seed)
                .iter()
                .map(|count| (count + offset).clamp(-32_768, 32_767))
                .collect();
            let integrity = integrity(&counts);
            assert!(
                matches!(integrity.verdict(), Some(Reason::Railed { hits, .. }) if hits > 20_000),
                "{offset}: {:?}",
                integrity.verdict()
            );
        }
        let mut counts = mems(seed);
        counts
            .iter_mut()
            .step_by(500)
            .for_each(|count| *count = -32_768);
        let verdict = integrity(&counts).verdict();
        assert!(
            matches!(verdict, Some(Reason::Railed { hits: 132, .. })),
            "{verdict:?}"
        );
    }
}

#[test]
fn counts_that_are_read_without_their_sign_or_with_swapped_bytes_are_refused() {
    for seed in 0..10 {
        for bits in [16, 18, 19, 20, 24] {
            let mask = (1_i32 << bits) - 1;
            for offset in [0, 4, -5] {
                let counts: Vec<_> = mems(seed)
                    .iter()
                    .map(|count| (count + offset) & mask)
                    .collect();
                let verdict = integrity(&counts).verdict();
                assert_eq!(
                    verdict,
                    Some(Reason::Misread { bits }),
                    "{bits} bits, {offset}"
                );
            }
        }
        // Where the noise is below half of the low byte, swapped bytes only look like a larger noise.
        let swapped = |count: &i32| i32::from((20 * *count as i16).swap_bytes());
        let counts: Vec<_> = mems(seed).iter().map(swapped).collect();
        assert_eq!(
            integrity(&counts).verdict(),
            Some(Reason::Misread { bits: 16 })
        );
    }
    // A level far from zero has no sign to lose, and a corrupt word is a spike.
    assert_valid("around 40000 without a sign", 20, |seed| {
        mems(seed)
            .iter()
            .map(|count| (count - 25_536) & 0xFFFF)
            .collect()
    });
    let mut counts: Vec<_> = mems(3).iter().map(|count| count + 2000).collect();
    counts[700] = 0xFFFF;
    assert!(matches!(
        integrity(&counts).verdict(),
        Some(Reason::Spiked { spikes: 1, .. })
    ));
}

#[test]
fn the_rails_of_wide_converters_are_known() {
    for bits in [20, 24, 32] {
        let most = ((1_i64 << (bits - 1)) - 1) as i32;
        for offset in [most, -most - 1] {
            let clipped = mems(1).into_iter().map(|count| {
                let count = i64::from(count) + i64::from(offset);
                count.clamp(-i64::from(most) - 1, i64::from(most)) as i32
            });
            let verdict = integrity(&clipped.collect::<Vec<_>>()).verdict();
            assert!(
                matches!(verdict, Some(Reason::Railed { hits, .. }) if hits > 20_000),
                "{bits} bits, {offset}: {verdict:?}"
            );
        }
    }
}

#[test]
fn the_rails_of_other_sensors_are_configured() {
    let limits = Limits {
        rails: &[-8192, 8191],
        ..Limits::default()
    };
    let mut integrity = Integrity::with_limits(Box::leak(Box::new(limits))).expect("valid limits");
    for count in mems(3) {
        integrity.push((count + 8190).min(8191));
    }
    assert!(matches!(integrity.verdict(), Some(Reason::Railed { .. })));
}

#[test]
fn a_sensor_of_wide_range_may_exceed_the_rails_of_a_narrow_one() {
    assert_valid("around 32767", 20, |seed| {
        mems(seed).iter().map(|count| count + 32_767).collect()
    });
}

#[test]
fn missing_samples_are_refused_from_a_tenth_on() {
    for (lost, refused) in [(5, false), (9, false), (15, true), (500, true)] {
        let mut integrity = Integrity::default();
        for chunk in mems(4).chunks(100) {
            chunk.iter().for_each(|&count| {
                integrity.push(count);
            });
            integrity.lost(lost);
        }
        let verdict = integrity.verdict();
        assert_eq!(matches!(verdict, Some(Reason::Missing { .. })), refused);
        assert_eq!(verdict.is_some(), refused);
        assert_eq!(integrity.tally().missing, 656 * lost);
    }
}

#[test]
fn a_change_of_level_across_a_gap_is_not_counted() {
    let mut integrity = Integrity::default();
    for (part, counts) in mems(5).chunks(8192).enumerate() {
        integrity.gap();
        for count in counts {
            integrity.push(count + 3000 * part as i32);
        }
    }
    assert_eq!(integrity.verdict(), None);
    assert_unremarkable(integrity.tally());
}
