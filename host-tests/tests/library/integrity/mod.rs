//! Disturbed records must be refused, and records at rest must not.

mod carried;
mod coarse;
mod disturbed;
mod range;
mod reads;
mod rest;
mod state;

use allanite::integrity::{Integrity, Tally};
use allanite_host::simulate::{Preset, Simulator};
use rayon::prelude::*;

const RATE_HZ: f64 = 100.0;

const SAMPLES: usize = 1 << 16;

/// The counts per deg/s of a consumer gyro on its finest range.
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

/// The scale, in counts per deg/s, at which the noise of a sample is about `rms` counts.
fn counts_per_rate(preset: Preset, rms: f64) -> f64 {
    let c = preset.coefficients();
    let white = c.angle_random_walk * RATE_HZ.sqrt();
    let quantization = c.quantization * RATE_HZ * 2f64.sqrt();
    rms / white.hypot(quantization)
}

/// Asserts that every record of these seeds is valid.
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

/// Adds a rate in deg/s to `length` samples, beginning with sample `start`.
fn disturb(counts: &mut [i32], start: usize, length: usize, rate_at: impl Fn(f64) -> f64) {
    for (n, count) in counts[start..start + length].iter_mut().enumerate() {
        *count += (rate_at(n as f64 / length as f64) * FINE).round() as i32;
    }
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
