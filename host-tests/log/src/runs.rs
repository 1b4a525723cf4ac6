//! Runs of values of several columns, which belong to the same rows.

use super::{
    columns::AxisColumn,
    field::{Field, Flaw, Nanoseconds, Text},
    table::{Stop, Visitor, after_stop},
};
use crate::failure::{Failure, Place};
use std::ops::Range;

/// Some rows of a column, at most [`RUN`](super::table::RUN).
pub(super) struct Run {
    pub(super) values: Values,
    /// Whether the value of each row is missing. Empty if none is.
    pub(super) missing: Vec<bool>,
}

/// The values of a run. Those that are missing stand for nothing.
pub(super) enum Values {
    Int32(Vec<i32>),
    Int64(Vec<i64>),
    Uint64(Vec<u64>),
    Float(Vec<f64>),
    Date(Vec<Nanoseconds>),
}

/// Does the same with the values of any type.
macro_rules! with_values {
    ($run:expr, $values:ident => $work:expr) => {
        match $run {
            Values::Int32($values) => $work,
            Values::Int64($values) => $work,
            Values::Uint64($values) => $work,
            Values::Float($values) => $work,
            Values::Date($values) => $work,
        }
    };
}

impl Run {
    pub(super) fn of(values: Values) -> Self {
        let missing = Vec::new();
        Self { values, missing }
    }

    pub(super) fn number(&self, row: usize) -> Option<f64> {
        with_values!(&self.values, values => values[row].number().ok())
    }

    /// Whether all of these rows are numbers. Integers are.
    fn are_numbers(&self, rows: Range<usize>) -> bool {
        if self.missing.iter().any(|missing| *missing) {
            return false;
        }
        match &self.values {
            // Without an early end, the loop is spread over vectors.
            Values::Float(values) => {
                let values = values[rows].iter();
                values.fold(true, |all, value| all & value.is_finite())
            }
            Values::Date(_) => false,
            _ => true,
        }
    }

    fn visit<V: Visitor>(&self, axis: usize, row: usize, visitor: &mut V) -> Result<(), Stop> {
        if self.missing.get(row) == Some(&true) {
            return visitor.visit(axis, Text(b""));
        }
        with_values!(&self.values, values => visitor.visit(axis, values[row]))
    }

    fn visit_run<V: Visitor>(
        &self,
        axis: usize,
        rows: Range<usize>,
        visitor: &mut V,
    ) -> Result<(), (usize, Stop)> {
        with_values!(&self.values, values => visitor.visit_run(axis, &values[rows]))
    }

    /// Shows the visitor the stamps of rows from a row on. Those behind a row that has none are shown one by one.
    fn visit_stamps<V: Visitor>(
        &self,
        rows: Range<usize>,
        visitor: &mut V,
    ) -> (usize, Result<Option<V::Followed>, Stop>) {
        let end = match self.missing.get(rows.clone()) {
            Some(missing) => missing.iter().position(|missing| *missing),
            None => None,
        };
        match end {
            Some(0) => visitor.visit_stamps(&[Text(b"")]),
            end => {
                let rows = rows.start..end.map_or(rows.end, |end| rows.start + end);
                with_values!(&self.values, values => visitor.visit_stamps(&values[rows]))
            }
        }
    }
}

/// The first rows of runs, and where they stand.
pub(super) struct Rows<'a, P, O> {
    /// The run of each column.
    pub(super) runs: &'a [Run],
    pub(super) rows: usize,
    /// The columns.
    pub(super) axes: &'a [AxisColumn],
    /// The place of a row.
    pub(super) place: P,
    /// What says more than the flaw of a stamp in a row.
    pub(super) of_stamp: O,
}

impl<P: Fn(usize) -> Place, O: Fn(usize, &Flaw) -> Option<Failure>> Rows<'_, P, O> {
    /// Shows the rows to a visitor. Returns whether it wants more.
    pub(super) fn show<V: Visitor>(&self, visitor: &mut V) -> Result<bool, Failure> {
        if visitor.takes_stamps() {
            return self.show_behind_stamps(visitor);
        }
        // A row whose values are not all numbers has to be seen as a row.
        if V::BY_ROWS || !self.are_numbers(0, 0..self.rows) {
            return self.show_each(0, 0..self.rows, visitor);
        }
        self.show_runs(0, 0..self.rows, visitor)
    }

    /// Shows the rows behind their stamps, as many at once as follow each other.
    fn show_behind_stamps<V: Visitor>(&self, visitor: &mut V) -> Result<bool, Failure> {
        let Some((stamps, _)) = self.runs.split_first() else {
            return Ok(true);
        };
        let mut row = 0;
        while row < self.rows {
            let (plain, next) = stamps.visit_stamps(row..self.rows, visitor);
            let rows = row..row + plain;
            let goes_on = match self.are_numbers(1, rows.clone()) {
                true => self.show_runs(1, rows, visitor),
                false => self.show_each(1, rows, visitor),
            };
            if !goes_on? {
                return Ok(false);
            }
            row += plain;
            match next {
                Ok(None) => {}
                Ok(Some(followed)) => {
                    visitor.settle(followed);
                    if !self.show_each(1, row..row + 1, visitor)? {
                        return Ok(false);
                    }
                    row += 1;
                }
                Err(stop) => {
                    if !self.after_stop(row, (0, &stop), visitor)? {
                        return Ok(false);
                    }
                    row += 1;
                }
            }
        }
        Ok(true)
    }

    /// Whether all values of these rows are numbers, from a column on.
    fn are_numbers(&self, first: usize, rows: Range<usize>) -> bool {
        let mut runs = self.runs[first..].iter();
        runs.all(|run| run.are_numbers(rows.clone()))
    }

    fn show_each<V: Visitor>(
        &self,
        first: usize,
        rows: Range<usize>,
        visitor: &mut V,
    ) -> Result<bool, Failure> {
        for row in rows {
            for (column, run) in self.runs.iter().enumerate().skip(first) {
                let Err(stop) = run.visit(column, row, visitor) else {
                    continue;
                };
                if !self.after_stop(row, (column, &stop), visitor)? {
                    return Ok(false);
                }
                break;
            }
        }
        Ok(true)
    }

    fn show_runs<V: Visitor>(
        &self,
        first: usize,
        rows: Range<usize>,
        visitor: &mut V,
    ) -> Result<bool, Failure> {
        if rows.is_empty() {
            return Ok(true);
        }
        for (column, run) in self.runs.iter().enumerate().skip(first) {
            if let Err((row, stop)) = run.visit_run(column, rows.clone(), visitor) {
                self.after_stop(rows.start + row, (column, &stop), visitor)?;
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn after_stop<V: Visitor>(
        &self,
        row: usize,
        (column, stop): (usize, &Stop),
        visitor: &mut V,
    ) -> Result<bool, Failure> {
        if let Stop::Clock(flaw) = stop
            && let Some(failure) = (self.of_stamp)(row, flaw)
        {
            return Err(failure);
        }
        after_stop(visitor, (column, stop), self.axes, || (self.place)(row))
    }
}
