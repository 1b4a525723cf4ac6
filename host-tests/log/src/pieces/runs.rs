//! Runs of equal samples.

use super::sizes::order;
use serde::{Deserialize, Serialize};

/// The runs of equal counts of neighbouring samples. A run that touches an end of a piece may go on beyond it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Runs {
    /// The number of samples.
    samples: u64,
    /// The number of samples in the first run and in the last one, which may be the same.
    ends: [u64; 2],
    /// The runs between them.
    closed: Closed,
}

/// Runs that touch no end.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Closed {
    /// The number of runs of just 2, 3 and 4 samples.
    exact: [u64; 3],
    /// The number of samples of the longest one.
    longest: u64,
    /// The number of samples in runs, by the binary order of their lengths from 2 on. The last one is not zero.
    samples: Vec<u64>,
}

/// The number of pairs of neighbours that are skipped together.
const TOGETHER: usize = 32;

impl Closed {
    fn add(&mut self, run: u64) {
        self.longest = self.longest.max(run);
        if run < 2 {
            return;
        }
        if let Some(number) = self.exact.get_mut(run as usize - 2) {
            *number = number.saturating_add(1);
        }
        let order = order(run) - 2;
        if order >= self.samples.len() {
            self.samples.resize(order + 1, 0);
        }
        self.samples[order] = self.samples[order].saturating_add(run);
    }

    fn join(&mut self, other: &Self) {
        self.longest = self.longest.max(other.longest);
        for (own, other) in self.exact.iter_mut().zip(other.exact) {
            *own = own.saturating_add(other);
        }
        if other.samples.len() > self.samples.len() {
            self.samples.resize(other.samples.len(), 0);
        }
        for (own, other) in self.samples.iter_mut().zip(&other.samples) {
            *own = own.saturating_add(*other);
        }
    }

    /// The number of samples of the longest run.
    pub(super) fn longest(&self) -> u64 {
        self.longest
    }

    /// The length of 2 to 4 samples that at least half of so many runs have.
    pub(super) fn times(&self, runs: u64) -> Option<u8> {
        let mut exact = (2..).zip(self.exact);
        let found = exact.find(|(_, number)| number.saturating_mul(2) >= runs);
        found.map(|(times, _)| times)
    }

    /// The number of samples in runs of at least so many samples, which is counted in powers of two.
    pub(super) fn samples_from(&self, run: u64) -> u64 {
        let first = order(run.next_power_of_two().max(2)) - 2;
        self.samples.get(first..).unwrap_or_default().iter().sum()
    }
}

impl Runs {
    /// The runs of counts, of which there is one at least. `repeats` of them equal the one before.
    pub(super) fn of(counts: &[i32], repeats: u64) -> Self {
        let samples = counts.len() as u64;
        let mut runs = Self {
            samples,
            ends: [1; 2],
            closed: Closed::default(),
        };
        // Without those at the ends, there is one of a single sample at least.
        runs.closed.longest = u64::from(samples - repeats > 2);
        // The number of pairs of equal neighbours that end where the next pair begins.
        let mut present = 0;
        let mut place = 0;
        let later = counts.get(1..).unwrap_or_default();
        for (one, next) in counts.chunks(TOGETHER).zip(later.chunks(TOGETHER)) {
            let pairs = || one.iter().zip(next);
            // Of most counts, few are equal, and those that are not are skipped together.
            if present == 0 && pairs().fold(true, |none, (one, next)| none & (one != next)) {
                place += next.len() as u64;
                continue;
            }
            for (one, next) in pairs() {
                if one == next {
                    present += 1;
                } else if present > 0 {
                    runs.end(place - present, present + 1);
                    present = 0;
                }
                place += 1;
            }
        }
        if present > 0 {
            runs.end(place - present, present + 1);
        }
        runs
    }

    /// Takes a run of several samples that begins at this place.
    fn end(&mut self, start: u64, run: u64) {
        let is_at = [start == 0, start + run == self.samples];
        for (end, is_there) in self.ends.iter_mut().zip(is_at) {
            if is_there {
                *end = run;
            }
        }
        if is_at == [false; 2] {
            self.closed.add(run);
        }
    }

    /// Joins the runs behind these. The last count of these and the first of the others may be equal.
    pub(super) fn join(&mut self, next: &Self, are_equal: bool) {
        let is_one = |runs: &Self| runs.ends[0] == runs.samples;
        let (left, right) = (is_one(self), is_one(next));
        self.closed.join(&next.closed);
        let [first, last] = self.ends;
        let [next_first, next_last] = next.ends;
        if are_equal {
            let middle = last + next_first;
            if !left && !right {
                self.closed.add(middle);
            }
            self.ends = [
                if left { middle } else { first },
                if right { middle } else { next_last },
            ];
        } else {
            if !left {
                self.closed.add(last);
            }
            if !right {
                self.closed.add(next_first);
            }
            self.ends = [first, next_last];
        }
        self.samples += next.samples;
    }

    /// All runs, with those that touch the ends.
    pub(super) fn all(&self) -> Closed {
        let mut all = self.closed.clone();
        all.add(self.ends[0]);
        if self.ends[0] < self.samples {
            all.add(self.ends[1]);
        }
        all
    }

    /// Adds all runs to others.
    pub(super) fn add_to(&self, all: &mut Closed) {
        all.join(&self.all());
    }

    /// Whether so many samples, of which so many repeat the one before, can have these runs.
    pub(super) fn is_possible(&self, samples: u64, repeats: u64) -> bool {
        let all = self.all();
        let in_runs = all
            .samples
            .iter()
            .try_fold(0_u64, |sum, &of| sum.checked_add(of));
        self.samples == samples
            && self.ends.iter().all(|&end| (1..=samples).contains(&end))
            && all.longest <= samples
            && all.exact.iter().all(|&number| number <= samples)
            && all.samples.last().is_none_or(|&of| of > 0)
            && self.closed.samples.last().is_none_or(|&of| of > 0)
            && in_runs.is_some_and(|sum| sum <= samples && sum >= repeats)
    }
}
