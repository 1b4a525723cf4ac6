//! The powers of the segments of one level of the spectrum.

use super::{
    edges::EDGE,
    exact_sum::{ExactSum, Places},
};
use crate::sizes::SEGMENT;
use allanite::spectrum::segment_powers;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The number of bins of a level.
pub(super) const BINS: usize = SEGMENT / 2 - SEGMENT / 16;

/// The number of blocks from the start of a segment to that of the next one.
const HOP: u64 = SEGMENT as u64 / 2;

const _: () = assert!(SEGMENT == EDGE, "a piece keeps the boundaries of a segment");

/// The segments of a level that lie between these boundaries of its blocks: the numbers of the first blocks, in units of a
/// [`HOP`].
pub(super) fn segments(boundaries: &Range<u64>) -> Range<u64> {
    let first = boundaries.start.div_ceil(HOP);
    let last = boundaries.end.checked_sub(SEGMENT as u64 + 1);
    first..last.map_or(first, |last| first.max(last / HOP + 1))
}

/// The exact sums over the segments of one level.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Powers {
    /// For each bin, the sum of the powers and that of their squares. Empty without a segment.
    bins: Vec<[ExactSum; 2]>,
}

impl Powers {
    /// Adds the segments that begin at these numbers. `values` writes the blocks of the segment that begins at a boundary of blocks
    /// of `2^block_bits` samples, as [`Angle::blocks`](super::squares::Angle::blocks) does. The segments have all their
    /// boundaries.
    pub(super) fn add(
        &mut self,
        segments: Range<u64>,
        block_bits: u32,
        values: impl Fn(u64, f32, &mut [f32; SEGMENT]),
    ) {
        let starts: Vec<u64> = segments.map(|segment| segment * HOP).collect();
        if starts.is_empty() {
            return;
        }
        let mut sums = [[Places::EMPTY; 2]; BINS];
        // The factor of 1/8 takes back that of the transform. The unit of 2^16 counts keeps powers of full scale within the
        // range of single precision, as in the accumulator.
        let scale = 2f32.powi(-(block_bits as i32 + UNIT_BITS + 3));
        for group in starts.chunks(4) {
            let mut of_group = [[0.0; SEGMENT]; 4];
            for (of_segment, &start) in of_group.iter_mut().zip(group) {
                values(start, scale, of_segment);
            }
            segment_powers(&mut of_group);
            for powers in of_group.iter().take(group.len()) {
                for ([sum, squares], &power) in sums.iter_mut().zip(powers) {
                    sum.add(power);
                    squares.add(power * power);
                }
            }
        }
        if self.bins.is_empty() {
            self.bins = vec![Default::default(); BINS];
        }
        for (own, sums) in self.bins.iter_mut().zip(&sums) {
            for (own, sum) in own.iter_mut().zip(sums) {
                own.add(sum);
            }
        }
    }

    /// Adds the segments of another piece.
    pub(super) fn join(&mut self, other: &Self) {
        if self.bins.is_empty() {
            self.bins.clone_from(&other.bins);
            return;
        }
        for (own, other) in self.bins.iter_mut().zip(&other.bins) {
            for (own, other) in own.iter_mut().zip(other) {
                own.join(other);
            }
        }
    }

    /// The sums of powers and of their squares of all bins, in the unit of the accumulator.
    pub(super) fn sums(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.bins
            .iter()
            .map(|sums| sums.each_ref().map(ExactSum::value))
    }

    /// Whether so many segments can have these sums.
    pub(super) fn is_possible(&self, segments: u64) -> bool {
        let bins = if segments == 0 { 0 } else { BINS };
        self.bins.len() == bins && self.bins.iter().flatten().all(ExactSum::is_possible)
    }
}

/// The unit of the values that are transformed is this power of two, in counts.
pub const UNIT_BITS: i32 = 16;
