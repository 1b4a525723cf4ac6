//! The bulk path of the watch: it takes many counts at once and leads to the same state.

use super::{
    differences::{Differences, MOST},
    limits::Limits,
    state::{CLUSTERS, State},
    watch::Rule,
};

// The counts of a short cluster are taken together.
const _: () = assert!(CLUSTERS[0] as usize <= MOST);

/// Fewer counts than these are taken one by one, because what is done once for all of them costs as much.
const LEAST: usize = 8;

/// The limit of differences. The squares of as many of them as are taken together add up to less than 2^64.
const NEAR: u32 = 1 << 29;

impl State {
    /// Adds counts. The state afterwards is the same as if they were pushed one by one.
    pub(super) fn push_slice(&mut self, counts: &[i32], limits: &Limits) {
        let mut rest = counts;
        while !rest.is_empty() {
            let (taken, after) = rest.split_at(self.room().min(rest.len()));
            if taken.len() < LEAST || !self.push_usual_slice(taken, limits) {
                for &count in taken {
                    if !self.push_usual(count, limits) {
                        self.push(count, limits);
                    }
                }
            }
            rest = after;
        }
    }

    /// The number of counts up to the end of the short cluster, but 1 before a long one is judged.
    fn room(&self) -> usize {
        let [short, long] = &self.clusters;
        let [short_length, long_length] = CLUSTERS;
        if long.filled >= long_length {
            return 1;
        }
        usize::from(short_length.saturating_sub(short.filled)).max(1)
    }

    /// Adds counts that need no closer look, except that some may repeat the one before. Returns whether they were
    /// added. If the result is `false`, nothing has changed.
    #[inline]
    fn push_usual_slice(&mut self, counts: &[i32], limits: &Limits) -> bool {
        let Some(&last) = counts.last() else {
            return true;
        };
        let rails = &self.rails;
        let between = counts
            .iter()
            .fold(true, |all, &count| all & rails.is_between(count));
        if !between || !self.neighbours.is_steady_at(self.runs.value) {
            return false;
        }
        let differences = Differences::of(counts, self.runs.value);
        let rule = Rule::neighbours(limits.spike_factor);
        if differences.bits >= NEAR
            || !self.runs.takes(&differences)
            || !self.neighbours.push_usual_slice(&differences, last, &rule)
        {
            return false;
        }
        self.runs.push_slice(&differences, last);
        if differences.repeats > 0 {
            let mut values = counts.iter().zip(differences.sizes()).rev();
            if let Some((&value, _)) = values.find(|(_, size)| **size == 0) {
                self.neighbours.repeat(value);
            }
        }
        let number = counts.len() as u64;
        let repeats = u64::from(differences.repeats);
        self.repeats = self.repeats.saturating_add(repeats);
        self.changes = self.changes.saturating_add(number.saturating_sub(repeats));
        let [short, _] = &mut self.clusters;
        let [short_length, _] = CLUSTERS;
        let sum = counts.iter().map(|&count| i64::from(count));
        short.sum = short.sum.wrapping_add(sum.fold(0, i64::wrapping_add));
        short.filled = short.filled.wrapping_add(counts.len() as u16);
        if short.filled == short_length {
            self.end_short_cluster(limits.motion_factor);
        }
        true
    }
}
