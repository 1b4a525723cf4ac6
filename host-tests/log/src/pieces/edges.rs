//! The angles at the ends of a piece.

use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The number of boundaries that are kept at each end of a piece. A segment of the spectrum has as many blocks, and the
/// longest difference of this length of blocks spans half of them.
pub(super) const EDGE: usize = 64;

/// The numbers of the boundaries between blocks of `block` samples that a piece has, both ends included.
pub(super) fn boundaries(piece: &Range<u64>, block: u64) -> Range<u64> {
    piece.start.div_ceil(block)..piece.end / block + 1
}

/// Angles of a piece at boundaries between blocks of one length: the first and the last [`EDGE`] of them, or all if the piece
/// has no more than both. They are counted from the beginning of the piece, and wrap.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Edges(Vec<i64>);

impl Edges {
    /// The edges of a piece with so many boundaries, whose angles `angle` tells.
    pub(super) fn of(number: u64, angle: impl Fn(u64) -> i64) -> Self {
        Self(kept(number).map(angle).collect())
    }

    /// The angle at the boundary `place` of `number`, if it is kept.
    #[inline]
    fn get(&self, place: u64, number: u64) -> Option<i64> {
        let edge = EDGE as u64;
        let place = match place {
            place if place < edge || number <= 2 * edge => place,
            place if place >= number - edge => place - (number - 2 * edge),
            _ => return None,
        };
        self.0.get(place as usize).copied()
    }

    /// Whether a piece with so many boundaries keeps so many angles.
    pub(super) fn is_possible(&self, number: u64) -> bool {
        self.0.len() as u64 == number.min(2 * EDGE as u64)
    }
}

/// The places that are kept of so many boundaries.
fn kept(number: u64) -> impl Iterator<Item = u64> {
    let head = number.min(EDGE as u64);
    let tail = number.saturating_sub(EDGE as u64).max(head);
    (0..head).chain(tail..number)
}

/// The boundaries of two pieces that touch, for blocks of one length.
pub(super) struct Joint<'a> {
    /// The numbers of the boundaries of the left one, and its angles.
    pub(super) left: (Range<u64>, &'a Edges),
    /// The same of the right one.
    pub(super) right: (Range<u64>, &'a Edges),
    /// The angle at the end of the left one.
    pub(super) total: i64,
}

impl Joint<'_> {
    /// The numbers of the boundaries of both.
    pub(super) fn range(&self) -> Range<u64> {
        // A piece that has no boundary has an empty range, which lies where its end is.
        self.left.0.start..self.right.0.end
    }

    /// The angle at a boundary, counted from the beginning of the left one. `None` if neither keeps it.
    #[inline]
    pub(super) fn angle(&self, boundary: u64) -> Option<i64> {
        let within = |range: &Range<u64>| {
            let place = boundary.checked_sub(range.start)?;
            Some((place, range.end.saturating_sub(range.start)))
        };
        if boundary < self.left.0.end {
            let (place, number) = within(&self.left.0)?;
            return self.left.1.get(place, number);
        }
        let (place, number) = within(&self.right.0)?;
        let angle = self.right.1.get(place, number)?;
        Some(angle.wrapping_add(self.total))
    }

    /// The edges of both.
    pub(super) fn edges(&self) -> Edges {
        let range = self.range();
        let number = range.end.saturating_sub(range.start);
        let angles = kept(number).map(|place| self.angle(range.start + place));
        // All of them are kept by one of the two.
        Edges(angles.flatten().collect())
    }
}
