//! The states of all axes that a query has begun.

use crate::{
    axis::Axis,
    rows::{Columns, Rows},
};
use datafusion::{
    arrow::array::{Array, ArrayRef, BinaryBuilder, BooleanArray},
    error::Result,
    logical_expr::{Accumulator, EmitTo, GroupsAccumulator},
    scalar::ScalarValue,
};
use std::sync::Arc;

/// The states of the groups of a query, by the engine's numbers of the groups. Rows are read where they lie.
#[derive(Debug)]
pub(crate) struct Groups {
    rows: Rows,
    axes: Vec<Option<Axis>>,
    /// About how many bytes the states have.
    allocated: usize,
}

impl Groups {
    pub(crate) const fn new(rows: Rows) -> Self {
        Self {
            rows,
            axes: Vec::new(),
            allocated: 0,
        }
    }

    /// Adds the rows of a batch, each to its group.
    fn add(
        &mut self,
        rows: Rows,
        columns: &[ArrayRef],
        groups: &[usize],
        filter: Option<&BooleanArray>,
        number: usize,
    ) -> Result<()> {
        self.axes.resize_with(number.max(self.axes.len()), || None);
        let columns = Columns::of(rows, columns)?;
        for (row, &group) in groups.iter().enumerate() {
            let is_out = filter.is_some_and(|filter| filter.is_null(row) || !filter.value(row));
            let Some(axis) = self.axes.get_mut(group).filter(|_| !is_out) else {
                continue;
            };
            let before = axis.as_ref().map_or(0, Axis::allocated);
            columns.add(row, axis)?;
            self.allocated += axis.as_ref().map_or(0, Axis::allocated);
            self.allocated = self.allocated.saturating_sub(before);
        }
        Ok(())
    }

    /// The states of groups that the engine needs no more.
    fn emitted(&mut self, which: EmitTo) -> Result<ArrayRef> {
        let mut states = BinaryBuilder::new();
        for mut axis in which.take_needed(&mut self.axes) {
            self.allocated -= axis.as_ref().map_or(0, Axis::allocated).min(self.allocated);
            states.append_option(axis.as_mut().map(Axis::state).transpose()?);
        }
        Ok(Arc::new(states.finish()))
    }
}

impl GroupsAccumulator for Groups {
    fn update_batch(
        &mut self,
        columns: &[ArrayRef],
        groups: &[usize],
        filter: Option<&BooleanArray>,
        number: usize,
    ) -> Result<()> {
        self.add(self.rows, columns, groups, filter, number)
    }

    fn merge_batch(&mut self, columns: &[ArrayRef], groups: &[usize], number: usize) -> Result<()> {
        self.add(Rows::States, columns, groups, None, number)
    }

    fn convert_to_state(
        &self,
        columns: &[ArrayRef],
        filter: Option<&BooleanArray>,
    ) -> Result<Vec<ArrayRef>> {
        // Each row is a group of its own.
        let number = columns.first().map_or(0, |column| column.len());
        let groups: Vec<usize> = (0..number).collect();
        let mut own = Self::new(self.rows);
        own.add(self.rows, columns, &groups, filter, number)?;
        own.state(EmitTo::All)
    }

    fn evaluate(&mut self, which: EmitTo) -> Result<ArrayRef> {
        self.emitted(which)
    }

    fn state(&mut self, which: EmitTo) -> Result<Vec<ArrayRef>> {
        Ok(vec![self.emitted(which)?])
    }

    fn size(&self) -> usize {
        self.axes.capacity() * size_of::<Option<Axis>>() + self.allocated
    }
}

/// The state of a query without groups.
#[derive(Debug)]
pub(crate) struct One {
    rows: Rows,
    axis: Option<Axis>,
}

impl One {
    pub(crate) const fn new(rows: Rows) -> Self {
        Self { rows, axis: None }
    }

    fn add(&mut self, rows: Rows, columns: &[ArrayRef]) -> Result<()> {
        let number = columns.first().map_or(0, |column| column.len());
        let columns = Columns::of(rows, columns)?;
        (0..number).try_for_each(|row| columns.add(row, &mut self.axis))
    }
}

impl Accumulator for One {
    fn update_batch(&mut self, columns: &[ArrayRef]) -> Result<()> {
        self.add(self.rows, columns)
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        self.add(Rows::States, states)
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        let state = self.axis.as_mut().map(Axis::state).transpose()?;
        Ok(ScalarValue::Binary(state))
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        Ok(vec![self.evaluate()?])
    }

    fn size(&self) -> usize {
        size_of::<Self>() + self.axis.as_ref().map_or(0, Axis::allocated)
    }
}
