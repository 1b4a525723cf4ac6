//! Whether the peers compute the same deviations, where the definition is the same.

use super::{
    environment::{Environment, Overlap, Peer},
    record,
};
use allanite::Accumulator;
use allanite_host::simulate::Preset;
use allanite_log::OCTAVES;
use anyhow::{Context as _, Result};
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// The number of samples. It is a prime, so that every octave has an incomplete cluster at its end.
pub const SAMPLES: u64 = 1_000_003;

/// The seed of the record, and its gyro.
pub const SEED: u64 = 1;
const GYRO: Preset = Preset::Mems;

/// Octaves up to this share of the record are compared by the peer's own definition: longer ones have few differences.
const LONGEST: u64 = SAMPLES / 64;

/// Deviations by averaging factor, in counts.
pub type Deviations = Vec<(u64, f64)>;

/// How far the deviations of a peer are from ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// The peer.
    pub peer: &'static str,
    /// The number of octaves that are compared by the same definition.
    pub octaves: usize,
    /// The largest relative difference among them.
    pub same: f64,
    /// The largest relative difference where each keeps its own definition.
    pub own: f64,
    /// The same in standard errors of our octave, those of non-overlapping clusters of white noise.
    pub own_errors: f64,
}

/// Compares every peer on one record, which is written into a folder.
pub fn agreement(environment: &Environment, folder: &Path) -> Result<Vec<Agreement>> {
    let path = folder.join("agreement.npy");
    let gyro = GYRO.coefficients();
    let mut counts = Vec::new();
    let watch = |chunk: &[i32]| counts.extend_from_slice(chunk);
    record::write(&path, gyro, &[], [SAMPLES, SEED], watch)?;
    let ours = quarter(&counts);
    let apart = separate(&counts);
    let files = [path];
    let compare = |peer: &Peer| {
        let run = |task| -> Result<Deviations> {
            let (found, _) = environment.run(peer, task, [1.0, 1.0], &files)?;
            deviations(found.first().context("a peer printed no deviations")?)
        };
        let by_same = match peer.overlap {
            Overlap::Full => pairs(&run("same")?, &ours),
            Overlap::None => pairs(&run("same")?, &apart),
        };
        let by_own = pairs(&run("octaves")?, &ours);
        let own = by_own.iter().filter(|(m, _)| *m <= LONGEST);
        let relative = |(m, difference): &(u64, f64)| {
            difference * (2.0 * (SAMPLES as f64 / *m as f64 - 1.0)).sqrt()
        };
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
        Ok(Agreement {
            peer: peer.name,
            octaves: by_same.len(),
            same: largest(&mut by_same.iter().map(|pair| pair.1)),
            own: largest(&mut own.clone().map(|pair| pair.1)),
            own_errors: largest(&mut own.map(relative)),
        })
    };
    environment.peers.iter().map(compare).collect()
}

/// The deviations of an accumulator.
pub fn quarter(counts: &[i32]) -> Deviations {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    accumulator.push_slice(counts);
    of(&accumulator)
}

/// The deviations of an accumulator, in counts.
pub fn of<const OCTAVES: usize>(accumulator: &Accumulator<OCTAVES>) -> Deviations {
    let octaves = accumulator
        .octaves()
        .filter(|octave| octave.differences > 0);
    let deviations = octaves.map(|octave| {
        let mean = octave.sum.to_real() / octave.differences as f64;
        (
            u64::from(octave.m),
            (0.5 * mean).sqrt() / f64::from(octave.m),
        )
    });
    deviations.collect()
}

/// The deviations of clusters that do not overlap: those at m = 1 of an accumulator of sums over clusters.
pub fn separate(counts: &[i32]) -> Deviations {
    let factors = (0..usize::BITS - 1).map(|k| 1_usize << k);
    let factors = factors.take_while(|m| 2 * m <= counts.len());
    let deviation = |m: usize| {
        let mut accumulator = Accumulator::<OCTAVES>::new();
        for cluster in counts.chunks_exact(m) {
            let sum: i64 = cluster.iter().copied().map(i64::from).sum();
            // Sums that 32 bits do not hold end the comparison.
            accumulator.push(i32::try_from(sum).ok()?);
        }
        let (_, deviation) = *of(&accumulator).first()?;
        Some((m as u64, deviation / m as f64))
    };
    factors.map_while(deviation).collect()
}

/// The averaging factors that both have, each with the relative difference.
fn pairs(theirs: &Deviations, ours: &Deviations) -> Deviations {
    let both = theirs.iter().filter_map(|(m, theirs)| {
        let (_, ours) = ours.iter().find(|(of, _)| of == m)?;
        Some((*m, (theirs / ours - 1.0).abs()))
    });
    both.collect()
}

fn deviations(found: &Value) -> Result<Deviations> {
    Ok(serde_json::from_value(found.clone())?)
}
