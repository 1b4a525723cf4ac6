//! Records that must be refused for what happened in them, and records that must not be.

use allanite::{Accumulator, Integrity, Limits, Observation, Reason, Tally};
use host_tests::simulate::{Coefficients, Hidden, Preset, Simulator};
use proptest::{collection::vec, prelude::*, test_runner::RngSeed};
use rayon::prelude::*;

const RATE_HZ: f64 = 100.0;
const SAMPLES: usize = 1 << 16;
/// Counts per deg/s of a consumer gyro on its finest range.
const FINE: f64 = 131.0;

fn integrity(counts: &[i32]) -> Integrity {
    let mut integrity = Integrity::default();
    counts.iter().for_each(|&count| {
        integrity.push(count);
    });
    integrity
}

fn quantised(rates: impl Iterator<Item = f64>, counts_per_rate: f64) -> Vec<i32> {
    rates
        .take(SAMPLES)
        .map(|rate| (rate * counts_per_rate).round() as i32)
        .collect()
}

fn rest(preset: Preset, counts_per_rate: f64, seed: u64) -> Vec<i32> {
    quantised(
        Simulator::new(preset.coefficients(), RATE_HZ, seed),
        counts_per_rate,
    )
}

fn mems(seed: u64) -> Vec<i32> {
    rest(Preset::Mems, FINE, seed)
}

/// Counts per deg/s that make the noise of a sample about `rms` counts.
fn counts_per_rate(preset: Preset, rms: f64) -> f64 {
    let c = preset.coefficients();
    let white = c.angle_random_walk * RATE_HZ.sqrt();
    let quantization = c.quantization * RATE_HZ * 2f64.sqrt();
    rms / white.hypot(quantization)
}

/// Every record of these seeds is valid.
fn assert_valid(what: &str, seeds: u64, record: impl Fn(u64) -> Vec<i32> + Sync) {
    let refused: Vec<_> = (0..seeds)
        .into_par_iter()
        .filter_map(|seed| {
            let integrity = integrity(&record(seed));
            let verdict = integrity.verdict()?;
            Some(format!("{what}, seed {seed}: {verdict}"))
        })
        .collect();
    assert!(
        refused.is_empty(),
        "{} of {seeds}: {}",
        refused.len(),
        refused[0]
    );
}

fn assert_unremarkable(tally: Tally) {
    let Tally {
        stuck_runs,
        rail_hits,
        spikes,
        steps,
        motions,
        missing,
        ..
    } = tally;
    assert_eq!(
        (stuck_runs, rail_hits, spikes, steps, motions, missing),
        (0, 0, 0, 0, 0, 0)
    );
}

#[test]
fn a_gyro_at_rest_is_valid_and_nothing_is_counted() {
    for preset in Preset::ALL {
        assert_valid("at 131 counts", 100, |seed| {
            let counts = rest(preset, FINE, seed);
            assert_unremarkable(integrity(&counts).tally());
            counts
        });
    }
}

#[test]
fn a_gyro_whose_samples_mostly_repeat_is_valid() {
    // 0.05 deg/s, as coarse as gyros come: one count rms, and 0.4.
    for preset in [Preset::Mems, Preset::Tactical] {
        assert_valid("0.05 deg/s", 100, |seed| rest(preset, 20.0, seed));
    }
    for preset in Preset::ALL {
        for rms in [0.2, 0.25, 0.3] {
            assert_valid(&format!("{rms} counts"), 40, |seed| {
                let scale = counts_per_rate(preset, rms);
                // Anywhere between the middle and the edge of a quantum.
                let offset = seed as f64 / 40.0 / scale;
                let rates = Simulator::new(preset.coefficients(), RATE_HZ, seed);
                quantised(rates.map(|rate| rate + offset), scale)
            });
        }
    }
}

