//! Accumulates counts on threads of their own, while the caller cuts and parses text: one for what is kept of each
//! axis, and one for spectra and courses. A sum over all samples of an axis stays on one thread, because parts of a
//! record that are accumulated apart and merged lack the differences across the cuts.

use super::{
    CovariateChoice,
    covariate::{self, Derived},
    faults::{self, Faults},
    sums::{OwnSums, Part, Sums, filled},
    unrest::{self, Unrest},
    watched::{self, SharedSums, WatchedAxis},
};
use crate::dependence::block_means::BlockSums;
use allanite::course::Course;
use std::{
    collections::VecDeque,
    mem::replace,
    panic::resume_unwind,
    sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel},
    thread::{self, JoinHandle},
};

/// The number of counts of a column that are collected before they are accumulated as a slice.
const BATCH: usize = 1 << 14;

/// The number of batches of a column that may wait for a thread. With three threads on two cores, each of them stops
/// for a while.
const ROOM: usize = 8;

/// How to use the columns: the first ones are axes, and the covariates follow them.
#[derive(Clone)]
pub(super) struct Plan {
    pub(super) axes: usize,
    /// The number of first rows. Later samples are accumulated separately if only the curve is
    /// kept.
    pub(super) first: u64,
    /// What is watched, if the evidence beside the curve is kept.
    pub(super) watch: Option<Watch>,
    pub(super) faults: faults::Plan,
}

/// What is watched beside the curves.
#[derive(Clone)]
pub(super) struct Watch {
    pub(super) covariates: Vec<CovariateChoice>,
    /// Whether the fourth moments are kept, which tell jumps from Gaussian noise.
    pub(super) moments: bool,
}

impl Plan {
    fn covariates(&self) -> &[CovariateChoice] {
        let watch = self.watch.as_ref();
        watch.map_or(&[], |watch| watch.covariates.as_slice())
    }

    fn columns(&self) -> usize {
        self.axes + self.covariates().len()
    }

    /// The number of sensors whose motion is watched.
    fn sensors(&self) -> usize {
        let is_watched = self.watch.is_some() && self.faults.by_rows;
        match is_watched && self.axes.is_multiple_of(unrest::AXES) {
            true => self.axes / unrest::AXES,
            false => 0,
        }
    }

    fn kept(&self) -> AxisState {
        match &self.watch {
            Some(watch) => AxisState::Watched(watched::axis(watch.covariates.len(), watch.moments)),
            None => AxisState::InTwo {
                first: Part::new(),
                rest: Part::new(),
            },
        }
    }
}

/// A message to a thread.
enum Work {
    /// The counts of a column.
    Batch(usize, Vec<i32>),
    /// So many samples are missing after the batches that were sent so far. All of them end at the same
    /// row.
    Gap {
        missing: u64,
        /// The values that fill the gap in each watched axis, once they are known.
        filled: Vec<Vec<i32>>,
    },
}

/// Sends the counts of every column to the thread with the accumulators, which passes those of watched axes on to the
/// thread with their spectra and courses. Either takes about as long as cutting and parsing text.
pub(super) struct Batches {
    /// The batch of each column that is being filled.
    open: Vec<Vec<i32>>,
    full: SyncSender<Work>,
    /// Batches that have been accumulated and can be filled again.
    empty: Receiver<Vec<i32>>,
    thread: JoinHandle<Worker>,
    beside: JoinHandle<Vec<OwnSums>>,
}

/// What the thread has accumulated.
pub(super) struct Totals {
    /// The sums of each axis.
    pub(super) axes: Vec<Sums>,
    /// The course of the column of each covariate, in counts. The course of a column is the same whether its rate
    /// of change is the covariate or not.
    pub(super) columns: Vec<Course>,
    /// The places of the covariates that may act together, and what they share.
    pub(super) pairs: Vec<([usize; 2], SharedSums)>,
    /// The block sums of the axes, and behind them those of the columns of the covariates. Empty without covariates.
    pub(super) blocks: BlockSums,
    /// What the logger did to the samples.
    pub(super) faults: Faults,
    /// The motion of every sensor. Empty unless three axes are watched row by row.
    pub(super) unrest: Vec<Unrest>,
}

