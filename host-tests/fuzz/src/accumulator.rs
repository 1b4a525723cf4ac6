//! An accumulator under any sequence of samples and events, against the definition in 128-bit integers.

use allanite::Accumulator;
use std::ops::Range;

const OCTAVES: usize = 10;

/// Plays the events that the bytes encode.
pub fn check(bytes: &[u8]) {
    let mut accumulator = Accumulator::<OCTAVES>::new();
    let mut stretches = vec![Stretch::default()];
    let mut bytes = bytes.iter().copied();
    while let Some(event) = bytes.next() {
        let stretch = stretches.last_mut().unwrap_or_else(|| unreachable!());
        match event % 8 {
            0 if event > 0x0F => {
                // One to 85 samples are lost.
                let lost = 3 * u64::from(event >> 3) - 5;
                accumulator.lost(lost);
                if !stretch.fill(lost, OCTAVES) {
                    stretches.push(Stretch::default());
                }
            }
            0 => {
                accumulator.gap();
                stretches.push(Stretch::default());
            }
            1 => {
                let mut buffer = [0; Accumulator::<OCTAVES>::SNAPSHOT_BYTES];
                let stored = accumulator.snapshot(&mut buffer).unwrap();
                accumulator = Accumulator::restore(stored).unwrap();
                stretches.push(Stretch::default());
            }
            2 => {
                let other = accumulator.clone();
                accumulator.merge(&other);
                let copies = stretches.clone();
                stretches.extend(copies);
                stretches.push(Stretch::default());
            }
            kind => {
                let count = count(kind, &mut bytes);
                let times = 1 << (event >> 5);
                let counts = vec![count; times];
                stretch.counts.extend(&counts);
                if kind == 3 {
                    accumulator.push_slice(&counts);
                } else {
                    counts.iter().for_each(|&count| accumulator.push(count));
                }
            }
        }
        // Copies of copies would grow without end.
        if stretches
            .iter()
            .map(|stretch| stretch.counts.len())
            .sum::<usize>()
            > 1 << 14
            || stretches.len() > 64
        {
            break;
        }
    }
    for (k, octave) in accumulator.octaves().enumerate() {
        let (sum, differences) = definition(&stretches, k);
        let [low, middle, high] = octave.sum.limbs();
        let found = (u128::from(middle) << 64 | u128::from(low), high);
        assert_eq!(
            (found, octave.differences),
            ((sum, 0), differences),
            "octave {k}"
        );
    }
    let samples: usize = stretches.iter().map(Stretch::samples).sum();
    assert_eq!(accumulator.samples(), samples as u64);
}

fn count(kind: u8, bytes: &mut impl Iterator<Item = u8>) -> i32 {
    let mut next = || bytes.next().unwrap_or(0);
    match kind {
        3 | 4 => i32::from_le_bytes([next(), next(), next(), next()]),
        5 => i32::MIN,
        6 => i32::MAX,
        _ => i32::from(next() as i8),
    }
}

/// Counts and filled values that follow each other.
#[derive(Clone, Default)]
pub(crate) struct Stretch {
    pub(crate) counts: Vec<i32>,
    /// The places of the filled values, and the averaging factor from which on differences use them.
    filled: Vec<(Range<usize>, usize)>,
    /// What rounding left, in 32nds.
    rest: i64,
}

impl Stretch {
    /// Fills the place of lost samples, and tells whether an accumulator of so many octaves does.
    pub(crate) fn fill(&mut self, lost: u64, octaves: usize) -> bool {
        let begin = self.counts.len();
        if !(1..=64).contains(&lost) || begin < 32 {
            return false;
        }
        let first = (2 * lost.next_power_of_two() as usize).max(4);
        if first > 1 << (octaves - 1) {
            return false;
        }
        let window = &self.counts[begin / 8 * 8 - 32..begin / 8 * 8];
        let sum: i64 = window.iter().map(|&count| i64::from(count)).sum();
        for _ in 0..lost {
            let all = sum + self.rest;
            self.rest = all.rem_euclid(32);
            self.counts.push(all.div_euclid(32) as i32);
        }
        self.filled.push((begin..self.counts.len(), first));
        true
    }

    /// The number of samples that were not filled.
    fn samples(&self) -> usize {
        let filled = self.filled.iter().map(|(places, _)| places.len());
        self.counts.len() - filled.sum::<usize>()
    }
}

/// Σ D² of octave `k` and the number of differences, as the definition of the accumulator has them.
pub(crate) fn definition(stretches: &[Stretch], k: usize) -> (u128, u64) {
    let m = 1_usize << k;
    let step = (m / 4).max(1);
    let (mut sum, mut differences) = (0, 0);
    for stretch in stretches {
        let mut angles = vec![0_i128];
        for &count in &stretch.counts {
            angles.push(angles[angles.len() - 1] + i128::from(count));
        }
        for start in (0..angles.len().saturating_sub(2 * m)).step_by(step) {
            let touches = |(places, first): &(Range<usize>, usize)| {
                m < *first && places.start < start + 2 * m && start < places.end
            };
            if stretch.filled.iter().any(touches) {
                continue;
            }
            let difference = angles[start + 2 * m] - 2 * angles[start + m] + angles[start];
            sum += difference.unsigned_abs().pow(2);
            differences += 1;
        }
    }
    (sum, differences)
}
