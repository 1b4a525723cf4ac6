//! The times at which snapshots are due.

use core::num::NonZeroU64;

/// Says when a snapshot is due: once per interval of a fixed number of samples.
///
/// A power cut loses the samples since the last snapshot. Two pages of 4 KiB that can be erased 10 000 times
/// hold 280 000 snapshots of 250 bytes in their life: one per hour for 30 years.
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
    /// An interval of `every` samples, which begins at the present number of samples of an accumulator: 0, or
    /// the number that was restored.
    pub const fn new(every: NonZeroU64, samples: u64) -> Self {
        Self {
            every,
            last: samples,
        }
    }

    /// Whether a snapshot is due at this number of samples. Each snapshot is announced once: if it fails, the
    /// next one is due after a whole interval.
    pub const fn is_due(&mut self, samples: u64) -> bool {
        // A smaller number of samples means that the accumulator was reset and starts again.
        let due = samples < self.last || samples - self.last >= self.every.get();
        if due {
            self.last = samples;
        }
        due
    }
}
