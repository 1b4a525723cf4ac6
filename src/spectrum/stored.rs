//! The sums of a spectrum in a snapshot.
//!
//! For each level, the number of its segments, and, where there are any, for each bin the sum of the powers and
//! the sum of their squares over the segments.

use super::{SpectrumAccumulator, window::bins};
use crate::storage::{
    envelope::{put, take},
    snapshot::LONGEST as LONGEST_VARINT,
};

impl<const P: usize, const LEVELS: usize> SpectrumAccumulator<P, LEVELS> {
    /// The largest number of bytes that the sums take.
    pub(crate) const LONGEST: usize = LEVELS * (LONGEST_VARINT + bins(P) * 8) + LONGEST_VARINT;

    /// Writes the sums as they are after a [`gap`](Self::gap), and returns the number of bytes; `None` if the
    /// buffer is too small.
    #[inline(never)]
    pub(crate) fn write(&self, buffer: &mut [u8]) -> Option<usize> {
        let mut length = 0;
        // The work that waits is done in a copy, because a snapshot changes nothing.
        let mut ended = self.clone();
        ended.gap();
        put(&ended.lost(), buffer, &mut length)?;
        for (_, level) in ended.levels() {
            put(&level.segments(), buffer, &mut length)?;
            if level.segments() > 0 {
                for sums in level.sums() {
                    put(&sums, buffer, &mut length)?;
                }
            }
        }
        Some(length)
    }

    /// Reads sums, and returns the bytes behind them; `None` if no record can have such sums.
    pub(crate) fn read<'b>(&mut self, mut bytes: &'b [u8]) -> Option<&'b [u8]> {
        self.reset();
        let lost = take(&mut bytes)?;
        let mut finer = u32::MAX;
        for level in self.start_with(lost) {
            let segments = take(&mut bytes)?;
            // A level has at most as many segments as the one with shorter blocks, whose number may have been
            // halved since.
            if segments > finer.saturating_mul(2) {
                return None;
            }
            finer = segments;
            if segments > 0 {
                level.restore(segments, || take(&mut bytes))?;
            }
        }
        Some(bytes)
    }
}
