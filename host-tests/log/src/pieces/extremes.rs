//! The extreme samples.

use serde::{Deserialize, Serialize};

/// The lowest count and the highest one, with the number of samples that have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Extremes {
    lowest: (i32, u64),
    highest: (i32, u64),
}

impl Extremes {
    /// Those of counts, of which there is one at least.
    pub(super) fn of(counts: &[i32]) -> Self {
        let ends = counts
            .iter()
            .fold([i32::MAX, i32::MIN], |[least, most], &count| {
                [least.min(count), most.max(count)]
            });
        let [lowest, highest] = ends.map(|end| {
            let number: u64 = counts.iter().map(|&count| u64::from(count == end)).sum();
            (end, number)
        });
        Self { lowest, highest }
    }

    /// The distance of the farther one from a count.
    pub(super) fn distance(&self, count: i64) -> u64 {
        let [lowest, highest] =
            [self.lowest, self.highest].map(|(end, _)| i64::from(end).abs_diff(count));
        lowest.max(highest)
    }

    /// Adds those of other samples.
    pub(super) fn join(&mut self, other: &Self) {
        let joined = |own: (i32, u64), other: (i32, u64), outer: i32| match own.0 == other.0 {
            true => (own.0, own.1 + other.1),
            false if outer == own.0 => own,
            false => other,
        };
        let (lowest, highest) = (self.lowest, self.highest);
        self.lowest = joined(lowest, other.lowest, lowest.0.min(other.lowest.0));
        self.highest = joined(highest, other.highest, highest.0.max(other.highest.0));
    }

    /// The lowest count and the highest one.
    pub(super) fn ends(&self) -> [i64; 2] {
        [self.lowest.0.into(), self.highest.0.into()]
    }

    /// The number of samples at an end that is among these counts.
    pub(super) fn hits(&self, rails: &[i32]) -> u64 {
        let both = match self.lowest.0 == self.highest.0 {
            true => &[self.lowest][..],
            false => &[self.lowest, self.highest],
        };
        let hits = both.iter().filter(|(end, _)| rails.contains(end));
        hits.map(|(_, number)| number).sum()
    }

    /// Whether so many samples can have these extremes.
    pub(super) fn is_possible(&self, samples: u64) -> bool {
        let [lowest, highest] = [self.lowest, self.highest];
        let are_some = [lowest, highest]
            .iter()
            .all(|(_, number)| (1..=samples).contains(number));
        are_some
            && match lowest.0.cmp(&highest.0) {
                std::cmp::Ordering::Less => lowest
                    .1
                    .checked_add(highest.1)
                    .is_some_and(|both| both <= samples),
                std::cmp::Ordering::Equal => lowest.1 == samples && highest.1 == samples,
                std::cmp::Ordering::Greater => false,
            }
    }
}
