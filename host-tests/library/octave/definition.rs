//! Computes the sums by their definition, in big integers.

use allanite::Accumulator;
use num_bigint::BigUint;

/// A record by definition: every count, and where the stretches end.
#[derive(Clone, Default)]
pub(crate) struct Record {
    pub(crate) ended: Vec<Vec<i32>>,
    pub(crate) running: Vec<i32>,
    pub(crate) gaps: u64,
}

/// The averaging factor `m`, the number of differences, and Σ D².
pub(crate) type Octave = (u32, u64, BigUint);

impl Record {
    pub(crate) fn samples(&self) -> u64 {
        let ended: usize = self.ended.iter().map(Vec::len).sum();
        (ended + self.running.len()) as u64
    }

    pub(crate) fn gap(&mut self) {
        if !self.running.is_empty() {
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
        let angles: Vec<Vec<i128>> = stretches().map(|counts| angles(counts)).collect();
        (0..count)
            .map(|k| {
                let m = 1 << k;
                let (mut differences, mut sum) = (0, BigUint::ZERO);
                for theta in &angles {
                    for start in (0..theta.len().saturating_sub(2 * m)).step_by((m / 4).max(1)) {
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
