//! The state of one axis while rows arrive.

use crate::failure::{raised, refused};
use allanite_log::pieces::{Gathered, Pieces};
use datafusion::error::Result;

/// The samples of one axis of one device, as far as they were read.
#[derive(Debug)]
pub(crate) struct Axis {
    gathered: Gathered,
    rate_hz: f64,
    rate_per_count: f64,
}

impl Axis {
    /// Of a sensor with this rate and scale.
    pub(crate) fn new(rate_hz: f64, rate_per_count: f64) -> Result<Self> {
        let pieces = Pieces::new(rate_hz, rate_per_count).map_err(raised)?;
        Ok(Self::of(pieces))
    }

    /// Goes on with the state of these bytes.
    pub(crate) fn from_bytes(state: &[u8]) -> Result<Self> {
        Pieces::from_bytes(state).map(Self::of).map_err(raised)
    }

    fn of(pieces: Pieces) -> Self {
        Self {
            rate_hz: pieces.rate_hz(),
            rate_per_count: pieces.rate_per_count(),
            gathered: Gathered::new(pieces),
        }
    }

    /// Refuses rows of another rate or scale.
    pub(crate) fn is_of(&self, rate_hz: f64, rate_per_count: f64) -> Result<()> {
        for (what, ours, theirs) in [
            ("rate", self.rate_hz, rate_hz),
            ("scale", self.rate_per_count, rate_per_count),
        ] {
            if ours != theirs {
                return Err(refused(
                    format_args!("one axis of one device has the {what}s {ours} and {theirs}"),
                    &format!("group by the {what} too"),
                ));
            }
        }
        Ok(())
    }

    /// Adds neighbouring samples, of which the first one has this number.
    pub(crate) fn push(&mut self, first: u64, counts: &[i32]) -> Result<()> {
        self.gathered.push(first, counts).map_err(raised)
    }

    /// Adds samples with their numbers.
    pub(crate) fn push_numbered(&mut self, numbers: &[u64], counts: &[i32]) -> Result<()> {
        self.gathered.push_numbered(numbers, counts).map_err(raised)
    }

    /// Adds another part of the same record.
    pub(crate) fn merge(&mut self, other: Self) -> Result<()> {
        let other = other.gathered.into_pieces();
        self.gathered.pieces().merge(other).map_err(raised)
    }

    /// The state as bytes.
    pub(crate) fn state(&mut self) -> Result<Vec<u8>> {
        self.gathered.pieces().to_bytes().map_err(raised)
    }

    /// About how many bytes of memory it has.
    pub(crate) fn allocated(&self) -> usize {
        size_of::<Self>() + self.gathered.allocated()
    }
}
