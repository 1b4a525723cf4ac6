//! Accumulates counts on threads of their own, where there are threads, while the caller cuts and parses text: one for what is
//! kept of each axis, and one for spectra and courses. A sum over all samples of an axis stays on one thread, because parts of a
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
    io,
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

/// Hands the counts of every column to the accumulators, and what they leave of watched axes to their spectra and courses.
/// Either takes about as long as cutting and parsing text.
pub(super) struct Batches {
    /// The batch of each column that is being filled.
    open: Vec<Vec<i32>>,
    hands: Hands,
}

/// Who accumulates.
enum Hands {
    Threads(Threads),
    /// The caller itself, where no thread can be started, as in a page.
    Caller {
        worker: Box<Worker>,
        beside: Beside,
        /// Batches that can be filled again.
        empty: Vec<Vec<i32>>,
    },
}

/// Two threads: the first one has the accumulators and passes the counts of watched axes on to the second one.
struct Threads {
    full: SyncSender<Work>,
    /// Batches that have been accumulated and can be filled again.
    empty: Receiver<Vec<i32>>,
    thread: JoinHandle<Worker>,
    beside: JoinHandle<Beside>,
}

/// The spectra and courses of the watched axes.
struct Beside(Vec<OwnSums>);

impl Beside {
    fn new(plan: &Plan) -> Self {
        let axes = plan.watch.as_ref().map_or(0, |_| plan.axes);
        Self((0..axes).map(|_| OwnSums::new()).collect())
    }

    /// Takes what the accumulators pass on, and gives the batch back.
    fn take(&mut self, work: Work) -> Option<Vec<i32>> {
        match work {
            Work::Batch(axis, batch) => {
                self.0[axis].push(&batch);
                Some(batch)
            }
            Work::Gap { missing, filled } => {
                for (axis, filled) in self.0.iter_mut().zip(&filled) {
                    axis.gap(missing, filled);
                }
                None
            }
        }
    }
}

impl Threads {
    /// Starts the threads.
    ///
    /// # Errors
    /// When the system starts no thread.
    fn start(plan: Plan) -> io::Result<Self> {
        let columns = plan.columns();
        let (full, incoming) = sync_channel(ROOM * columns);
        let (outgoing, empty) = channel();
        let mut kept_beside = Beside::new(&plan);
        let watched = kept_beside.0.len();
        let (accumulated, incoming_beside) = sync_channel(ROOM * columns);
        let recycled = outgoing.clone();
        // The receiver of an empty batch is gone once the last batches are on their way.
        let recycle = |to: &Sender<Vec<i32>>, mut batch: Vec<i32>| {
            batch.clear();
            let _ = to.send(batch);
        };
        let thread = thread::Builder::new().spawn(move || {
            let mut worker = Worker::new(plan);
            for work in incoming {
                worker.work(work, watched, |work| match work {
                    // This fails only if the other thread has panicked, which `finish` passes on.
                    Done::Passed(work) => drop(accumulated.send(work)),
                    Done::Free(batch) => recycle(&recycled, batch),
                });
            }
            worker
        })?;
        let beside = thread::Builder::new().spawn(move || {
            for work in incoming_beside {
                if let Some(batch) = kept_beside.take(work) {
                    recycle(&outgoing, batch);
                }
            }
            kept_beside
        })?;
        Ok(Self {
            full,
            empty,
            thread,
            beside,
        })
    }
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
        let hands = match Threads::start(plan.clone()) {
            Ok(threads) => Hands::Threads(threads),
            Err(_) => Hands::Caller {
                beside: Beside::new(&plan),
                worker: Box::new(Worker::new(plan)),
                empty: Vec::new(),
            },
        };
        Self {
            open: vec![Vec::with_capacity(BATCH); columns],
            hands,
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
        let next = match &mut self.hands {
            Hands::Threads(threads) => threads.empty.try_recv().ok(),
            Hands::Caller { empty, .. } => empty.pop(),
        };
        let next = next.unwrap_or_else(|| Vec::with_capacity(BATCH));
        let batch = replace(&mut self.open[column], next);
        self.hands.take(Work::Batch(column, batch));
    }

    /// Tells that so many samples are missing here, between two rows.
    #[cold]
    pub(super) fn gap(&mut self, missing: u64) {
        self.send_all();
        self.hands.take(Work::Gap {
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
        let (worker, beside) = self.hands.finish();
        let mut beside = beside.0.into_iter();
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

impl Hands {
    fn take(&mut self, work: Work) {
        match self {
            // This fails only if the thread has panicked. `finish` passes the panic on.
            Self::Threads(threads) => drop(threads.full.send(work)),
            Self::Caller {
                worker,
                beside,
                empty,
            } => {
                let watched = beside.0.len();
                worker.work(work, watched, |work| {
                    let batch = match work {
                        Done::Passed(work) => beside.take(work),
                        Done::Free(batch) => Some(batch),
                    };
                    empty.extend(batch.map(|mut batch| {
                        batch.clear();
                        batch
                    }));
                });
            }
        }
    }

    fn finish(self) -> (Worker, Beside) {
        match self {
            Self::Caller { worker, beside, .. } => (*worker, beside),
            Self::Threads(Threads {
                full,
                thread,
                beside,
                ..
            }) => {
                drop(full);
                let worker = thread.join();
                let worker = worker.unwrap_or_else(|panic| resume_unwind(panic));
                let beside = beside.join();
                (worker, beside.unwrap_or_else(|panic| resume_unwind(panic)))
            }
        }
    }
}

/// What becomes of a batch that was accumulated.
enum Done {
    /// It goes on to the spectra and courses, as gaps do.
    Passed(Work),
    /// It can be filled again.
    Free(Vec<i32>),
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

    /// Does what is asked. The first columns are watched axes, whose batches go on.
    fn work(&mut self, work: Work, watched: usize, mut done: impl FnMut(Done)) {
        match work {
            Work::Batch(column, batch) => self.take(column, batch, |column, batch| {
                done(match column < watched {
                    true => Done::Passed(Work::Batch(column, batch)),
                    false => Done::Free(batch),
                });
            }),
            Work::Gap { missing, .. } => {
                let filled = self.gap(missing);
                done(Done::Passed(Work::Gap { missing, filled }));
            }
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
