//! What survives of the reads of a record in a snapshot.

use super::{
    Earlier, EqualAxes, LEARNT, Reads,
    stale::{Stale, StaleRuns},
};
use crate::record::faults::JointRepeats;
use serde::{Deserialize, Serialize};

/// The counts without what lies in the present stretch.
#[derive(Serialize, Deserialize)]
struct Stored {
    earlier: Earlier,
    repeats: JointRepeats,
    equal: EqualAxes,
    runs: StaleRuns,
}

impl<const AXES: usize> Reads<AXES> {
    /// The largest number of bytes of what is stored.
    pub(crate) const LONGEST_STORED: usize = 400;

    /// What is stored: the state after a gap.
    pub(crate) fn stored(&self) -> impl Serialize + use<AXES> {
        let mut repeats = self.repeats.clone();
        repeats.end_run();
        Stored {
            earlier: Earlier {
                samples: self.samples(),
                pairs: self.pairs(),
            },
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
            earlier: stored.earlier,
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
            earlier,
            repeats,
            equal,
            runs,
        } = self;
        // Counters of 32 bits stop at their largest number.
        let samples = match earlier.samples {
            u32::MAX => u64::MAX,
            samples => samples.into(),
        };
        let sum = |cells: &[u32]| {
            cells
                .iter()
                .fold(0, |sum: u64, cell| sum.saturating_add((*cell).into()))
        };
        let pairs = repeats
            .cells
            .iter()
            .fold(0, |sum: u64, cell| sum.saturating_add(*cell));
        let of_three = axes == 3 || (*repeats == JointRepeats::NEW && *equal == EqualAxes::NEW);
        let [none_repeats, ..] = repeats.cells;
        let counts = none_repeats == 0 && pairs <= samples && earlier.pairs <= earlier.samples;
        let [repeated, returned] = repeats.returned.map(|axes| u64::from(axes) / 3);
        let parts = [
            sum(&equal.all),
            equal.far.into(),
            runs.looked.into(),
            repeated,
            returned,
        ];
        let third = repeats.third.iter().all(|third| *third <= pairs);
        of_three
            && counts
            && third
            && parts.iter().all(|part| *part <= samples)
            && equal.at.iter().all(|cells| sum(cells) <= samples)
            && equal.learnt <= LEARNT
            && equal.usual <= u64::from(LEARNT) << 32
            && repeats.runs.is_possible(samples)
            && runs.is_possible()
    }
}
