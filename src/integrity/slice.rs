//! The bulk path of the watch: it takes many counts at once and leads to the same state.

use super::{
    limits::Limits,
    state::{CLUSTERS, State},
    watch::Rule,
};

/// The largest number of counts that are taken together: those of a short cluster.
pub(super) const MOST: usize = CLUSTERS[0] as usize;

/// Fewer counts than these are taken one by one, because what is done once for all of them costs as much.
const LEAST: usize = 8;

/// The limit of differences. The squares of as many of them as are taken together add up to less than 2^64.
const NEAR: u32 = 1 << 29;

/// The differences of neighbours among some counts.
pub(super) struct Differences {
    /// Their magnitudes.
    sizes: [u32; MOST],
    pub(super) number: usize,
    /// All bits that are set in any of the magnitudes.
    pub(super) bits: u32,
    /// The sum of their squares.
    pub(super) squares: u64,
    /// How many of them are zero.
    pub(super) repeats: u32,
    /// Whether two in a row are zero.
    pub(super) repeats_twice: bool,
}

impl Differences {
    /// The differences among at most [`MOST`] counts, of which the first one follows `before`.
    #[inline(always)]
    fn of(counts: &[i32], before: i32) -> Self {
        let mut sizes = [0; MOST];
        if let (Some(size), Some(&first)) = (sizes.first_mut(), counts.first()) {
            *size = first.abs_diff(before);
        }
        let later = sizes.iter_mut().skip(1);
        for (size, (&before, &count)) in later.zip(counts.iter().zip(counts.iter().skip(1))) {
            *size = count.abs_diff(before);
        }
        let known = sizes.get(..counts.len()).unwrap_or_default();
        let (mut bits, mut squares, mut repeats) = (0, 0_u64, 0_u32);
        for &size in known {
            bits |= size;
            squares = squares.wrapping_add(u64::from(size).wrapping_mul(size.into()));
            repeats = repeats.wrapping_add(u32::from(size == 0));
        }
        let pairs = known.iter().zip(known.iter().skip(1));
        let repeats_twice =
            repeats > 1 && pairs.fold(false, |any, (one, next)| any | (one | next == 0));
        Self {
            number: counts.len(),
            sizes,
            bits,
            squares,
            repeats,
            repeats_twice,
        }
    }

    /// The magnitudes.
    pub(super) fn sizes(&self) -> &[u32] {
        self.sizes.get(..self.number).unwrap_or_default()
    }

    /// Whether the first count repeats the one before it, and whether the last one does.
    pub(super) fn repeats_at_ends(&self) -> (bool, bool) {
        let is_zero = |size: Option<&u32>| size.is_some_and(|&size| size == 0);
        (is_zero(self.sizes().first()), is_zero(self.sizes().last()))
    }
}

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
