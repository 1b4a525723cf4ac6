//! Accumulates counts on a thread of its own, while the caller cuts and parses text.

use super::{
    CovariateChoice, OCTAVES, SpectrumSums,
    covariate::{self, Derived},
    watched::{self, SharedSums, WatchedAxis},
};
use allanite::{Accumulator, course::Course};
use std::{
    collections::VecDeque,
    mem::replace,
    panic::resume_unwind,
    sync::mpsc::{Receiver, SyncSender, channel, sync_channel},
    thread::{self, JoinHandle},
};

/// The number of counts of a column that are collected before they are accumulated as a slice.
const BATCH: usize = 1 << 13;

/// What is kept of one axis.
pub(super) enum Sums {
    /// The sums of the first rows, and those of the remaining rows.
    InTwo { first: Box<Part>, rest: Box<Part> },
    /// The axis with everything that is kept beside its curve.
    Watched(Box<dyn WatchedAxis>, Box<Beside>),
}

/// The curve and the spectrum of some rows.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) accumulator: Accumulator<OCTAVES>,
    pub(super) spectrum: SpectrumSums,
}

/// What is kept beside an axis of the library.
#[derive(Clone)]
pub(super) struct Beside {
    pub(super) spectrum: SpectrumSums,
    pub(super) course: Course,
}

impl Part {
    fn new() -> Box<Self> {
        Box::new(Self {
            accumulator: Accumulator::new(),
            spectrum: SpectrumSums::new(),
        })
    }

    fn push(&mut self, counts: &[i32]) {
        self.accumulator.push_slice(counts);
        self.spectrum.push_slice(counts);
    }

    fn gap(&mut self) {
        self.accumulator.gap();
        self.spectrum.gap();
    }
}

impl Sums {
    /// The accumulator of the rows that were asked for.
    pub(super) fn accumulator(&self) -> &Accumulator<OCTAVES> {
        match self {
            Self::InTwo { first, .. } => &first.accumulator,
            Self::Watched(axis, _) => axis.accumulator(),
        }
    }

    /// The spectrum of the rows that were asked for.
    pub(super) fn spectrum(&self) -> &SpectrumSums {
        match self {
            Self::InTwo { first, .. } => &first.spectrum,
            Self::Watched(_, beside) => &beside.spectrum,
        }
    }
}

/// How to use the columns: the first ones are axes, and the covariates follow them.
#[derive(Clone)]
pub(super) struct Plan {
    pub(super) axes: usize,
    /// The number of first rows. Later samples are accumulated separately if only the curve is
    /// kept.
    pub(super) first: u64,
    /// The covariates, if the evidence beside the curve is kept.
    pub(super) watch: Option<Vec<CovariateChoice>>,
}

impl Plan {
    fn covariates(&self) -> &[CovariateChoice] {
        self.watch.as_deref().unwrap_or_default()
    }

    fn columns(&self) -> usize {
        self.axes + self.covariates().len()
    }

    fn sums(&self) -> Sums {
        match &self.watch {
            Some(covariates) => {
                let beside = Box::new(Beside {
                    spectrum: SpectrumSums::new(),
                    course: Course::new(),
                });
                Sums::Watched(watched::axis(covariates.len()), beside)
            }
            None => Sums::InTwo {
                first: Part::new(),
                rest: Part::new(),
            },
        }
    }
}

/// A message to the thread.
enum Work {
    /// The counts of a column.
    Batch(usize, Vec<i32>),
    /// Samples are missing after the batches that were sent so far. All of them end at the same
    /// row.
    Gap,
}

/// Sends the counts of every column to the thread with the accumulators. Accumulating takes about
/// as long as cutting and parsing text, so each has its own thread.
pub(super) struct Batches {
    /// The batch of each column that is being filled.
    open: Vec<Vec<i32>>,
    full: SyncSender<Work>,
    /// Batches that have been accumulated and can be filled again.
    empty: Receiver<Vec<i32>>,
    thread: JoinHandle<Totals>,
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
}

