//! Reads the values of a log into accumulators. A log of counts takes one pass; any other takes one
//! more for its range and one that rounds its values to counts.

use super::{
    clock::{Clock, Tick},
    columns::AxisColumn,
    field::{Field, Stamp},
    quantum::{Quantum, Range},
    rounding::{Steps, range_of},
    sums::Sums,
    table::{Ended, RUN, Stop, Table, Visitor, visit_each},
    time_column::TimeColumn,
    tried::TriedColumns,
    watched::SharedSums,
    worker::{Batches, Plan, Totals},
};
use crate::{
    dependence::block_means::BlockSums,
    failure::{Failure, Place},
};
use allanite::{course::Course, integrity::Reason};
use indicatif::ProgressBar;
use std::path::Path;

/// The result of reading a log: one accumulator per axis, and the quanta of all columns.
pub(super) struct Measured {
    /// The sums of each axis, and the quantum that its counts are in.
    pub(super) axes: Vec<(Sums, Quantum)>,
    /// Why the numbers of each axis are too coarse for their noise. Empty for counts, which tell it themselves.
    pub(super) coarse: Vec<Option<Reason>>,
    /// The columns of the covariates.
    pub(super) covariates: Vec<CovariateColumn>,
    /// The places of the covariates that may act together, and what they share.
    pub(super) pairs: Vec<([usize; 2], SharedSums)>,
    /// The block sums of the axes, and behind them those of the columns of the covariates.
    pub(super) blocks: BlockSums,
    /// The time stamps that were followed, if the log has a time column.
    pub(super) clock: Option<Clock>,
}

/// The column of a covariate.
pub(super) struct CovariateColumn {
    pub(super) quantum: Quantum,
    /// Whether some of its values are no counts, so that it is left out.
    pub(super) flawed: bool,
    /// The course of the column in counts.
    pub(super) course: Course,
}

/// The table to read and the columns to read from it.
pub(super) struct Passes<'a, T> {
    pub(super) table: &'a T,
    pub(super) path: &'a Path,
    pub(super) columns: &'a [AxisColumn],
    /// The columns that are tried without being asked for.
    pub(super) tried: TriedColumns,
    pub(super) time: Option<&'a TimeColumn>,
    /// The rows whose stamps are known to be late, counted from 1.
    pub(super) late: Vec<u64>,
    pub(super) progress: &'a ProgressBar,
}

impl<T: Table> Passes<'_, T> {
    /// Shows every row to the visitor. If there is a time column, a clock follows its stamps.
    fn pass<V: Visitor>(&self, visitor: &mut V) -> Result<(Ended, Option<Clock>), Failure> {
        let Some(time) = self.time else {
            let ended = self.table.pass(self.columns, visitor, self.progress)?;
            return Ok((ended, None));
        };
        let mut timed = Timed {
            clock: Clock::new(time.pace, &self.late),
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

/// A visitor whose first columns are the time. It reports gaps to the visitor inside, and leaves
/// out rows whose stamp repeats.
struct Timed<'a, V> {
    clock: Clock,
    /// The number of time columns.
    columns: usize,
    /// The seconds of the current row, if seconds and nanoseconds are in two columns.
    seconds: Option<Stamp>,
    repeated: bool,
    visitor: &'a mut V,
}

impl<V: Visitor> Visitor for Timed<'_, V> {
    /// A stamp tells whether its own row is left out, and whether samples are missing before it.
    const BY_ROWS: bool = true;

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
        if let Tick::Gap(lost) = tick {
            self.visitor.gap(lost);
        }
        Ok(())
    }
}

/// Accumulates the given columns, and once more if stamps turned out to be late: only behind a stamp, the rows tell
/// whether samples were lost before it.
pub(super) fn measure<T: Table>(passes: &Passes<T>, plan: &Plan) -> Result<Measured, Failure> {
    let measured = measure_once(passes, plan)?;
    let late = measured.clock.as_ref().map_or(&[][..], Clock::found_late);
    if late.is_empty() {
        return Ok(measured);
    }
    let again = Passes {
        late: late.to_vec(),
        tried: passes.tried.clone(),
        ..*passes
    };
    measure_once(&again, plan)
}

/// Accumulates the given columns. A log of counts takes one pass. At the first value that is not a
/// count, reading starts again: one pass finds the range of each axis, and another accumulates the
/// rounded values.
fn measure_once<T: Table>(passes: &Passes<T>, plan: &Plan) -> Result<Measured, Failure> {
    let path = passes.path;
    let columns = &passes.columns[..passes.tried.first.min(passes.columns.len())];
    let mut counts = Counts {
        batches: Batches::new(plan.clone()),
        tried: passes.tried.clone(),
    };
    if let (Ended::AtTheLastRow, clock) = passes.pass(&mut counts)? {
        let whole = vec![Quantum::WHOLE; columns.len()];
        return finish(path, counts.batches, &whole, &counts.tried, clock);
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
                        "axis {}: the range of its values is too wide or too narrow for floats",
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
        tried: passes.tried.clone(),
        steps: vec![Steps::default(); columns.len()],
    };
    let (_, clock) = passes.pass(&mut rounded)?;
    for (column, steps) in columns.iter().zip(&rounded.steps) {
        // The tenth is chosen by hand.
        if steps.lost > steps.changes / 10 {
            return Err(Place::file(path).failure(
                format!(
                    "axis {}: {} of {} steps between values are smaller than a count, 2^-30 of the range",
                    column.axis, steps.lost, steps.changes
                ),
                NARROW,
            ));
        }
    }
    let mut measured = finish(
        path,
        rounded.batches,
        &rounded.quanta,
        &rounded.tried,
        clock,
    )?;
    for (column, (sums, quantum)) in columns.iter().zip(&measured.axes) {
        if !quantum.is_whole() && is_coarse(sums) {
            return Err(Place::file(path).failure(
                format!(
                    "axis {}: the noise vanishes in counts of 2^-30 of the range",
                    column.axis
                ),
                NARROW,
            ));
        }
    }
    let steps = rounded.steps.iter().zip(&measured.axes);
    let coarse = steps.map(|(steps, (sums, _))| steps.coarse(sums.accumulator()));
    measured.coarse = coarse.collect();
    Ok(measured)
}

