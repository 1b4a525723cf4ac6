//! The sums of an accumulator by their definition: nothing is put off, and nothing wraps.

use super::{Failure, OCTAVES};
use allanite::Accumulator;

/// The octaves that have no level of their own: `m = 1` and `m = 2` use the angles of the first level.
const SHORT: usize = 2;

/// The number of kept angles of a level: the differences of an octave span eight of its blocks.
const RING: usize = 16;

/// Every octave's Σ D² and number of differences. A level keeps the angle at each end of its blocks of `2^L`
/// samples, and computes the difference of the octave `m = 4 · 2^L` as soon as a block ends. The
/// [accumulator](allanite::Accumulator) puts this off, keeps only eight angles, and lets them wrap.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    sums: [u128; OCTAVES],
    differences: [u64; OCTAVES],
    rings: [[i64; RING]; OCTAVES - SHORT],
    angle: i64,
    /// Samples since the last gap.
    position: u64,
    pub(super) samples: u64,
    pub(super) gaps: u64,
    /// Whether a number of this oracle has overflowed, so that it is no oracle.
    has_overflowed: bool,
}

impl Definition {
    pub(super) const fn new() -> Self {
        Self {
            sums: [0; OCTAVES],
            differences: [0; OCTAVES],
            rings: [[0; RING]; OCTAVES - SHORT],
            angle: 0,
            position: 0,
            samples: 0,
            gaps: 0,
            has_overflowed: false,
        }
    }

    pub(super) fn push(&mut self, count: i32) {
        self.angle = self.exact(self.angle.checked_add(i64::from(count)));
        self.position += 1;
        self.samples += 1;
        let n = self.position;
        let last = (n.trailing_zeros() as usize).min(OCTAVES - SHORT - 1);
        for level in 0..=last {
            let block = n >> level;
            self.rings[level][block as usize % RING] = self.angle;
            if level == 0 {
                self.add(0, 0, block, 1);
                self.add(1, 0, block, 2);
            }
            self.add(level + SHORT, level, block, 4);
        }
    }

    /// Adds the difference of two clusters of so many blocks that end with this block, if there are so many.
    fn add(&mut self, octave: usize, level: usize, block: u64, blocks: u64) {
        if block < 2 * blocks {
            return;
        }
        let angle = |before: u64| self.rings[level][(block - before) as usize % RING];
        let newer = angle(0).checked_sub(angle(blocks));
        let older = angle(blocks).checked_sub(angle(2 * blocks));
        let difference = newer
            .zip(older)
            .and_then(|(newer, older)| newer.checked_sub(older));
        let difference = u128::from(self.exact(difference).unsigned_abs());
        match self.sums[octave].checked_add(difference * difference) {
            Some(sum) => self.sums[octave] = sum,
            None => self.has_overflowed = true,
        }
        self.differences[octave] += 1;
    }

    fn exact(&mut self, number: Option<i64>) -> i64 {
        self.has_overflowed |= number.is_none();
        number.unwrap_or(0)
    }

    pub(super) fn gap(&mut self) {
        self.gaps += u64::from(self.position > 0);
        self.angle = 0;
        self.position = 0;
        for ring in &mut self.rings {
            // The angle before the first sample.
            ring[0] = 0;
        }
    }

    /// Compares an accumulator with the definition.
    pub(super) fn check(&self, accumulator: &Accumulator<OCTAVES>) -> Result<(), Failure> {
        if self.has_overflowed {
            return Err(Failure::Oracle);
        }
        let found = (accumulator.samples(), accumulator.gaps());
        if found != (self.samples, self.gaps) {
            return Err(Failure::Counts);
        }
        for (k, octave) in accumulator.octaves().enumerate() {
            let limbs = [self.sums[k] as u64, (self.sums[k] >> 64) as u64, 0];
            let expected = (limbs, self.differences[k]);
            if (octave.sum.limbs(), octave.differences) != expected {
                return Err(Failure::Sum(k));
            }
        }
        Ok(())
    }

    /// A number that two equal sets of sums share, and that different ones hardly share.
    pub(super) fn digest(&self) -> u64 {
        let words = self
            .sums
            .iter()
            .flat_map(|&sum| [sum as u64, (sum >> 64) as u64]);
        let words = words
            .chain(self.differences)
            .chain([self.samples, self.gaps]);
        // FNV-1a over words.
        words.fold(0xCBF2_9CE4_8422_2325, |digest, word| {
            (digest ^ word).wrapping_mul(0x100_0000_01B3)
        })
    }
}
