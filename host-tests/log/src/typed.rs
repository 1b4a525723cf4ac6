//! Tables whose numbers lie in a file in binary, and whose first rows are known as text, by which the columns are told.

use super::{
    columns::{AxisColumn, Columns},
    csv::Csv,
    field::Flaw,
    metadata::Metadata,
    table::{Ended, Table, Visitor},
    values::{NumberFile, Told},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use std::{cell::OnceCell, path::Path};
use tempfile::TempPath;

/// What makes the text of the whole table.
pub(super) type Whole<'a> = &'a dyn Fn() -> Result<(Csv, TempPath), Failure>;

/// A table of columns whose numbers need not be parsed.
pub(super) struct Typed<'a> {
    path: &'a Path,
    /// The first and the last rows as text.
    text: Csv,
    numbers: &'a NumberFile,
    make_whole: Whole<'a>,
    /// The whole table as text, once it was needed.
    whole: OnceCell<(Csv, TempPath)>,
}

impl<'a> Typed<'a> {
    pub(super) fn new(
        path: &'a Path,
        text: Csv,
        numbers: &'a NumberFile,
        make_whole: Whole<'a>,
    ) -> Self {
        Self {
            path,
            text,
            numbers,
            make_whole,
            whole: OnceCell::new(),
        }
    }

    /// The whole table as text.
    fn whole(&self) -> Result<&Csv, Failure> {
        if self.whole.get().is_none() {
            let _ = self.whole.set((self.make_whole)()?);
        }
        Ok(self.whole.get().map_or(&self.text, |(text, _)| text))
    }
}

impl Told for Typed<'_> {
    fn place(&self, row: u64) -> Place {
        // The names stand in the first row of the text.
        Place::row(self.path, row + 2)
    }

    fn of_stamp(&self, row: u64, flaw: &Flaw) -> Option<Failure> {
        self.whole().ok()?.of_other_sensor(row, flaw)
    }
}

impl Table for Typed<'_> {
    fn metadata(&self) -> &Metadata {
        self.text.metadata()
    }

    fn columns(&self) -> &Columns {
        self.text.columns()
    }

    fn notes(&self) -> Vec<String> {
        self.text.notes()
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let columns: Vec<usize> = axes.iter().map(|axis| axis.column).collect();
        match self.numbers.layout.has(columns.iter().copied()) {
            true => self.numbers.pass((&columns, axes), visitor, self, progress),
            false => self.whole()?.pass(axes, visitor, progress),
        }
    }
}
