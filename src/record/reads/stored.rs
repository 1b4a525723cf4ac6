//! What survives of the reads of a record in a snapshot.

use super::{
    EqualAxes, LEARNT, Reads,
    stale::{Runs, Stale},
};
use crate::record::faults::JointRepeats;
use serde::{Deserialize, Serialize};

/// The counts without what lies in the present stretch.
#[derive(Serialize, Deserialize)]
struct Stored {
    repeats: JointRepeats,
    equal: EqualAxes,
    runs: Runs,
}

impl<const AXES: usize> Reads<AXES> {
    /// The largest number of bytes of what is stored.
    pub(crate) const LONGEST_STORED: usize = 400;

    /// What is stored: the state after a gap.
    pub(crate) fn stored(&self) -> impl Serialize + use<AXES> {
        let mut repeats = self.repeats.clone();
        repeats.push([None; 3]);
        Stored {
            repeats,
            equal: self.equal,
            runs: self.stale.runs_at_gap(),
        }
    }

    /// Reads what was [stored](Self::stored), and returns the bytes behind it. `None` if no record leads to such a state.
    pub(crate) fn restore<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (stored, rest) = postcard::take_from_bytes::<Stored>(bytes).ok()?;
        if !stored.is_possible(AXES) {
            return None;
        }
        let stale = Stale::with_runs(stored.runs);
        *self = Self {
            repeats: stored.repeats,
            equal: stored.equal,
            stale,
            ..Self::new()
        };
        Some(rest)
    }
}

impl Stored {
    fn is_possible(&self, axes: usize) -> bool {
        let Self {
            repeats,
            equal,
            runs,
        } = self;
        // Counters of 32 bits stop at their largest number.
        let samples = match runs.samples {
            u32::MAX => u64::MAX,
            samples => samples.into(),
        };
        let pairs = repeats
            .cells
            .iter()
            .fold(0, |sum: u64, cell| sum.saturating_add(*cell));
        let of_three = axes == 3 || (pairs == 0 && *equal == EqualAxes::NEW);
        let none = equal.at.iter().all(|cells| {
            let sum = cells
                .iter()
                .fold(0, |sum: u64, cell| sum.saturating_add((*cell).into()));
            sum <= samples
        });
        let third = repeats.third.iter().all(|third| *third <= pairs);
        let counts = pairs <= samples && repeats.returned <= samples.saturating_mul(3);
        let all = [equal.far, runs.elsewhere].map(u64::from);
        of_three
            && none
            && third
            && counts
            && all.iter().all(|part| *part <= samples)
            && equal.learnt <= LEARNT
            && equal.usual <= u64::from(LEARNT) << 32
            && repeats.runs.is_possible(samples)
            && runs.is_possible()
    }
}
