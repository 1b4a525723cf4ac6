//! Reads the values of a log into accumulators. A log of counts takes one pass; any other takes one
//! more for its range and one that rounds its values to counts.

use super::{
    clock::{Clock, Late},
    columns::AxisColumn,
    cuts::{Cuts, Dropped},
    faults::Faults,
    field::{Exact, Field},
    hands::{Batches, Totals},
    quantum::{Quantum, Range},
    rounding::{Steps, range_of},
    rows::{Rows, Tally},
    sums::Sums,
    table::{Ended, RUN, Stop, Table, Visitor, visit_each},
    time_column::TimeColumn,
    tried::TriedColumns,
    watched::SharedSums,
    worker::Plan,
};
use crate::{
    block_means::BlockSums,
    failure::{Failure, Place, brief, plural},
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
    /// What the logger did to the samples of the axes.
    pub(super) faults: Faults,
    /// The time stamps that were followed, if the log has a time column.
    pub(super) clock: Option<Clock>,
    /// What became of the rows.
    pub(super) tally: Tally,
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
    /// The sample rate, if it is told.
    pub(super) rate_hz: Option<f64>,
    /// The times that are left out.
    pub(super) dropped: Dropped,
    /// The rows whose stamps are known to be late.
    pub(super) late: Vec<Late>,
    pub(super) progress: &'a ProgressBar,
}

impl<T: Table> Passes<'_, T> {
    /// Shows every row to the visitor. If there is a time column, a clock follows its stamps.
    fn pass<V: Visitor>(&self, visitor: &mut V) -> Result<Passed, Failure> {
        self.pass_over(self.columns, visitor)
    }

    fn pass_over<V: Visitor>(
        &self,
        columns: &[AxisColumn],
        visitor: &mut V,
    ) -> Result<Passed, Failure> {
        match self.time.is_some() || !self.dropped.is_none() {
            true => self.pass_as::<V, true>(columns, visitor),
            false => self.pass_as::<V, false>(columns, visitor),
        }
    }

    fn pass_as<V: Visitor, const EACH: bool>(
        &self,
        columns: &[AxisColumn],
        visitor: &mut V,
    ) -> Result<Passed, Failure> {
        let clock = |time: &TimeColumn| {
            let clock = Clock::new(time.pace, &self.late);
            let clock = if time.is_date {
                clock.of_times()
            } else {
                clock
            };
            (clock, time.columns.len())
        };
        let clock = self.time.map(clock);
        let rate_hz = self.rate_hz.unwrap_or(f64::NAN);
        let is_by_rows = self.table.by_rows();
        let mut rows = Rows::<V, EACH>::new(clock, rate_hz, is_by_rows, &self.dropped, visitor);
        let time = self.time.map_or(&[][..], |time| &time.columns);
        let columns = [time, columns].concat();
        let ended = self.table.pass(&columns, &mut rows, self.progress)?;
        if matches!(ended, Ended::AtTheLastRow) {
            rows.tally.check()?;
        }
        Ok(Passed {
            ended,
            clock: rows.clock,
            tally: rows.tally,
        })
    }

    /// Finds the times that the user leaves out. If they are counted from the end, a pass finds that.
    pub(super) fn cut(&mut self, cuts: &Cuts) -> Result<(), Failure> {
        if cuts.is_empty() {
            return Ok(());
        }
        let mut end_s = f64::INFINITY;
        if cuts.need_end() {
            // Nothing falls behind the end of time, so that every row is followed.
            self.dropped = Dropped::ALL;
            end_s = self
                .pass_over(&self.columns[..1], &mut Nothing)?
                .tally
                .end_s;
        }
        self.dropped = cuts.dropped(end_s)?;
        if self.dropped.has_stretches() && !self.table.by_rows() {
            return Err(Place::file(self.path).failure(
                "--drop needs rows, but the columns lie one behind the other",
                "save the array in C order, or cut it with --from and --to",
            ));
        }
        Ok(())
    }

    /// A note on what is left out.
    ///
    /// # Errors
    /// When a stretch lies behind the end of the log.
    pub(super) fn left_out(&self, tally: &Tally, rate_hz: f64) -> Result<Option<String>, Failure> {
        let Tally { cut, end_s, .. } = *tally;
        if let Some(stretch) = self.dropped.behind(end_s) {
            return Err(Place::file(self.path).failure(
                format!(
                    "--drop {stretch} lies behind the end of the log, {} s",
                    brief(end_s)
                ),
                "give a stretch within the log",
            ));
        }
        let note = || {
            let seconds = brief((cut as f64 / rate_hz * 1000.0).round() / 1000.0);
            format!(
                "{} left out, {seconds} s of {} s",
                plural(cut, "row"),
                brief(end_s)
            )
        };
        Ok((cut > 0).then(note))
    }
}

/// A pass that met no error.
struct Passed {
    ended: Ended,
    clock: Option<Clock>,
    tally: Tally,
}

/// The visitor that needs no values.
struct Nothing;

impl Visitor for Nothing {
    type Followed = ();

    fn visit<F: Field>(&mut self, _axis: usize, _value: F) -> Result<(), Stop> {
        Ok(())
    }
}

