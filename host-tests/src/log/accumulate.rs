//! The passes over a log: into counts, and where that cannot be, through the range into counts.

use super::{
    clock::{Clock, Tick},
    columns::AxisColumn,
    field::{Field, Stamp},
    quantum::{Quantum, Range},
    table::{Ended, Stop, Table, Visitor},
    time_column::TimeColumn,
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
    /// What the stamps told, if there were some.
    pub(super) clock: Option<Clock>,
}

/// What to go through, and how.
pub(super) struct Passes<'a, T> {
    pub(super) table: &'a T,
    pub(super) path: &'a Path,
    pub(super) columns: &'a [AxisColumn],
    pub(super) time: Option<&'a TimeColumn>,
    pub(super) progress: &'a ProgressBar,
}

impl<T: Table> Passes<'_, T> {
    /// Shows every row to the visitor, and to a clock if there is a time.
    fn pass<V: Visitor>(&self, visitor: &mut V) -> Result<(Ended, Option<Clock>), Failure> {
        let Some(time) = self.time else {
            let ended = self.table.pass(self.columns, visitor, self.progress)?;
            return Ok((ended, None));
        };
        let mut timed = Timed {
            clock: Clock::new(time.pace),
            columns: time.columns.len(),
            seconds: None,
            repeated: false,
            visitor,
        };
        let columns = [&time.columns, self.columns].concat();
        let ended = self.table.pass(&columns, &mut timed, self.progress)?;
        Ok((ended, Some(timed.clock)))
    }
}

/// A pass whose first columns are the time: it says where gaps are and which rows to leave out.
struct Timed<'a, V> {
    clock: Clock,
    /// Columns of the time.
    columns: usize,
    /// The first of two.
    seconds: Option<Stamp>,
    repeated: bool,
    visitor: &'a mut V,
}

impl<V: Visitor> Visitor for Timed<'_, V> {
    #[inline]
    fn visit<F: Field>(&mut self, column: usize, value: F) -> Result<(), Stop> {
        if let Some(axis) = column.checked_sub(self.columns) {
            return match self.repeated {
                false => self.visitor.visit(axis, value),
                true => Ok(()),
            };
        }
        let mut stamp = value.stamp().map_err(Stop::Flaw)?;
        if column + 1 < self.columns {
            self.seconds = Some(stamp);
            return Ok(());
        }
        if let Some(seconds) = self.seconds {
            stamp = stamp.behind_seconds(seconds);
        }
        let tick = self.clock.tick(stamp).map_err(Stop::Clock)?;
        self.repeated = tick == Tick::Repeated;
        if tick == Tick::Gap {
            self.visitor.gap();
        }
        Ok(())
    }
}

/// Accumulates the given columns. Counts take one pass; at the first value that is none, the
/// reading starts again, once for the range and once for the counts.
pub(super) fn measure<T: Table>(passes: &Passes<T>, plan: &Plan) -> Result<Measured, Failure> {
    let Passes { path, columns, .. } = *passes;
    let mut counts = Counts(Batches::new(plan.clone()));
    if let (Ended::AtTheLastRow, clock) = passes.pass(&mut counts)? {
        let whole = vec![Quantum::WHOLE; columns.len()];
        return finish(path, counts.0, &whole, clock);
    }

    let mut ranges = Ranges(vec![Range::EMPTY; columns.len()]);
    passes.pass(&mut ranges)?;
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
        batches: Batches::new(plan.clone()),
        quanta,
        steps: vec![Steps::default(); columns.len()],
    };
    let (_, clock) = passes.pass(&mut rounded)?;
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
    finish(path, rounded.batches, &rounded.quanta, clock)
}

fn finish(
    path: &Path,
    batches: Batches,
    quanta: &[Quantum],
    clock: Option<Clock>,
) -> Result<Measured, Failure> {
    let sums = batches.finish();
    if sums.iter().any(|axis| axis.accumulator().samples() == 0) {
        return Err(Place::file(path).failure("no rows", "record some samples"));
    }
    let (axes, covariates) = quanta.split_at(sums.len());
    Ok(Measured {
        axes: sums.into_iter().zip(axes.iter().copied()).collect(),
        covariates: covariates.to_vec(),
        clock,
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

    fn gap(&mut self) {
        self.0.gap();
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

    fn gap(&mut self) {
        self.batches.gap();
        self.steps.iter_mut().for_each(|steps| steps.last = None);
    }
}
