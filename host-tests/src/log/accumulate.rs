//! The passes over a log: into counts, and where that cannot be, through the range into counts.

use super::{
    AxisColumn, Ended, Field, OCTAVES, Stop, Table, Visitor,
    quantum::{Quantum, Range},
};
use crate::failure::{Failure, Place};
use allanite::Accumulator;
use indicatif::ProgressBar;
use std::{
    mem::replace,
    panic::resume_unwind,
    path::Path,
    sync::mpsc::{Receiver, SyncSender, channel, sync_channel},
    thread::{self, JoinHandle},
};

/// Counts of an axis that are collected before they are accumulated as a slice.
const BATCH: usize = 1 << 13;

/// One axis, measured in counts.
pub(super) struct Measured {
    pub(super) accumulator: Accumulator<OCTAVES>,
    /// What lies behind the part that was asked for.
    pub(super) rest: Accumulator<OCTAVES>,
    /// What one count is, in numbers of the log.
    pub(super) quantum: f64,
    /// Whether the log's numbers are the counts.
    pub(super) whole: bool,
}

/// Accumulates the given columns. Counts take one pass; at the first value that is none, the
/// reading starts again, once for the range and once for the counts. Rows behind the `first` are
/// accumulated apart.
pub(super) fn measure(
    table: &impl Table,
    path: &Path,
    columns: &[AxisColumn],
    first: u64,
    progress: &ProgressBar,
) -> Result<Vec<Measured>, Failure> {
    let mut counts = Counts(Batches::new(columns.len(), first));
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
        batches: Batches::new(columns.len(), first),
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

fn finish(path: &Path, batches: Batches, quanta: &[Quantum]) -> Result<Vec<Measured>, Failure> {
    let parts = batches.finish();
    if parts.iter().any(|[first, _]| first.samples() == 0) {
        return Err(Place::file(path).failure("no rows", "record some samples"));
    }
    let measured = |([accumulator, rest], quantum): (Parts, &Quantum)| Measured {
        accumulator,
        rest,
        quantum: quantum.step(),
        whole: *quantum == Quantum::WHOLE,
    };
    Ok(parts.into_iter().zip(quanta).map(measured).collect())
}

/// The first samples of an axis, and the rest.
type Parts = [Accumulator<OCTAVES>; 2];

/// Counts of every axis on their way into the accumulators, which run in a thread of their own:
/// accumulating takes about as long as cutting and parsing text.
struct Batches {
    /// The batch of each axis that is being filled.
    open: Vec<Vec<i32>>,
    full: SyncSender<(usize, Vec<i32>)>,
    /// Batches that have been accumulated, to be filled again.
    empty: Receiver<Vec<i32>>,
    thread: JoinHandle<Vec<Parts>>,
}

impl Batches {
    fn new(axes: usize, first: u64) -> Self {
        let (full, incoming) = sync_channel::<(usize, Vec<i32>)>(2 * axes);
        let (outgoing, empty) = channel();
        let thread = thread::spawn(move || {
            let mut parts: Vec<Parts> = vec![[const { Accumulator::new() }; 2]; axes];
            for (axis, mut batch) in incoming {
                let [start, rest] = &mut parts[axis];
                let room = usize::try_from(first - start.samples()).unwrap_or(usize::MAX);
                let (of_start, of_rest) = batch.split_at(room.min(batch.len()));
                start.push_slice(of_start);
                rest.push_slice(of_rest);
                batch.clear();
                // Nobody fills batches any more once the last ones are on their way.
                let _ = outgoing.send(batch);
            }
            parts
        });
        Self {
            open: vec![Vec::with_capacity(BATCH); axes],
            full,
            empty,
            thread,
        }
    }

    #[inline]
    fn push(&mut self, axis: usize, count: i32) {
        let batch = &mut self.open[axis];
        batch.push(count);
        if batch.len() >= BATCH {
            self.send(axis);
        }
    }

    #[cold]
    fn send(&mut self, axis: usize) {
        let next = self
            .empty
            .try_recv()
            .unwrap_or_else(|_| Vec::with_capacity(BATCH));
        let batch = replace(&mut self.open[axis], next);
        // Fails if the thread has panicked only, which `finish` passes on.
        let _ = self.full.send((axis, batch));
    }

    fn finish(mut self) -> Vec<Parts> {
        for axis in 0..self.open.len() {
            self.send(axis);
        }
        drop(self.full);
        self.thread
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))
    }
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