impl Batches {
    pub(super) fn new(plan: Plan) -> Self {
        let columns = plan.columns();
        let (full, incoming) = sync_channel(ROOM * columns);
        let (outgoing, empty) = channel();
        let beside = plan.watch.as_ref().map_or(0, |_| plan.axes);
        let (accumulated, incoming_beside) = sync_channel(ROOM * columns);
        let recycled = outgoing.clone();
        // The receiver of an empty batch is gone once the last batches are on their way.
        let recycle = |to: &Sender<Vec<i32>>, mut batch: Vec<i32>| {
            batch.clear();
            let _ = to.send(batch);
        };
        let thread = thread::spawn(move || {
            let mut worker = Worker::new(plan);
            for work in incoming {
                match work {
                    Work::Batch(column, batch) => worker.take(column, batch, |column, batch| {
                        if column < beside {
                            // This fails only if the other thread has panicked, which `finish` passes on.
                            let _ = accumulated.send(Work::Batch(column, batch));
                        } else {
                            recycle(&recycled, batch);
                        }
                    }),
                    Work::Gap { missing, .. } => {
                        let filled = worker.gap(missing);
                        let _ = accumulated.send(Work::Gap { missing, filled });
                    }
                }
            }
            worker
        });
        let beside = thread::spawn(move || {
            let mut axes: Vec<_> = (0..beside).map(|_| OwnSums::new()).collect();
            for work in incoming_beside {
                match work {
                    Work::Batch(axis, batch) => {
                        axes[axis].push(&batch);
                        recycle(&outgoing, batch);
                    }
                    Work::Gap { missing, filled } => {
                        for (axis, filled) in axes.iter_mut().zip(&filled) {
                            axis.gap(missing, filled);
                        }
                    }
                }
            }
            axes
        });
        Self {
            open: vec![Vec::with_capacity(BATCH); columns],
            full,
            empty,
            thread,
            beside,
        }
    }

    #[inline]
    pub(super) fn push(&mut self, column: usize, count: i32) {
        if self.open[column].len() >= BATCH {
            self.send(column);
        }
        self.open[column].push(count);
    }

    /// Forgets the last count of the first columns, which the others do not have.
    #[cold]
    pub(super) fn forget(&mut self, columns: usize) {
        for column in 0..self.open.len() {
            if column < columns {
                self.open[column].pop();
            } else if self.open[column].len() >= BATCH {
                // The columns before it have sent theirs, and all have to send equally often.
                self.send(column);
            }
        }
    }

    /// Adds counts of a column that follow each other.
    pub(super) fn extend(&mut self, column: usize, counts: &[i32]) {
        let mut rest = counts;
        while !rest.is_empty() {
            if self.open[column].len() >= BATCH {
                self.send(column);
            }
            let batch = &mut self.open[column];
            let room = BATCH.saturating_sub(batch.len());
            let (counts, after) = rest.split_at(room.min(rest.len()));
            batch.extend_from_slice(counts);
            rest = after;
        }
    }

    #[cold]
    fn send(&mut self, column: usize) {
        let next = self
            .empty
            .try_recv()
            .unwrap_or_else(|_| Vec::with_capacity(BATCH));
        let batch = replace(&mut self.open[column], next);
        // This fails only if the thread has panicked. `finish` passes the panic on.
        let _ = self.full.send(Work::Batch(column, batch));
    }

    /// Tells that so many samples are missing here, between two rows.
    #[cold]
    pub(super) fn gap(&mut self, missing: u64) {
        self.send_all();
        let _ = self.full.send(Work::Gap {
            missing,
            filled: Vec::new(),
        });
    }

    fn send_all(&mut self) {
        for column in 0..self.open.len() {
            self.send(column);
        }
    }

    pub(super) fn finish(mut self) -> Totals {
        self.send_all();
        drop(self.full);
        let worker = self.thread.join();
        let worker = worker.unwrap_or_else(|panic| resume_unwind(panic));
        let beside = self.beside.join();
        let mut beside = beside
            .unwrap_or_else(|panic| resume_unwind(panic))
            .into_iter();
        let axes = worker.axes.into_iter().map(|kept| match kept {
            AxisState::InTwo { first, rest } => Sums::InTwo { first, rest },
            AxisState::Watched(axis) => {
                // There is one for every watched axis.
                Sums::Watched(axis, beside.next().unwrap_or_else(OwnSums::new))
            }
        });
        Totals {
            axes: axes.collect(),
            columns: worker.columns,
            pairs: worker.pairs,
            blocks: worker.blocks,
            faults: worker.faults,
            unrest: worker.unrest,
        }
    }
}

/// What the first thread keeps of one axis.
enum AxisState {
    InTwo { first: Box<Part>, rest: Box<Part> },
    Watched(Box<dyn WatchedAxis>),
}

