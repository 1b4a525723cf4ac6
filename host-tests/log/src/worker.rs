//! Accumulates the counts of all columns of a log. A sum over all samples of an axis stays with one worker, because parts of a
//! record that are accumulated apart and merged lack the differences across the cuts.

use super::{
    CovariateChoice,
    covariate::{self, Derived},
    faults::{self, Faults},
    sums::{Part, filled},
    watched::{self, SharedSums, WatchedAxis},
};
use crate::block_means::BlockSums;
use allanite::course::Course;
use std::collections::VecDeque;

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
    /// Whether the spectrogram is kept, which only a page shows.
    pub(super) spectrogram: bool,
    /// The number of the first sample in the record, if the log is a part of a longer one.
    pub(super) first_sample: Option<u64>,
}

impl Plan {
    fn covariates(&self) -> &[CovariateChoice] {
        let watch = self.watch.as_ref();
        watch.map_or(&[], |watch| watch.covariates.as_slice())
    }

    /// The number of all columns.
    pub(super) fn columns(&self) -> usize {
        self.axes + self.covariates().len()
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
pub(super) enum Work {
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

/// What becomes of a batch that was accumulated.
pub(super) enum Done {
    /// It goes on to the spectra and courses, as gaps do.
    Passed(Work),
    /// It can be filled again.
    Free(Vec<i32>),
}

/// What the first thread keeps of one axis.
pub(super) enum AxisState {
    InTwo { first: Box<Part>, rest: Box<Part> },
    Watched(Box<dyn WatchedAxis>),
}

/// What is kept of all columns but the spectra and courses of watched axes.
pub(super) struct Worker {
    plan: Plan,
    pub(super) axes: Vec<AxisState>,
    pub(super) pairs: Vec<([usize; 2], SharedSums)>,
    derived: Vec<Derived>,
    pub(super) columns: Vec<Course>,
    pub(super) blocks: BlockSums,
    pub(super) faults: Faults,
    /// If the columns come row by row, a batch waits until the batches of the other columns with the same rows
    /// arrive.
    waiting: Vec<VecDeque<Vec<i32>>>,
}

impl Worker {
    pub(super) fn new(plan: Plan) -> Self {
        Self {
            axes: (0..plan.axes).map(|_| plan.kept()).collect(),
            pairs: covariate::pairs(plan.covariates())
                .map(|pair| (pair, SharedSums::new()))
                .collect(),
            derived: plan.covariates().iter().map(Derived::new).collect(),
            columns: plan.covariates().iter().map(|_| Course::new()).collect(),
            blocks: BlockSums::new(plan.columns()),
            faults: Faults::new(plan.faults.clone(), plan.axes),
            waiting: vec![VecDeque::new(); plan.columns()],
            plan,
        }
    }

    /// Does what is asked. The first columns are watched axes, whose batches go on.
    pub(super) fn work(&mut self, work: Work, watched: usize, mut done: impl FnMut(Done)) {
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
