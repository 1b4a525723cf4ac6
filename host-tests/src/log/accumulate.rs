//! The passes over a log: into counts, and where that cannot be, through the range into counts.

use super::{
    AxisColumn, Ended, Field, Stop, Table, Visitor,
    quantum::{self, Quantum, Range},
    worker::{Batches, Plan, Sums},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use std::path::Path;

/// Columns, measured in counts.
pub(super) struct Measured {
    /// Of each axis, with its quantum.
    pub(super) axes: Vec<(Sums, Quantum)>,
    /// Of each covariate.
    pub(super) covariates: Vec<Quantum>,
}

/// Accumulates the given columns. Counts take one pass; at the first value that is none, the
/// reading starts again, once for the range and once for the counts.
pub(super) fn measure(
    table: &impl Table,
    path: &Path,
    columns: &[AxisColumn],
    plan: &Plan,
    progress: &ProgressBar,
) -> Result<Measured, Failure> {
    let mut counts = Counts(Batches::new(plan.clone()));
    if let Ended::AtTheLastRow = table.pass(columns, &mut counts, progress)? {
        let whole = vec![Quantum::WHOLE; columns.len()];
        return finish(path, counts.0, &whole);
    }

    let mut ranges = Ranges(vec![Range::EMPTY; columns.len()]);
    table.pass(columns, &mut ranges, progress)?;
    let quanta = columns
        .iter()
        .zip(ranges.0)
        .map(|(column, range)| {
            Quantum::of(range).ok_or_else(|| {
                Place::file(path).failure(
                    format!(
                        "axis {}: its range is beyond what floats can scale",
                        column.axis
                    ),
                    "scale the values or remove the outliers",
                )
            })
        })
        .collect::<Result<Vec<_>, _>>()?;

    let mut rounded = Rounded {
        batches: Batches::new(Plan {
            fineness: quantum::FINENESS,
            ..plan.clone()
        }),
        quanta,
        steps: vec![Steps::default(); columns.len()],
    };
    table.pass(columns, &mut rounded, progress)?;
    for (column, steps) in columns.iter().zip(&rounded.steps) {
        if steps.lost > steps.all / 10 {
            return Err(Place::file(path).failure(
                format!(
                    "axis {}: {} of {} steps between values are lost in 2^-30 of their range",
                    column.axis, steps.lost, steps.all
                ),
                "remove the outliers that make the range so wide",
            ));
        }
    }
    finish(path, rounded.batches, &rounded.quanta)
}

fn finish(path: &Path, batches: Batches, quanta: &[Quantum]) -> Result<Measured, Failure> {
    let sums = batches.finish();
    if sums.iter().any(|axis| axis.accumulator.samples() == 0) {
        return Err(Place::file(path).failure("no rows", "record some samples"));
    }
    let (axes, covariates) = quanta.split_at(sums.len());
    Ok(Measured {
        axes: sums.into_iter().zip(axes.iter().copied()).collect(),
        covariates: covariates.to_vec(),
    })
}

/// The pass for logs of counts, given up at the first value that is none.
struct Counts(Batches);

impl Visitor for Counts {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        self.0.push(axis, value.count().ok_or(Stop::NotCounts)?);
        Ok(())
    }
}

/// The pass for the range of each axis.
struct Ranges(Vec<Range>);

impl Visitor for Ranges {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        self.0[axis].include(value.number().map_err(Stop::Flaw)?);
        Ok(())
    }
}

/// The pass that turns numbers into counts.
struct Rounded {
    batches: Batches,
    quanta: Vec<Quantum>,
    steps: Vec<Steps>,
}

/// Differences of neighbours in one axis.
#[derive(Clone, Copy, Default)]
struct Steps {
    last: Option<(f64, i32)>,
    all: u64,
    /// Those that differ as numbers and not as counts.
    lost: u64,
}

impl Steps {
    #[inline]
    fn step_to(&mut self, number: f64, count: i32) {
        if let Some((last, last_count)) = self.last {
            self.all += 1;
            self.lost += u64::from(number != last && count == last_count);
        }
        self.last = Some((number, count));
    }
}

impl Visitor for Rounded {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        let number = value.number().map_err(Stop::Flaw)?;
        let count = self.quanta[axis].count(number);
        self.steps[axis].step_to(number, count);
        self.batches.push(axis, count);
        Ok(())
    }
}
