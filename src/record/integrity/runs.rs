//! Runs of equal values.

use super::differences::Differences;

/// The number of ended runs from which the mean run is known well enough to judge a run by it. The mean
/// of 16 runs of independent noise has a standard error of a quarter. The number is chosen by hand.
const KNOWN: u32 = 16;

/// The largest number of samples that the mean run covers: half the range of 32 bits.
const HALF: u32 = 1 << 31;

/// Runs of equal values.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Runs {
    /// The number of samples in the present run; 0 after a gap.
    pub(super) present: u32,
    pub(super) value: i32,
    pub(super) longest: u32,
    /// The number of samples in runs that have ended, and the number of these runs. Both are halved before
    /// they overflow.
    ended_samples: u32,
    ended: u32,
    pub(super) stuck: u64,
    pub(super) stuck_samples: u64,
    /// The number of runs that reached 2, 3, 4 and 5 samples.
    reached: [u32; REACHED],
}

/// The number of lengths of runs that are counted.
const REACHED: usize = 4;

/// The number of runs from which their lengths are judged. Of 256 runs of independent noise, of which at most a
/// quarter have two samples, half have two with a probability below 1e-16.
const JUDGED: u64 = 256;

impl Runs {
    pub(super) const NEW: Self = Self {
        present: 0,
        value: 0,
        longest: 0,
        ended_samples: 0,
        ended: 0,
        stuck: 0,
        stuck_samples: 0,
        reached: [0; REACHED],
    };

    /// Begins a new run, because the count differs from the one before it, and no gap lies between them.
    #[inline(always)]
    pub(super) fn change(&mut self, count: i32) {
        self.end();
        self.value = count;
        self.present = 1;
    }

    /// Adds a count and returns whether the present run is implausibly long.
    #[inline(always)]
    pub(super) fn push(&mut self, count: i32, factor: u16) -> bool {
        if self.present == 0 || self.value != count {
            self.change(count);
            self.longest = self.longest.max(1);
            return false;
        }
        self.present = self.present.saturating_add(1);
        self.longest = self.longest.max(self.present);
        let reached = (self.present as usize).wrapping_sub(2);
        if let Some(reached) = self.reached.get_mut(reached) {
            *reached = reached.saturating_add(1);
        }
        let stuck = self.is_implausible(self.present, self.ended_samples, factor);
        if stuck {
            // When the run becomes implausible, all its samples so far count.
            let before =
                self.is_implausible(self.present.saturating_sub(1), self.ended_samples, factor);
            let new = if before { 1 } else { self.present };
            self.stuck = self.stuck.saturating_add(u64::from(!before));
            self.stuck_samples = self.stuck_samples.saturating_add(new.into());
        }
        stuck
    }

    /// Whether [`push_slice`](Self::push_slice) can add counts with these differences.
    #[inline(always)]
    pub(super) fn takes(&self, differences: &Differences) -> bool {
        let (repeats_at_once, _) = differences.repeats_at_ends();
        let longest = if repeats_at_once { 1 } else { HALF / 4 };
        let long = (1..=longest).contains(&self.present) && !differences.repeats_twice;
        // More than all samples that can join ended runs here.
        let room = HALF / 2;
        long && self.ended_samples < room
    }

    /// Adds counts with these differences, the last of which is `last`. No run among them has more than two samples,
    /// which is never implausible, because the factor is at least 8.
    #[inline(always)]
    pub(super) fn push_slice(&mut self, differences: &Differences, last: i32) {
        let number = differences.number as u32;
        let (_, repeats_last) = differences.repeats_at_ends();
        let present = if repeats_last { 2 } else { 1 };
        let samples = self.present.wrapping_add(number).wrapping_sub(present);
        self.add_ended(samples, number.wrapping_sub(differences.repeats));
        if let Some(reached) = self.reached.first_mut()
            && differences.repeats > 0
        {
            *reached = reached.saturating_add(differences.repeats);
            self.longest = self.longest.max(2);
        }
        self.value = last;
        self.present = present;
    }

    /// Ends the present run, because a different value has followed.
    #[inline(always)]
    fn end(&mut self) {
        if self.present > 0 {
            self.add_ended(self.present, 1);
        }
    }

    #[inline(always)]
    fn add_ended(&mut self, samples: u32, runs: u32) {
        let sum = self.ended_samples.wrapping_add(samples);
        if samples < HALF && sum < HALF {
            self.ended_samples = sum;
            self.ended = self.ended.wrapping_add(runs);
        } else {
            self.fade(samples, runs);
        }
    }

    #[cold]
    #[inline(never)]
    fn fade(&mut self, samples: u32, runs: u32) {
        // The mean stays the same, while the weight of samples older than 2^31 fades.
        let sum = u64::from(self.ended_samples) + u64::from(samples);
        let fade = sum.checked_ilog2().unwrap_or(0).saturating_sub(30);
        self.ended_samples = (sum >> fade) as u32;
        self.ended = ((u64::from(self.ended) + u64::from(runs)) >> fade) as u32;
    }

    /// Whether a run is longer than `factor` times the mean one.
    #[inline(always)]
    fn is_implausible(&self, run: u32, ended_samples: u32, factor: u16) -> bool {
        self.ended >= KNOWN
            && u64::from(run) * u64::from(self.ended) > u64::from(ended_samples) * u64::from(factor)
    }

    pub(super) fn is_longest_implausible(&self, factor: u16) -> bool {
        // The mean of the other runs: the longest run is excluded if it has ended.
        let others = if self.longest == self.present {
            self.ended_samples
        } else {
            self.ended_samples.saturating_sub(self.longest)
        };
        self.is_implausible(self.longest, others, factor)
    }

    /// How often every sample is there, if that is two to four times: at least half of all `runs` have just
    /// this length. Runs of independent noise have a geometric distribution, so that at most a quarter
    /// have two samples, 15 % three and 11 % four. Where every sample is read twice, half of the runs
    /// have two samples if neighbours differ in half of the cases, which holds for a noise of half a count or
    /// more.
    pub(super) fn times(&self, runs: u64) -> Option<u8> {
        if runs < JUDGED {
            return None;
        }
        let longer = self.reached.iter().skip(1);
        let mut exact = (2_u8..).zip(self.reached.iter().zip(longer));
        let found = exact.find(|(_, (reached, longer))| {
            u64::from(reached.saturating_sub(**longer)).saturating_mul(2) >= runs
        });
        found.map(|(times, _)| times)
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.longest = self.longest.max(other.longest);
        self.add_ended(other.ended_samples, other.ended);
        self.stuck = self.stuck.saturating_add(other.stuck);
        self.stuck_samples = self.stuck_samples.saturating_add(other.stuck_samples);
        for (reached, other) in self.reached.iter_mut().zip(other.reached) {
            *reached = reached.saturating_add(other);
        }
    }
}
