//! An accumulator that leaves out what integrity finds odd.

use crate::{
    integrity::{Integrity, Observation},
    octave::Accumulator,
};
use heapless::Deque;

/// Samples of a cluster that integrity takes to see motion.
const CLUSTER: usize = 64;
/// Samples held back: those of a cluster, and of the one before, in which motion may have begun.
const HELD: usize = 2 * CLUSTER;

/// Skips stuck values, hits of rails, spikes and motion: a [`gap`](Accumulator::gap) takes their place,
/// and they are counted.
///
/// Motion is seen at the end of a cluster of 64 samples, so twice as many are held back until they are
/// known to be at rest, and 64 more skipped when it ends; what begins more gradually is seen in clusters
/// of 1024, and its first samples are in the record by then.
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
    held: Deque<i32, HELD>,
    /// Samples yet to skip behind a motion.
    behind: usize,
    skipped: u64,
}

impl<const OCTAVES: usize> Gate<OCTAVES> {
    /// With limits of what is odd.
    pub const fn new(integrity: Integrity) -> Self {
        Self {
            accumulator: Accumulator::new(),
            integrity,
            held: Deque::new(),
            behind: 0,
            skipped: 0,
        }
    }

    /// Adds a count, or skips it.
    pub fn push(&mut self, count: i32) -> Observation {
        let seen = self.integrity.push(count);
        if seen.moving {
            self.behind = CLUSTER;
            self.skip((self.held.len() as u64).saturating_add(1));
            self.held.clear();
        } else if self.behind > 0 {
            self.behind -= 1;
            self.skip(1);
        } else if seen.is_odd() {
            self.let_go();
            self.skip(1);
        } else {
            if self.held.is_full() {
                self.let_one_go();
            }
            // There is room now.
            let _ = self.held.push_back(count);
        }
        seen
    }

    /// Samples were lost.
    pub fn gap(&mut self) {
        self.let_go();
        self.accumulator.gap();
        self.integrity.gap();
    }

    fn skip(&mut self, samples: u64) {
        self.skipped = self.skipped.saturating_add(samples);
        self.accumulator.gap();
    }

    fn let_go(&mut self) {
        while !self.held.is_empty() {
            self.let_one_go();
        }
    }

    fn let_one_go(&mut self) {
        if let Some(count) = self.held.pop_front() {
            self.accumulator.push(count);
        }
    }

    /// The record without what was skipped, and without up to 128 samples that are held back.
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
