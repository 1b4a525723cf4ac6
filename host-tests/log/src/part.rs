//! What is kept of an axis whose log is a part of a longer record.

use crate::{
    failure::{Failure, Place},
    pieces::{Gathered, Pieces},
};
use std::path::Path;

/// The pieces of an axis while its log is read.
pub(super) struct PartSums {
    /// The number of the next sample in the record.
    next: u64,
    gathered: Gathered,
    /// Why the numbers of further samples are not known.
    flaw: Option<&'static str>,
}

impl PartSums {
    /// Nothing yet of a log that begins with this sample of the record.
    pub(super) const fn new(first: u64) -> Self {
        Self {
            next: first,
            gathered: Gathered::new(Pieces::EMPTY),
            flaw: None,
        }
    }

    pub(super) fn push(&mut self, counts: &[i32]) {
        if self.flaw.is_none() && self.gathered.push(self.next, counts).is_err() {
            self.flaw = Some("the numbers of its samples exceed 2^50");
        }
        self.next = self.next.saturating_add(counts.len() as u64);
    }

    /// Tells that so many samples are missing here; none if their number is not known.
    pub(super) fn gap(&mut self, missing: u64) {
        if missing == 0 {
            self.flaw = Some("nobody knows how many samples a gap lost");
        }
        self.next = self.next.saturating_add(missing);
    }

    /// The pieces, of a sensor with this rate in samples per second and this scale in rate units per count.
    ///
    /// # Errors
    /// When the numbers of the samples are not known.
    pub(super) fn finish(
        mut self,
        path: &Path,
        rate_hz: f64,
        rate_per_count: f64,
    ) -> Result<Pieces, Failure> {
        match self.flaw {
            Some(flaw) => Err(refused(path, flaw)),
            None => {
                let pieces = self.gathered.pieces().clone();
                Ok(pieces.of_sensor(rate_hz, rate_per_count))
            }
        }
    }
}

/// The failure of a log that cannot be a part of a record.
pub(super) fn refused(path: &Path, why: &str) -> Failure {
    Place::file(path).failure(
        format!("it cannot be rejoined with the parts beside it: {why}"),
        "measure it without --part; merge then takes the place between two parts for a gap",
    )
}
