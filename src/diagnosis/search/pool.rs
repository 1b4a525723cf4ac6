//! The hypotheses that are kept side by side.

use super::hypothesis::Hypothesis;
use crate::{list, real::Real};
use heapless::Vec;

/// Two hypotheses of the same kinds whose scores differ by less are the same.
const SAME: Real = 0.1;

/// Hypotheses, best first, of which only so many share a filter.
#[derive(Debug)]
pub(super) struct Pool<const N: usize> {
    list: Vec<Hypothesis, N>,
    /// How many of them may have the same kind of filter.
    per_filter: usize,
    /// What ranks them.
    by: fn(&Hypothesis) -> Real,
}

impl<const N: usize> Pool<N> {
    pub(super) const fn new(per_filter: usize, by: fn(&Hypothesis) -> Real) -> Self {
        Self {
            list: Vec::new(),
            per_filter,
            by,
        }
    }

    pub(super) fn as_slice(&self) -> &[Hypothesis] {
        &self.list
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// Keeps a hypothesis if it is among the best.
    pub(super) fn enter(&mut self, hypothesis: &Hypothesis) {
        let by = self.by;
        let rank = by(hypothesis);
        if !rank.is_finite() {
            return;
        }
        let is_same = |other: &&Hypothesis| {
            let distance = other.score - hypothesis.score;
            distance < SAME && distance > -SAME && other.is_like(hypothesis)
        };
        if self.list.iter().any(|other| is_same(&other)) {
            return;
        }
        let rivals = self.list.iter().filter(|other| other.has_filter_of(hypothesis));
        if list::count(rivals) >= self.per_filter {
            let last = self.list.iter().rposition(|other| other.has_filter_of(hypothesis));
            match last {
                Some(last) if self.list.get(last).is_some_and(|other| by(other) > rank) => {
                    list::remove(&mut self.list, last);
                }
                _ => return,
            }
        }
        list::rank(&mut self.list, hypothesis.clone(), |other| by(other) > rank);
    }
}