const NARROW: &str = "remove the outliers that make the range so wide";

/// Whether rounding to counts adds more than one per cent to the Allan variance at `m = 1`. It adds
/// a twelfth of a squared count.
fn is_coarse(sums: &Sums) -> bool {
    const LEAST: f64 = 100.0 / 12.0;
    sums.accumulator().octave(0).is_some_and(|octave| {
        let variance = 0.5 * octave.sum.to_real() / octave.differences as f64;
        variance > 0.0 && variance < LEAST
    })
}

fn finish(
    path: &Path,
    batches: Batches,
    quanta: &[Quantum],
    tried: &TriedColumns,
    clock: Option<Clock>,
) -> Result<Measured, Failure> {
    let Totals {
        axes: sums,
        columns,
        pairs,
        blocks,
    } = batches.finish();
    if sums.iter().any(|axis| axis.accumulator().samples() == 0) {
        return Err(Place::file(path).failure("no rows", "record some samples"));
    }
    let (axes, covariates) = quanta.split_at(sums.len());
    let quanta = covariates.iter().map(|quantum| (*quantum, false));
    let quanta = quanta.chain(tried.quanta());
    let beside = |((quantum, flawed), course)| CovariateColumn {
        quantum,
        flawed,
        course,
    };
    Ok(Measured {
        axes: sums.into_iter().zip(axes.iter().copied()).collect(),
        coarse: Vec::new(),
        covariates: quanta.zip(columns).map(beside).collect(),
        pairs,
        blocks,
        clock,
    })
}

/// The visitor of the first pass. It stops at the first value that is not a count.
struct Counts {
    batches: Batches,
    tried: TriedColumns,
}

impl Visitor for Counts {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        let count = match self.tried.count(axis, &value) {
            Some(count) => count,
            None => value.count().ok_or(Stop::NotCounts)?,
        };
        self.batches.push(axis, count);
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        if axis >= self.tried.first {
            return visit_each(self, axis, values);
        }
        let mut counts = [0; RUN];
        let mut are_counts = true;
        for (own, value) in counts.iter_mut().zip(values) {
            let count = value.count();
            are_counts &= count.is_some();
            *own = count.unwrap_or(0);
        }
        if !are_counts {
            return visit_each(self, axis, values);
        }
        self.batches.extend(axis, &counts[..values.len()]);
        Ok(())
    }

    fn gap(&mut self, lost: u64) {
        self.batches.gap(lost);
    }
}

/// The visitor that finds the range of each axis.
struct Ranges(Vec<Range>);

impl Visitor for Ranges {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        // Columns that are tried without being asked for have no range.
        if let Some(range) = self.0.get_mut(axis) {
            range.include(value.exact().map_err(Stop::Flaw)?);
        }
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        if let Some(range) = self.0.get_mut(axis)
            && let Some(floats) = F::floats(values)
            && let Some(found) = range_of(floats)
        {
            range.include_floats(&found);
            return Ok(());
        }
        visit_each(self, axis, values)
    }
}

/// The visitor that rounds numbers to counts.
struct Rounded {
    batches: Batches,
    quanta: Vec<Quantum>,
    tried: TriedColumns,
    steps: Vec<Steps>,
}

impl Visitor for Rounded {
    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        if let Some(count) = self.tried.count(axis, &value) {
            self.batches.push(axis, count);
            return Ok(());
        }
        let number = self.quanta[axis].relative(value.exact().map_err(Stop::Flaw)?);
        let count = self.quanta[axis].count(number);
        self.steps[axis].step_to(number, count);
        self.batches.push(axis, count);
        Ok(())
    }

    fn visit_run<F: Field>(&mut self, axis: usize, values: &[F]) -> Result<(), (usize, Stop)> {
        let mut counts = [0; RUN];
        let counts = &mut counts[..values.len()];
        if axis < self.tried.first
            && let Some(floats) = F::floats(values)
            && self.quanta[axis].count_all(floats, counts)
        {
            self.steps[axis].step_through(floats, counts);
            self.batches.extend(axis, counts);
            return Ok(());
        }
        visit_each(self, axis, values)
    }

    fn gap(&mut self, lost: u64) {
        self.batches.gap(lost);
        self.steps.iter_mut().for_each(Steps::gap);
    }
}
