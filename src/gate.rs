//! An accumulator that leaves out what integrity finds odd.

use crate::{
    integrity::{Integrity, Observation},
    octave::Accumulator,
};
use heapless::Vec;

/// Samples held back, as many as integrity takes to see motion.
const HELD: usize = 64;

/// Skips stuck values, hits of rails, spikes and motion: a [`gap`](Accumulator::gap) takes their place,
/// and they are counted.
///
/// Motion is seen at the end of a cluster of 64 samples, so as many are held back until they are known
/// to be at rest; what begins more gradually is seen in clusters of 1024, and its first samples are in
/// the record by then.
///
/// # Example
///
/// ```
/// use allanite::{Gate, Integrity};
///
/// let mut gyro = Gate::<10>::new(Integrity::default());
/// for n in 0..10_000_i32 {
///     let noise = (n.wrapping_mul(1_103_515_245) >> 16) % 50;
///     gyro.push(if n % 4000 == 3999 { 30_000 } else { noise });
/// }
/// gyro.gap(); // lets go of what is held back
/// assert_eq!((gyro.skipped(), gyro.accumulator().samples()), (2, 9998));
/// ```
#[derive(Clone, Debug)]
pub struct Gate<const OCTAVES: usize> {
    accumulator: Accumulator<OCTAVES>,
    integrity: Integrity,
    held: Vec<i32, HELD>,
    skipped: u64,
}

impl<const OCTAVES: usize> Gate<OCTAVES> {
    /// With limits of what is odd.
    pub const fn new(integrity: Integrity) -> Self {
        Self {
            accumulator: Accumulator::new(),
            integrity,
            held: Vec::new(),
            skipped: 0,
        }
    }

    /// Adds a count, or skips it.
    pub fn push(&mut self, count: i32) -> Observation {
        let seen = self.integrity.push(count);
        if seen.moving {
            self.skipped = self.skipped.saturating_add(self.held.len() as u64 + 1);
            self.held.clear();
            self.accumulator.gap();
        } else if seen.is_odd() {
            self.skipped = self.skipped.saturating_add(1);
            self.let_go();
            self.accumulator.gap();
        } else {
            if self.held.is_full() {
                self.let_go();
            }
            // There is room now.
            let _ = self.held.push(count);
        }
        seen
    }

    /// Samples were lost.
    pub fn gap(&mut self) {
        self.let_go();
        self.accumulator.gap();
        self.integrity.gap();
    }

    fn let_go(&mut self) {
        self.accumulator.push_slice(&self.held);
        self.held.clear();
    }

    /// The record without what was skipped, and without up to 64 samples that are held back.
    pub fn accumulator(&self) -> &Accumulator<OCTAVES> {
        &self.accumulator
    }

    /// What was seen of all samples, those that were skipped included: its verdict is on a record that
    /// holds them.
    pub fn integrity(&self) -> &Integrity {
        &self.integrity
    }

    /// Samples left out.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }
}
