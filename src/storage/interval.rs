//! When to write.

use core::num::NonZeroU64;

/// Says when a snapshot is due: every so many samples.
///
/// What lies between two snapshots is what a power cut costs. Two pages of 4 KiB that can be erased
/// 10 000 times take 280 000 snapshots of 250 bytes: one an hour for 30 years.
///
/// # Example
///
/// ```
/// use allanite::{Accumulator, storage::SnapshotInterval};
/// use core::num::NonZeroU64;
///
/// let mut accumulator = Accumulator::<10>::new();
/// let mut interval = SnapshotInterval::new(NonZeroU64::MIN.saturating_add(99), 0);
/// let mut snapshots = 0;
/// for _ in 0..1000 {
///     accumulator.push(1);
///     if interval.is_due(accumulator.samples()) {
///         snapshots += 1;
///     }
/// }
/// assert_eq!(snapshots, 10);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SnapshotInterval {
    every: NonZeroU64,
    last: u64,
}

impl SnapshotInterval {
    /// One every so many samples, from an accumulator's present number of samples on: 0, or that of a
    /// restored one.
    pub const fn new(every: NonZeroU64, samples: u64) -> Self {
        Self {
            every,
            last: samples,
        }
    }

    /// Whether one is due, at this number of samples. Says so once: where the snapshot fails, the next
    /// is due as if it had been written.
    pub const fn is_due(&mut self, samples: u64) -> bool {
        // An accumulator that was reset starts again.
        let due = samples < self.last || samples - self.last >= self.every.get();
        if due {
            self.last = samples;
        }
        due
    }
}