struct Worker {
    plan: Plan,
    axes: Vec<AxisState>,
    pairs: Vec<([usize; 2], SharedSums)>,
    derived: Vec<Derived>,
    columns: Vec<Course>,
    blocks: BlockSums,
    faults: Faults,
    unrest: Vec<Unrest>,
    /// If the columns come row by row, a batch waits until the batches of the other columns with the same rows
    /// arrive.
    waiting: Vec<VecDeque<Vec<i32>>>,
}

impl Worker {
    fn new(plan: Plan) -> Self {
        Self {
            axes: (0..plan.axes).map(|_| plan.kept()).collect(),
            pairs: covariate::pairs(plan.covariates())
                .map(|pair| (pair, SharedSums::new()))
                .collect(),
            derived: plan.covariates().iter().map(Derived::new).collect(),
            columns: plan.covariates().iter().map(|_| Course::new()).collect(),
            blocks: BlockSums::new(plan.columns()),
            faults: Faults::new(plan.faults.clone(), plan.axes),
            unrest: vec![Unrest::new(); plan.sensors()],
            waiting: vec![VecDeque::new(); plan.columns()],
            plan,
        }
    }

    fn take(&mut self, column: usize, batch: Vec<i32>, mut done: impl FnMut(usize, Vec<i32>)) {
        if self.derived.is_empty() && !self.faults.by_rows() {
            self.faults.push(column, &batch);
            self.accumulate(column, &batch, &[]);
            return done(column, batch);
        }
        self.waiting[column].push_back(batch);
        let complete = self.waiting.iter().all(|column| !column.is_empty());
        if !complete {
            return;
        }
        let mut rows: Vec<Vec<i32>> = self
            .waiting
            .iter_mut()
            .filter_map(VecDeque::pop_front)
            .collect();
        self.faults.push_rows(&mut rows);
        let sensors = rows.as_chunks::<{ unrest::AXES }>().0;
        for (unrest, axes) in self.unrest.iter_mut().zip(sensors) {
            unrest.push(axes.each_ref().map(Vec::as_slice));
        }
        if !self.derived.is_empty() {
            self.blocks.push(&rows);
        }
        let (axes, covariates) = rows.split_at_mut(self.plan.axes);
        for (course, counts) in self.columns.iter_mut().zip(covariates.iter()) {
            course.push_slice(counts);
        }
        for (derived, counts) in self.derived.iter_mut().zip(covariates.iter_mut()) {
            for count in counts {
                *count = derived.next(*count);
            }
        }
        for ([one, other], shared) in &mut self.pairs {
            for (&one, &other) in covariates[*one].iter().zip(&covariates[*other]) {
                shared.push((one, [other]));
            }
        }
        for (axis, counts) in axes.iter().enumerate() {
            self.accumulate(axis, counts, covariates);
        }
        for (column, counts) in rows.into_iter().enumerate() {
            done(column, counts);
        }
    }

    /// Tells that so many samples are missing here, and returns the values that fill their places in each watched axis.
    fn gap(&mut self, missing: u64) -> Vec<Vec<i32>> {
        let mut all_filled = Vec::new();
        self.faults.gap();
        self.unrest
            .iter_mut()
            .for_each(|unrest| unrest.gap(missing));
        self.blocks.gap();
        for derived in &mut self.derived {
            derived.gap();
        }
        for course in &mut self.columns {
            course.lost(missing);
        }
        for (_, shared) in &mut self.pairs {
            shared.miss(missing);
        }
        for kept in &mut self.axes {
            match kept {
                AxisState::InTwo { first, rest } => {
                    if first.accumulator.samples() >= self.plan.first {
                        rest.gap(missing);
                    } else {
                        first.gap(missing);
                    }
                }
                AxisState::Watched(axis) => {
                    all_filled.push(filled(axis.accumulator(), missing));
                    axis.gap(missing);
                }
            }
        }
        all_filled
    }

    fn accumulate(&mut self, axis: usize, counts: &[i32], covariates: &[Vec<i32>]) {
        match &mut self.axes[axis] {
            AxisState::InTwo { first, rest } => {
                let room = self.plan.first - first.accumulator.samples();
                let room = usize::try_from(room).unwrap_or(usize::MAX);
                let (of_start, of_rest) = counts.split_at(room.min(counts.len()));
                first.push(of_start);
                rest.push(of_rest);
            }
            AxisState::Watched(axis) => axis.push(counts, covariates),
        }
    }
}