/// Accumulates the given columns, and once more if stamps turned out to be late: only behind a stamp, the rows tell
/// whether samples were lost before it. Samples that the logger repeated or interpolated are left out in another pass, because only the
/// whole record tells them.
pub(super) fn measure<T: Table>(passes: &Passes<T>, plan: &Plan) -> Result<Measured, Failure> {
    let again = |late: &[Late]| Passes {
        late: late.to_vec(),
        dropped: passes.dropped.clone(),
        tried: passes.tried.clone(),
        ..*passes
    };
    let mut measured = measure_once(passes, plan)?;
    let late = measured
        .clock
        .as_ref()
        .map_or(Vec::new(), Clock::found_late);
    if !late.is_empty() {
        measured = measure_once(&again(&late), plan)?;
    }
    let Some(faults) = measured.faults.without_copies() else {
        return Ok(measured);
    };
    let plan = Plan {
        faults,
        ..plan.clone()
    };
    measure_once(&again(&late), &plan)
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
    let passed = passes.pass(&mut counts)?;
    if matches!(passed.ended, Ended::AtTheLastRow) {
        let whole = vec![Quantum::WHOLE; columns.len()];
        return finish(path, counts.batches, &whole, &counts.tried, passed);
    }

    let mut ranges = Ranges(vec![Range::EMPTY; columns.len()]);
    passes.pass(&mut ranges)?;
    let ranges = ranges.0;
    let quanta = columns
        .iter()
        .zip(ranges.iter().copied())
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
    let (measured, steps) = measure_rounded(passes, plan, quanta.clone())?;
    check_rounded(path, columns, &steps, &measured)?;
    let axes = measured.axes.iter().zip(&steps).zip(ranges);
    let grids: Vec<Option<Quantum>> = axes
        .map(|(((sums, quantum), steps), range)| {
            let step = steps.grid(sums.accumulator())? * quantum.step();
            Quantum::of_steps(range, step)
        })
        .collect();
    if grids.iter().all(Option::is_none) {
        return Ok(measured);
    }
    // Numbers that were rounded to steps as large as their noise are counts of these steps.
    let grids = grids.into_iter().chain(std::iter::repeat(None));
    let quanta = quanta.into_iter().zip(grids);
    let quanta = quanta.map(|(quantum, grid)| grid.unwrap_or(quantum));
    measure_rounded(passes, plan, quanta.collect()).map(|(measured, _)| measured)
}

/// Accumulates the given columns, whose numbers are rounded to these quanta.
fn measure_rounded<T: Table>(
    passes: &Passes<T>,
    plan: &Plan,
    quanta: Vec<Quantum>,
) -> Result<(Measured, Vec<Steps>), Failure> {
    let mut plan = plan.clone();
    let zero = |quantum: &Quantum| quantum.count(quantum.relative(Exact::Float(0.0)));
    plan.faults.zeros = quanta.iter().map(zero).collect();
    let mut rounded = Rounded {
        batches: Batches::new(plan),
        steps: vec![Steps::default(); quanta.len()],
        quanta,
        tried: passes.tried.clone(),
    };
    let passed = passes.pass(&mut rounded)?;
    let mut measured = finish(
        passes.path,
        rounded.batches,
        &rounded.quanta,
        &rounded.tried,
        passed,
    )?;
    let steps = rounded.steps.iter().zip(&measured.axes);
    let coarse = steps.map(|(steps, (sums, _))| steps.coarse(sums.accumulator()));
    measured.coarse = coarse.collect();
    Ok((measured, rounded.steps))
}

/// Checks that rounding to counts far below the range is far below the noise as well.
fn check_rounded(
    path: &Path,
    columns: &[AxisColumn],
    steps: &[Steps],
    measured: &Measured,
) -> Result<(), Failure> {
    for (column, steps) in columns.iter().zip(steps) {
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
    Ok(())
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
    passed: Passed,
) -> Result<Measured, Failure> {
    let Totals {
        axes: sums,
        columns,
        pairs,
        blocks,
        faults,
    } = batches.finish();
    if sums.iter().any(|axis| axis.accumulator().samples() == 0) {
        return Err(match passed.tally.cut {
            0 => Place::file(path).failure("no rows", "record some samples"),
            _ => Place::file(path).failure("all rows are left out", "leave out less of the log"),
        });
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
        faults,
        clock: passed.clock,
        tally: passed.tally,
    })
}

/// The visitor of the first pass. It stops at the first value that is not a count.
struct Counts {
    batches: Batches,
    tried: TriedColumns,
}

impl Visitor for Counts {
    const ONLY_COUNTS: bool = true;

    type Followed = ();

    #[inline]
    fn visit<F: Field>(&mut self, axis: usize, value: F) -> Result<(), Stop> {
        let count = match self.tried.count(axis, &value) {
            Some(count) => count,
            None => match value.count() {
                Some(count) => count,
                // What is no number at all is no reason to read the others as such.
                None => {
                    value.number().map_err(Stop::Flaw)?;
                    return Err(Stop::NotCounts);
                }
            },
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

    fn gap(&mut self, missing: u64) {
        self.batches.gap(missing);
    }

    fn forget(&mut self, columns: usize) {
        self.batches.forget(columns);
    }
}

/// The visitor that finds the range of each axis.
struct Ranges(Vec<Range>);

impl Visitor for Ranges {
    type Followed = ();

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
    type Followed = ();

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

    fn forget(&mut self, columns: usize) {
        self.batches.forget(columns);
    }

    fn gap(&mut self, missing: u64) {
        self.batches.gap(missing);
        self.steps.iter_mut().for_each(Steps::gap);
    }
}
