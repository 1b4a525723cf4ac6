//! What every kind of log is to its readers: a table that passes its values to a visitor.

use super::{
    columns::{AxisColumn, Columns},
    field::{Field, Flaw},
    metadata::Metadata,
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;

/// A log's file, known by its first rows and ready to be gone through.
pub(super) trait Table {
    fn metadata(&self) -> &Metadata;
    fn columns(&self) -> &Columns;

    /// Whether a pass shows rows one after the other, the columns of each in the order asked for.
    fn by_rows(&self) -> bool {
        true
    }

    /// What was found that is not as it should be, known after a pass.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Shows every value of the given columns to a visitor; of each column in the order of rows.
    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure>;
}

/// What a pass over a table is made for.
pub(super) trait Visitor {
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop>;

    /// Samples are missing before the next row.
    fn gap(&mut self) {}
}

/// Why a visitor wants no more.
pub(super) enum Stop {
    /// A value is not a count: come again and ask for numbers.
    NotCounts,
    /// A value is no finite number either.
    Flaw(Flaw),
    /// The row does not follow the one before.
    Clock(Flaw),
}

impl Stop {
    /// The failure that a value of a column was met with.
    pub(super) fn failure(&self, column: &AxisColumn, place: Place) -> Failure {
        match self {
            Self::Flaw(flaw) => {
                place.failure(format!("axis {}: {}", column.axis, flaw.what), flaw.remedy)
            }
            Self::Clock(flaw) => flaw.at(place),
            // Met by a visitor that takes numbers as well, so never seen.
            Self::NotCounts => place.failure(
                format!("axis {}: not a count", column.axis),
                "correct the value",
            ),
        }
    }
}

/// How a pass ended that found nothing wrong.
pub(super) enum Ended {
    AtTheLastRow,
    NotCounts,
}
