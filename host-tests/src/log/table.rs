//! The interface of all kinds of logs: a table that passes its values to a visitor.

use super::{
    columns::{AxisColumn, Columns},
    field::{Field, Flaw},
    metadata::Metadata,
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;

/// A log's file whose first rows are known and whose values can be read in passes.
pub(super) trait Table {
    fn metadata(&self) -> &Metadata;
    fn columns(&self) -> &Columns;

    /// Whether a pass shows rows one after the other, with the columns of each row in the order of
    /// the request.
    fn by_rows(&self) -> bool {
        true
    }

    /// Notes on defects of the file. They are complete after a pass.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Shows every value of the given columns to a visitor. The values of each column come in the
    /// order of the rows.
    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure>;
}

/// Receives the values of a pass over a table.
pub(super) trait Visitor {
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop>;

    /// Tells that samples are missing before the next row.
    fn gap(&mut self) {}
}

/// The reason why a visitor wants no more values.
pub(super) enum Stop {
    /// A value is not a count, so that another pass has to ask for numbers.
    NotCounts,
    /// A value is not a finite number.
    Flaw(Flaw),
    /// A time stamp is not valid.
    Clock(Flaw),
}

impl Stop {
    /// The failure that reports a value of a column at a place.
    pub(super) fn failure(&self, column: &AxisColumn, place: Place) -> Failure {
        match self {
            Self::Flaw(flaw) => {
                place.failure(format!("axis {}: {}", column.axis, flaw.what), flaw.remedy)
            }
            Self::Clock(flaw) => flaw.at(place),
            // Every visitor that reaches this takes numbers as well, so users do not see this
            // message.
            Self::NotCounts => place.failure(
                format!("axis {}: not a count", column.axis),
                "correct the value",
            ),
        }
    }
}

/// How a pass ended that met no error.
pub(super) enum Ended {
    AtTheLastRow,
    NotCounts,
}