#[test]
fn other_rates_are_valid() {
    for (rate_hz, scale) in [(10.0, 131.0), (1000.0, 131.0), (8000.0, 16.4)] {
        assert_valid(&format!("{rate_hz} Hz"), 40, |seed| {
            let simulator = Simulator::new(Preset::Mems.coefficients(), rate_hz, seed);
            quantised(simulator, scale)
        });
    }
}

#[test]
fn every_hidden_effect_is_valid() {
    let effects = [
        ("sinusoid", [0.3, 0.0], 0.005),
        ("sinusoid", [0.3, 0.0], 0.5),
        ("sinusoid", [0.003, 0.0], 1.0),
        ("sinusoid", [7.7, 0.0], 5.0),
        ("sinusoid", [1.5626, 0.0], 2.0),
        ("gauss_markov", [5.0, 0.0], 0.01),
        ("gauss_markov", [5.0, 0.0], 0.5),
        ("gauss_markov", [200.0, 0.0], 0.5),
        ("resonance", [20.0, 30.0], 0.5),
        ("random_telegraph", [0.05, 0.0], 0.2),
        ("random_telegraph", [5.0, 0.0], 0.02),
        ("random_telegraph", [5.0, 0.0], 0.15),
        ("random_telegraph", [50.0, 0.0], 0.15),
        ("low_pass", [0.02, 0.0], 0.005),
        ("low_pass", [0.2, 0.0], 0.005),
        ("decimation_filter", [0.014, 2.0], 0.005),
        ("decimation_filter", [0.1, 1.0], 0.005),
    ];
    for (name, parameters, coefficient) in effects {
        let hidden =
            Hidden::new(name, parameters, coefficient).expect("an effect of the catalogue");
        assert_valid(
            &format!("{name} {parameters:?} {coefficient}"),
            20,
            |seed| {
                let coefficients = Preset::Mems.coefficients();
                quantised(
                    Simulator::with_hidden(coefficients, &[hidden], RATE_HZ, seed),
                    FINE,
                )
            },
        );
    }
}

#[test]
fn a_thermal_ramp_and_a_warm_up_are_valid() {
    let ramp = |slope_per_hour: f64| move |t: f64| slope_per_hour / 3600.0 * t;
    let warm_up = |t: f64| 0.1 * (1.0 - (-t / 120.0).exp());
    let late = |t: f64| 5.0 / 3600.0 * (t - 300.0).max(0.0);
    let effects: [(&str, &(dyn Fn(f64) -> f64 + Sync)); 4] = [
        ("5 deg/s/h", &ramp(5.0)),
        ("-20 deg/s/h", &ramp(-20.0)),
        ("warm-up", &warm_up),
        ("late ramp", &late),
    ];
    for (name, rate_at) in effects {
        for (preset, scale) in [
            (Preset::Mems, 20.0),
            (Preset::Mems, FINE),
            (Preset::Fog, 400.0),
        ] {
            assert_valid(name, 30, |seed| {
                let simulator = Simulator::new(preset.coefficients(), RATE_HZ, seed);
                let rates = simulator.enumerate();
                quantised(
                    rates.map(|(n, rate)| rate + rate_at(n as f64 / RATE_HZ)),
                    scale,
                )
            });
        }
    }
}

