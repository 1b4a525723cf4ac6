//! Runs of repeats.

/// Runs of differences that are zero.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ZeroRuns {
    present: u32,
    pub(crate) longest: u32,
    /// The number of runs of at least 1, 2, 4, 8, 16 and 32 differences.
    pub(crate) reached: [u64; 6],
    /// All differences that are zero, and those in runs of at least [`LONG`].
    pub(crate) zeros: u64,
    pub(crate) long: u64,
}

/// The length of a run from which its differences are counted as those of a long one.
const LONG: u32 = 8;

impl ZeroRuns {
    pub(super) const NEW: Self = Self {
        present: 0,
        longest: 0,
        reached: [0; 6],
        zeros: 0,
        long: 0,
    };

    /// Adds a difference, or a gap, which ends a run as well.
    #[inline(always)]
    pub(super) fn push(&mut self, is_zero: bool) {
        if is_zero {
            self.repeat();
        } else {
            self.present = 0;
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.longest = self.longest.max(other.longest);
        for (own, other) in self.reached.iter_mut().zip(&other.reached) {
            *own = own.saturating_add(*other);
        }
        self.zeros = self.zeros.saturating_add(other.zeros);
        self.long = self.long.saturating_add(other.long);
    }

    /// Whether so many samples can have left these counts, and no run goes on.
    #[cfg(feature = "storage")]
    pub(crate) fn is_possible(&self, samples: u64) -> bool {
        let mut parts = self.reached.iter().chain([&self.zeros, &self.long]);
        self.present == 0
            && u64::from(self.longest) <= samples
            && parts.all(|part| *part <= samples)
    }

    fn repeat(&mut self) {
        self.present = self.present.saturating_add(1);
        self.longest = self.longest.max(self.present);
        self.zeros = self.zeros.saturating_add(1);
        if self.present.is_power_of_two()
            && let Some(reached) = self.reached.get_mut(self.present.trailing_zeros() as usize)
        {
            *reached = reached.saturating_add(1);
        }
        if self.present >= LONG {
            let new = if self.present == LONG { LONG } else { 1 };
            self.long = self.long.saturating_add(new.into());
        }
    }
}
