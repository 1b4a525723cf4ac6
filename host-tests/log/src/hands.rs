//! Hands counts to those who accumulate them: threads of their own, where there are threads, while the caller cuts and parses
//! text; one for what is kept of each axis, and one for spectra and courses. A page has no threads, and the caller does it all.

use super::{
    faults::Faults,
    sums::{OwnSums, Sums},
    watched::SharedSums,
    worker::{AxisState, Done, Plan, Work, Worker},
};
use crate::block_means::BlockSums;
use allanite::course::Course;
use std::{
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
        let Some(watch) = &plan.watch else {
            return Self(Vec::new());
        };
        let axes = 0..plan.axes;
        Self(
            axes.map(|_| OwnSums::new(watch.spectrogram, watch.first_sample))
                .collect(),
        )
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
                Sums::Watched(
                    axis,
                    beside.next().unwrap_or_else(|| OwnSums::new(false, None)),
                )
            }
        });
        Totals {
            axes: axes.collect(),
            columns: worker.columns,
            pairs: worker.pairs,
            blocks: worker.blocks,
            faults: worker.faults,
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
