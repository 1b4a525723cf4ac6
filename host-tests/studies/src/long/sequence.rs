//! An endless sequence of counts whose sums of squared differences follow from number theory, not from a record.

use allanite::Accumulator;
use allanite_host::simulate::Random;
use rand::{RngExt, SeedableRng};

/// The period of the noise: the largest prime below 2^16. No power of two is a multiple of it, so that the starts of an
/// octave's differences pass through all remainders.
const PERIOD: u64 = 65_521;

/// The noise lies between plus and minus this number of counts.
const NOISE: i32 = 1 << 11;

/// After this many samples the level changes between 0 and [`LEVEL`].
const HALF_WAVE: u64 = 1 << 24;

/// The height of the square wave, in counts. It makes the sums of long octaves wider than 64 bits.
const LEVEL: i32 = 1 << 12;

/// Noise of a period that is prime, and a square wave.
pub struct Sequence {
    /// Two periods of the noise, so that any stretch of up to one period is a slice.
    counts: Vec<i32>,
    /// The sums of the first counts of a period, from none to all.
    angles: Vec<i64>,
}

/// The differences of an octave, by the definition.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Expected {
    /// Their number.
    pub differences: u64,
    /// The sum of their squares.
    pub sum: u128,
}

impl Sequence {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::seed_from_u64(seed);
        let period: Vec<i32> = (0..PERIOD)
            .map(|_| random.random_range(-NOISE..NOISE))
            .collect();
        let mut angle = 0;
        let sums = period.iter().map(|&count| {
            angle += i64::from(count);
            angle
        });
        Self {
            angles: std::iter::once(0).chain(sums).collect(),
            counts: period.repeat(2),
        }
    }

    /// Hands the counts from `start` to `end` over, in slices.
    pub fn each(&self, start: u64, end: u64, mut take: impl FnMut(&[i32])) {
        let mut raised = [0; 1024];
        let mut at = start;
        while at < end {
            let edge = (at / HALF_WAVE + 1) * HALF_WAVE;
            let length = (end.min(edge) - at).min(raised.len() as u64) as usize;
            let first = (at % PERIOD) as usize;
            let noise = &self.counts[first..first + length];
            if level(at) == 0 {
                take(noise);
            } else {
                for (raised, count) in raised.iter_mut().zip(noise) {
                    *raised = count + LEVEL;
                }
                take(&raised[..length]);
            }
            at += length as u64;
        }
    }

    /// Accumulates the counts from `start` to `end`.
    pub fn accumulate<const OCTAVES: usize>(
        &self,
        start: u64,
        end: u64,
        accumulator: &mut Accumulator<OCTAVES>,
    ) {
        self.each(start, end, |counts| accumulator.push_slice(counts));
    }

    /// The differences of octave `k` of a record from `start` to `end`.
    pub fn expected(&self, k: u32, start: u64, end: u64) -> Expected {
        let m = 1 << k;
        let step = (m / 4).max(1);
        let Some(span) = (end - start).checked_sub(2 * m) else {
            return Expected::default();
        };
        // Starts lie at multiples of a step, and all blocks of a step that they need are complete.
        let differences = match k {
            0 | 1 => span + 1,
            _ => (end - start) / step - 7,
        };
        let last = start + (differences - 1) * step;
        let mut expected = Expected {
            differences,
            sum: self.noise(start, differences, step, m),
        };
        // The square wave changes only the differences that span one of its edges.
        let square = |difference: i64| u128::from(difference.unsigned_abs()).pow(2);
        let mut add = |s: u64| {
            let whole = self.difference(s, m, |n| self.angle(n));
            let noise = self.difference(s, m, |n| self.noise_angle(n));
            expected.sum = expected.sum + square(whole) - square(noise);
        };
        if 2 * m >= HALF_WAVE {
            (0..differences).for_each(|i| add(start + i * step));
        } else {
            let first = start / HALF_WAVE + 1;
            for edge in (first..)
                .map(|i| i * HALF_WAVE)
                .take_while(|&e| e < last + 2 * m)
            {
                // The starts from the first one whose end lies behind the edge to the last one before it.
                let from = (edge + 1).saturating_sub(2 * m).max(start);
                let i = (from - start).div_ceil(step);
                let starts = (i..).map(|i| start + i * step);
                starts
                    .take_while(|&s| s < edge && s <= last)
                    .for_each(&mut add);
            }
        }
        expected
    }

    /// The sum of the squares of the differences of the noise alone.
    fn noise(&self, start: u64, differences: u64, step: u64, m: u64) -> u128 {
        let square = |s: u64| {
            let difference = self.difference(s, m, |n| self.noise_angle(n));
            u128::from(difference.unsigned_abs()).pow(2)
        };
        let cycles = u128::from(differences / PERIOD);
        let cycle = match cycles {
            0 => 0,
            _ => (0..PERIOD).map(square).sum(),
        };
        let rest = (0..differences % PERIOD).map(|i| square(start % PERIOD + i * step));
        cycles * cycle + rest.sum::<u128>()
    }

    fn difference(&self, s: u64, m: u64, angle: impl Fn(u64) -> i64) -> i64 {
        angle(s + 2 * m) - 2 * angle(s + m) + angle(s)
    }

    /// The sum of the first `n` counts.
    fn angle(&self, n: u64) -> i64 {
        let raised =
            n / (2 * HALF_WAVE) * HALF_WAVE + (n % (2 * HALF_WAVE)).saturating_sub(HALF_WAVE);
        self.noise_angle(n) + i64::from(LEVEL) * raised as i64
    }

    /// The sum of the first `n` counts of the noise.
    fn noise_angle(&self, n: u64) -> i64 {
        let whole = self.angles[PERIOD as usize];
        (n / PERIOD) as i64 * whole + self.angles[(n % PERIOD) as usize]
    }
}

/// The square wave at a sample.
const fn level(n: u64) -> i32 {
    if (n / HALF_WAVE).is_multiple_of(2) {
        0
    } else {
        LEVEL
    }
}
