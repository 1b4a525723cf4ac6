//! Computes the sums by their definition, in big integers.

use allanite::Accumulator;
use num_bigint::BigUint;
use std::ops::Range;

/// Counts and filled values that follow each other.
#[derive(Clone, Default)]
pub(crate) struct Stretch {
    pub(crate) counts: Vec<i32>,
    /// The places of the filled values, and the averaging factor from which on differences use them.
    pub(crate) filled: Vec<(Range<usize>, usize)>,
    /// What rounding left, in 32nds.
    pub(crate) rest: i64,
}

/// A record by definition: every count, and where the stretches end.
#[derive(Clone, Default)]
pub(crate) struct Record {
    pub(crate) ended: Vec<Stretch>,
    pub(crate) running: Stretch,
    pub(crate) gaps: u64,
}

/// The averaging factor `m`, the number of differences, and Σ D².
pub(crate) type Octave = (u32, u64, BigUint);

impl Record {
    pub(crate) fn samples(&self) -> u64 {
        let measured = |stretch: &Stretch| {
            let filled = stretch.filled.iter().map(|(places, _)| places.len());
            stretch.counts.len() - filled.sum::<usize>()
        };
        let stretches = self.ended.iter().chain([&self.running]);
        stretches.map(measured).sum::<usize>() as u64
    }

    /// The samples that were filled.
    pub(crate) fn filled(&self) -> u64 {
        let stretches = self.ended.iter().chain([&self.running]);
        let filled = stretches.flat_map(|stretch| &stretch.filled);
        filled.map(|(places, _)| places.len() as u64).sum()
    }

    /// Samples were lost: up to 64 are filled with the mean of the 32 samples before the last multiple of eight, rounded
    /// down with what rounding left before. An accumulator of `octaves` octaves that cannot do so has a gap.
    pub(crate) fn lost(&mut self, samples: u64, octaves: usize) {
        if samples == 0 {
            return;
        }
        let longest = samples.min(1 << 20).next_power_of_two() as usize;
        let first = (2 * longest).max(4);
        let begin = self.running.counts.len();
        if samples > 64 || begin < 32 || octaves < 6 || first > 1 << (octaves - 1) {
            return self.gap();
        }
        let stretch = &mut self.running;
        let window = &stretch.counts[begin / 8 * 8 - 32..begin / 8 * 8];
        let sum: i64 = window.iter().map(|&count| i64::from(count)).sum();
        for _ in 0..samples {
            let all = sum + stretch.rest;
            stretch.rest = all.rem_euclid(32);
            stretch.counts.push(all.div_euclid(32) as i32);
        }
        stretch.filled.push((begin..stretch.counts.len(), first));
    }

    pub(crate) fn gap(&mut self) {
        if !self.running.counts.is_empty() {
            self.ended.push(std::mem::take(&mut self.running));
            self.gaps += 1;
        }
    }

    pub(crate) fn merge(&mut self, mut other: Self) {
        if other.samples() > 0 {
            self.gap();
            other.gap();
            self.ended.append(&mut other.ended);
            self.gaps += other.gaps;
        }
    }

    pub(crate) fn octaves(&self, count: usize) -> Vec<Octave> {
        let stretches = || self.ended.iter().chain([&self.running]);
        let angles: Vec<Vec<i128>> = stretches().map(|stretch| angles(&stretch.counts)).collect();
        (0..count)
            .map(|k| {
                let m = 1 << k;
                let (mut differences, mut sum) = (0, BigUint::ZERO);
                for (theta, stretch) in angles.iter().zip(stretches()) {
                    for start in (0..theta.len().saturating_sub(2 * m)).step_by((m / 4).max(1)) {
                        let touches = |(places, first): &(Range<usize>, usize)| {
                            m < *first && places.start < start + 2 * m && start < places.end
                        };
                        if stretch.filled.iter().any(touches) {
                            continue;
                        }
                        let d = theta[start + 2 * m] - 2 * theta[start + m] + theta[start];
                        differences += 1;
                        sum += square(d);
                    }
                }
                (m as u32, differences, sum)
            })
            .collect()
    }
}

/// The angles `θ_0 … θ_N`.
pub(crate) fn angles(counts: &[i32]) -> Vec<i128> {
    let sums = counts.iter().scan(0, |theta, &count| {
        *theta += i128::from(count);
        Some(*theta)
    });
    std::iter::once(0).chain(sums).collect()
}

pub(crate) fn square(d: i128) -> BigUint {
    BigUint::from(d.unsigned_abs()).pow(2)
}

pub(crate) fn big(limbs: [u64; 3]) -> BigUint {
    let words = limbs
        .iter()
        .flat_map(|limb| [*limb as u32, (limb >> 32) as u32]);
    BigUint::new(words.collect())
}

pub(crate) fn octaves<const K: usize>(accumulator: &Accumulator<K>) -> Vec<Octave> {
    let octaves = accumulator.octaves();
    octaves
        .map(|octave| (octave.m, octave.differences, big(octave.sum.limbs())))
        .collect()
}