impl Batches {
    pub(super) fn new(plan: Plan) -> Self {
        let columns = plan.columns();
        let (full, incoming) = sync_channel(2 * columns);
        let (outgoing, empty) = channel();
        let thread = thread::spawn(move || {
            let mut worker = Worker::new(plan);
            for work in incoming {
                match work {
                    Work::Batch(column, batch) => worker.take(column, batch, |mut batch| {
                        batch.clear();
                        // The receiver is gone once the last batches are on their way.
                        let _ = outgoing.send(batch);
                    }),
                    Work::Gap => worker.gap(),
                }
            }
            Totals {
                axes: worker.sums,
                columns: worker.columns,
                pairs: worker.pairs,
            }
        });
        Self {
            open: vec![Vec::with_capacity(BATCH); columns],
            full,
            empty,
            thread,
        }
    }

    #[inline]
    pub(super) fn push(&mut self, column: usize, count: i32) {
        let batch = &mut self.open[column];
        batch.push(count);
        if batch.len() >= BATCH {
            self.send(column);
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

    /// Tells that samples are missing here, between two rows.
    #[cold]
    pub(super) fn gap(&mut self) {
        self.send_all();
        let _ = self.full.send(Work::Gap);
    }

    fn send_all(&mut self) {
        for column in 0..self.open.len() {
            self.send(column);
        }
    }

    pub(super) fn finish(mut self) -> Totals {
        self.send_all();
        drop(self.full);
        self.thread
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))
    }
}

struct Worker {
    plan: Plan,
    sums: Vec<Sums>,
    pairs: Vec<([usize; 2], SharedSums)>,
    derived: Vec<Derived>,
    columns: Vec<Course>,
    /// With covariates, a batch waits until the batches of the other columns with the same rows
    /// arrive.
    waiting: Vec<VecDeque<Vec<i32>>>,
}

impl Worker {
    fn new(plan: Plan) -> Self {
        Self {
            sums: (0..plan.axes).map(|_| plan.sums()).collect(),
            pairs: covariate::pairs(plan.covariates())
                .map(|pair| (pair, SharedSums::new()))
                .collect(),
            derived: plan.covariates().iter().map(Derived::new).collect(),
            columns: plan.covariates().iter().map(|_| Course::new()).collect(),
            waiting: vec![VecDeque::new(); plan.columns()],
            plan,
        }
    }

    fn take(&mut self, column: usize, batch: Vec<i32>, mut done: impl FnMut(Vec<i32>)) {
        if self.derived.is_empty() {
            self.accumulate(column, &batch, &[]);
            return done(batch);
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
        let (axes, covariates) = rows.split_at_mut(self.plan.axes);
        for (course, counts) in self.columns.iter_mut().zip(covariates.iter()) {
            counts.iter().for_each(|&count| course.push(count, []));
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
        rows.into_iter().for_each(done);
    }

    fn gap(&mut self) {
        for derived in &mut self.derived {
            derived.gap();
        }
        for course in &mut self.columns {
            course.gap();
        }
        for (_, shared) in &mut self.pairs {
            shared.gap();
        }
        for sums in &mut self.sums {
            match sums {
                Sums::InTwo { first, rest } => {
                    if first.accumulator.samples() >= self.plan.first {
                        rest.gap();
                    } else {
                        first.gap();
                    }
                }
                Sums::Watched(axis, beside) => {
                    axis.gap();
                    beside.spectrum.gap();
                    beside.course.gap();
                }
            }
        }
    }

    fn accumulate(&mut self, axis: usize, counts: &[i32], covariates: &[Vec<i32>]) {
        match &mut self.sums[axis] {
            Sums::InTwo { first, rest } => {
                let room = self.plan.first - first.accumulator.samples();
                let room = usize::try_from(room).unwrap_or(usize::MAX);
                let (of_start, of_rest) = counts.split_at(room.min(counts.len()));
                first.push(of_start);
                rest.push(of_rest);
            }
            Sums::Watched(axis, beside) => {
                axis.push(counts, covariates);
                beside.spectrum.push_slice(counts);
                for &count in counts {
                    beside.course.push(count, []);
                }
            }
        }
    }
}
