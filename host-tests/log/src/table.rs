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

/// The largest number of values that a visitor is shown at once. Twelve bytes for each of them, as a float and as a
/// count, fit into the fastest cache. Chosen by hand.
pub(super) const RUN: usize = 1 << 10;

/// Receives the values of a pass over a table.
pub(super) trait Visitor {
    /// Whether the values have to come row by row. Otherwise, several rows of one column may come before the same rows
    /// of the next column.
    const BY_ROWS: bool = false;

    /// Whether the visitor stops at the first value that is not a count.
    const ONLY_COUNTS: bool = false;

    /// What a stamp says of its row, where that is more than that it follows the row before.
    type Followed;

    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop>;

    /// Receives at most [`RUN`] values of a column that follow each other. A visitor that overrides this is faster,
    /// because the compiler spreads a loop over many values over vectors. The error has the place of the first value
    /// that stops the visitor.
    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        visit_each(self, axis, values)
    }

    /// Whether the first column alone is the time, whose stamps may be shown before the other columns of their rows.
    fn takes_stamps(&self) -> bool {
        false
    }

    /// Receives stamps of rows that follow each other, as far as each follows the one before. Returns their number, and
    /// what the next one says of its row, which [`Visitor::settle`] takes when the rows before it have been shown.
    fn visit_stamps<F: Field>(
        &mut self,
        _stamps: &[F],
    ) -> (usize, Result<Option<Self::Followed>, Stop>) {
        (0, Ok(None))
    }

    /// Begins the row of a stamp.
    fn settle(&mut self, _followed: Self::Followed) {}

    /// Tells that so many samples are missing before the next row, or an unknown number if it is 0.
    fn gap(&mut self, _missing: u64) {}

    /// Forgets the values of the present row, whose first columns were shown.
    fn forget(&mut self, _columns: usize) {}

    /// Handles a row that holds no sample. `shown` is the column of the present row whose value is none, or `None` if no
    /// column was shown.
    fn lose_row(
        &mut self,
        _shown: Option<usize>,
        failure: impl FnOnce() -> Failure,
    ) -> Result<(), Failure> {
        Err(failure())
    }
}

/// Handles the reason why a visitor wanted no more values of the present row. Returns whether the pass goes on with the
/// next row.
pub(super) fn after_stop<V: Visitor>(
    visitor: &mut V,
    (column, stop): (usize, &Stop),
    axes: &[AxisColumn],
    place: impl FnOnce() -> Place,
) -> Result<bool, Failure> {
    match stop {
        Stop::NotCounts => Ok(false),
        Stop::Clock(flaw) => Err(flaw.at(place())),
        Stop::Flaw(_) | Stop::NoStamp(_) => {
            let failure = || stop.failure(&axes[column], place());
            visitor.lose_row(Some(column), failure).map(|()| true)
        }
    }
}

/// Shows a visitor the values of a run one by one.
pub(super) fn visit_each<F: Field, V: Visitor + ?Sized>(
    visitor: &mut V,
    axis: usize,
    values: &[F],
) -> Result<(), (usize, Stop)> {
    for (place, &value) in values.iter().enumerate() {
        visitor.visit(axis, value).map_err(|stop| (place, stop))?;
    }
    Ok(())
}

/// The reason why a visitor wants no more values.
pub(super) enum Stop {
    /// A value is not a count, so that another pass has to ask for numbers.
    NotCounts,
    /// A value is not a finite number.
    Flaw(Flaw),
    /// A time stamp is none.
    NoStamp(Flaw),
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
            Self::NoStamp(flaw) => {
                place.failure(format!("{}: {}", column.axis, flaw.what), flaw.remedy)
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
