//! Noise near the size of a count, and samples that are read several times.

use super::{RATE_HZ, SAMPLES, counts_per_rate, integrity, mems, quantised};
use allanite::integrity::{Integrity, Limits, Reason};
use allanite_host::simulate::{Coefficients, Preset, Random, Simulator};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rayon::prelude::*;

/// The number of offsets between the middle of a count and its edge.
const OFFSETS: usize = 11;

/// The mean squares of the differences of neighbours of rounded white noise, and its variance without and
/// with rounding, at every offset.
fn rounded(rms: f64) -> Vec<f64> {
    let one = |i: usize| {
        let offset = 0.5 * i as f64 / (OFFSETS - 1) as f64;
        let noise = Normal::new(offset, rms).expect("a positive deviation");
        let mut random = Random::seed_from_u64(1000 + i as u64);
        let mut last = noise.sample(&mut random).round();
        let draws = 1 << 20;
        let mut sum = 0.0;
        for _ in 0..draws {
            let next = noise.sample(&mut random).round();
            sum += (next - last).powi(2);
            last = next;
        }
        sum / f64::from(draws)
    };
    (0..OFFSETS).into_par_iter().map(one).collect()
}

/// The largest deviation of angle random walk from its mean over the offsets, as a share of it.
fn spread(squares: &[f64]) -> f64 {
    let roots: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    let mean = roots.iter().sum::<f64>() / roots.len() as f64;
    let off = roots.iter().map(|root| (root / mean - 1.0).abs());
    off.fold(0.0, f64::max)
}

/// This sets the limit: above it, the offset hardly matters, and below it, it does.
#[test]
fn the_limit_of_differences_separates_noise_from_rounding() {
    let limit = f64::from(Limits::DEFAULT.difference_per_mille) / 1000.0;
    let bounds = |rms: f64| {
        let squares = rounded(rms);
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let most = squares.iter().copied().fold(0.0, f64::max);
        (least, most, spread(&squares))
    };
    for rms in [0.5, 0.6, 0.8, 1.0] {
        let (least, _, spread) = bounds(rms);
        assert!(least > limit, "{rms}: {least}");
        assert!(spread < 0.02, "{rms}: {spread}");
        // Rounding adds 1/12 to the variance, up to what the offset does.
        let excess = least / (2.0 * (rms * rms + 1.0 / 12.0));
        assert!((excess - 1.0).abs() < 0.04, "{rms}: {excess}");
    }
    for rms in [0.2, 0.25, 0.3, 0.35, 0.4, 0.45] {
        let (_, most, spread) = bounds(rms);
        assert!(most < limit, "{rms}: {most}");
        assert!(spread > 0.02, "{rms}: {spread}");
    }
}

/// A gyro at rest whose white noise has `rms` counts and whose mean lies `offset` beside a count.
fn coarse(preset: Preset, rms: f64, offset: f64, seed: u64) -> Vec<i32> {
    let coefficients = preset.coefficients();
    let scale = counts_per_rate(preset, rms);
    let rates = Simulator::new(coefficients, RATE_HZ, seed);
    quantised(rates.map(|rate| rate + offset / scale), scale)
}

#[test]
fn noise_below_half_a_count_is_refused_wherever_its_mean_lies() {
    let white = Coefficients {
        angle_random_walk: 0.005,
        ..Coefficients::default()
    };
    for rms in [0.1, 0.2, 0.3, 0.35, 0.4, 0.45] {
        (0..10_u64).into_par_iter().for_each(|seed| {
            let scale = rms / (0.005 * RATE_HZ.sqrt());
            let offset = seed as f64 / 10.0 / scale;
            let rates = Simulator::new(white, RATE_HZ, seed).map(|rate| rate + offset);
            let verdict = integrity(&quantised(rates, scale)).verdict();
            let is_refused = match verdict {
                Some(Reason::Coarse { per_mille }) => per_mille < 640,
                // The noise hardly ever leaves the middle of a count.
                Some(Reason::Stuck { .. }) => rms < 0.2,
                _ => false,
            };
            assert!(is_refused, "{rms}, seed {seed}: {verdict:?}");
        });
    }
}

#[test]
fn noise_above_half_a_count_is_valid_wherever_its_mean_lies() {
    for preset in Preset::TYPICAL {
        for rms in [0.52, 0.7, 1.0] {
            (0..20_u64).into_par_iter().for_each(|seed| {
                let counts = coarse(preset, rms, seed as f64 / 20.0, seed);
                let verdict = integrity(&counts).verdict();
                assert_eq!(verdict, None, "{preset:?}, {rms}, seed {seed}");
            });
        }
    }
}

#[test]
fn samples_that_are_read_several_times_are_named() {
    for (times, words) in [(2, "half"), (3, "a third"), (4, "a quarter")] {
        for counts in [mems(1), coarse(Preset::Mems, 0.7, 0.2, 1)] {
            let counts = counts[..SAMPLES / 4].iter();
            let repeated: Vec<i32> = counts.flat_map(|&count| vec![count; times]).collect();
            let verdict = integrity(&repeated).verdict();
            let Some(reason @ Reason::Repeated { times: found, .. }) = verdict else {
                panic!("{times}: {verdict:?}")
            };
            assert_eq!(usize::from(found), times);
            assert!(
                reason
                    .to_string()
                    .contains(&format!("rate is {words} of what was given"))
            );
        }
    }
}

#[test]
fn some_slips_of_the_reader_leave_the_finding() {
    // The reader is a little faster than twice the sensor's rate, so that a sample is there once more now and
    // then.
    let counts = mems(2);
    let read: Vec<i32> = (0..SAMPLES)
        .map(|n| counts[(n as f64 / 2.03) as usize])
        .collect();
    let verdict = integrity(&read).verdict();
    assert!(
        matches!(verdict, Some(Reason::Repeated { times: 2, .. })),
        "{verdict:?}"
    );
}

#[test]
fn merged_records_keep_the_finding() {
    let counts = mems(3);
    let repeated: Vec<i32> = counts.iter().flat_map(|&count| [count; 2]).collect();
    let (one, other) = repeated.split_at(SAMPLES);
    let mut merged: Integrity = integrity(one);
    merged.merge(&integrity(other));
    assert!(matches!(
        merged.verdict(),
        Some(Reason::Repeated { times: 2, .. })
    ));
}
