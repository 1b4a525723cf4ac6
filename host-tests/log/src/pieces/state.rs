//! The state as bytes.

use super::Pieces;
use crate::failure::Failure;

/// What the bytes begin with.
const VERSION: &str = "allanite pieces 3";

impl Pieces {
    /// The state as bytes, by postcard. Equal states have equal bytes.
    ///
    /// # Errors
    /// None occurs, because everything can be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Failure> {
        let written = postcard::to_allocvec(&(VERSION, self));
        written.map_err(|error| Failure::option(format!("the pieces: {error}"), "report it"))
    }

    /// The state whose [bytes](Self::to_bytes) these are.
    ///
    /// # Errors
    /// When they are not those of pieces.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Failure> {
        let damaged = || {
            Failure::option(
                "these are not the bytes of the pieces of a record",
                "make them from the samples again",
            )
        };
        let (version, rest): (&str, _) = postcard::take_from_bytes(bytes).map_err(|_| damaged())?;
        if version != VERSION {
            return Err(damaged());
        }
        let (pieces, rest): (Self, _) = postcard::take_from_bytes(rest).map_err(|_| damaged())?;
        let is_whole = rest.is_empty() && pieces.is_possible();
        is_whole.then_some(pieces).ok_or_else(damaged)
    }

    /// Whether no number in it is impossible.
    pub fn is_possible(&self) -> bool {
        let mut stretches = self.stretches.iter();
        // No two of them touch, so that a state has only one form.
        let mut ends = self.pieces().map(|piece| piece.range().end);
        let starts = self.stretches.keys().skip(1);
        let are_apart = starts.zip(&mut ends).all(|(&start, end)| end < start);
        Self::new(self.rate_hz, self.rate_per_count).is_ok()
            && are_apart
            && stretches.all(|(&start, piece)| piece.range().start == start && piece.is_possible())
    }
}