/// Adds a rate, in deg/s, from sample `start` on for `length`.
fn disturb(counts: &mut [i32], start: usize, length: usize, rate_at: impl Fn(f64) -> f64) {
    for (n, count) in counts[start..start + length].iter_mut().enumerate() {
        *count += (rate_at(n as f64 / length as f64) * FINE).round() as i32;
    }
}

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
                    // A scale must be known before a shake can be told from it.
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
fn a_gyro_that_hangs_again_and_again_is_refused() {
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
                            // No level is known yet that it could come back to.
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
fn a_spike_matters_by_its_share_of_the_squares() {
    let mut counts = mems(7);
    let mut accumulator = Accumulator::<2>::new();
    accumulator.push_slice(&counts);
    let quiet = accumulator
        .octaves()
        .next()
        .expect("an octave")
        .sum
        .to_f64();
    // Two differences: 2 S² / (2 S² + quiet) of 4 % and of 6 %.
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
        // Half of the samples clipped; all of them; seldom, by a sensor that marks bad data so.
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
fn the_rails_of_other_sensors_are_configured() {
    let limits = Limits {
        rails: [-8192, 8191, i32::MIN, i32::MAX],
        ..Limits::default()
    };
    let mut integrity = Integrity::new(limits).expect("valid limits");
    for count in mems(3) {
        integrity.push((count + 8190).min(8191));
    }
    assert!(matches!(integrity.verdict(), Some(Reason::Railed { .. })));
}

#[test]
fn a_wide_sensor_may_pass_the_rails_of_a_narrow_one() {
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
            integrity.missing(lost);
        }
        let verdict = integrity.verdict();
        assert_eq!(matches!(verdict, Some(Reason::Missing { .. })), refused);
        assert_eq!(verdict.is_some(), refused);
        assert_eq!(integrity.tally().missing, 656 * lost);
    }
}

#[test]
fn a_gap_hides_no_level_that_changed_across_it() {
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

#[test]
fn an_observation_tells_the_odd_sample() {
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
fn contradictory_limits_are_refused_by_name() {
    let refuse = |limits| Integrity::new(limits).expect_err("refused").to_string();
    let limits = Limits::default();
    assert_eq!(
        refuse(Limits {
            spike_factor: 2,
            ..limits
        }),
        "spike_factor = 2: choose 8 to 256"
    );
    assert_eq!(
        refuse(Limits {
            missing_per_mille: 1001,
            ..limits
        }),
        "missing_per_mille = 1001: choose 0 to 1000"
    );
    assert_eq!(Integrity::new(limits), Ok(Integrity::default()));
}

#[test]
fn a_reason_is_one_sentence_with_numbers_and_a_remedy() {
    let mut counts = mems(8);
    counts[1000] = 20_000;
    let reason = integrity(&counts).verdict().expect("a reason").to_string();
    assert_eq!(
        reason,
        "spiked: 1 single samples far beyond the noise make up 98 % of the squares at one sample; \
         check supply and bus, or leave them out as gaps"
    );
}

#[test]
fn reset_forgets_all_but_the_limits() {
    let limits = Limits {
        run_factor: 200,
        ..Limits::default()
    };
    let fresh = Integrity::new(limits).expect("valid limits");
    let mut used = fresh.clone();
    used.push(3);
    used.missing(4);
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
            Event::Missing(samples) => integrity.missing(*samples),
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

/// The same cases in every run.
fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(952),
        failure_persistence: None,
        ..ProptestConfig::default()
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
        play(&mut Integrity::new(limits).expect("valid limits"), &events);
    }
}

proptest! {
    #![proptest_config(seeded(20))]

    #[test]
    fn merging_counts_what_a_gap_between_would(first in 0_u64..50, second in 50_u64..100) {
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
        let limits = Limits { rails: [i32::MIN, i32::MAX, i32::MIN, i32::MAX], ..Limits::default() };
        let mut plain = Integrity::new(limits).expect("valid limits");
        let mut shifted = plain.clone();
        for &count in &counts[..8000] {
            prop_assert_eq!(plain.push(count), shifted.push(count + offset));
        }
        prop_assert_eq!(plain.tally(), shifted.tally());
        prop_assert_eq!(plain.verdict(), shifted.verdict());
    }
}

#[test]
fn pure_white_noise_is_valid_whatever_its_scale() {
    for scale in [5.0, 131.0, 1e4, 1e7] {
        assert_valid("white", 20, |seed| {
            let coefficients = Coefficients {
                angle_random_walk: 0.005,
                ..Coefficients::default()
            };
            quantised(Simulator::new(coefficients, RATE_HZ, seed), scale)
        });
    }
}
