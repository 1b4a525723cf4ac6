//! The hypotheses that are kept side by side.

use super::hypothesis::Hypothesis;
use crate::{list, numerics::real::Real};
use heapless::Vec;

/// Two hypotheses of the same kinds whose scores differ by less are the same.
const SAME: Real = 0.1;

/// How many of a pool may have the same kind of filter, and how many may add the same kinds of effects.
const SAME_FILTER: usize = 3;
const SAME_ADDITIONS: usize = 2;

/// Whether two hypotheses are similar.
type Alike = fn(&Hypothesis, &Hypothesis) -> bool;

/// The best hypotheses, best first. Few of them share a filter or what they add, so that different stories stay.
#[derive(Debug)]
pub(super) struct Pool<const N: usize> {
    list: Vec<Hypothesis, N>,
}

impl<const N: usize> Pool<N> {
    pub(super) const NEW: Self = Self { list: Vec::new() };

    pub(super) fn as_slice(&self) -> &[Hypothesis] {
        &self.list
    }

    /// The score that a hypothesis has to beat.
    pub(super) fn bar(&self) -> Real {
        match self.list.last() {
            Some(worst) if self.list.is_full() => worst.score,
            _ => Real::INFINITY,
        }
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// Keeps a hypothesis if it is among the best.
    pub(super) fn enter(&mut self, hypothesis: &Hypothesis) {
        let score = hypothesis.score;
        if !score.is_finite() {
            return;
        }
        let is_same = |other: &Hypothesis| {
            let distance = other.score - score;
            distance < SAME && distance > -SAME && other.is_like(hypothesis)
        };
        if self.list.iter().any(is_same) {
            return;
        }
        let has_filter =
            |one: &Hypothesis, other: &Hypothesis| one.filter.is_some() && one.has_filter_of(other);
        let groups: [(usize, Alike); 2] = [
            (SAME_ADDITIONS, Hypothesis::adds_like),
            (SAME_FILTER, has_filter),
        ];
        for (most, alike) in groups {
            let mut rivals = self.list.iter().filter(|other| alike(other, hypothesis));
            if list::count(rivals.clone()) < most {
                continue;
            }
            if rivals.all(|other| other.score <= score) {
                return;
            }
            let worst = self.list.iter().rposition(|other| alike(other, hypothesis));
            list::remove(&mut self.list, worst.unwrap_or(N));
        }
        list::rank(&mut self.list, hypothesis.clone(), |other| {
            other.score > score
        });
    }
}
