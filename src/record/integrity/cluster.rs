//! The means of clusters of samples, which show motion.

use super::watch::{Fate, Rule, Watch, square};

/// The clusters of one length.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Cluster {
    pub(super) sum: i64,
    /// The number of samples in the sum.
    pub(super) filled: u16,
    pub(super) watch: Watch,
    /// Σ D² of the clusters whose mean was outside its usual level.
    pub(super) squares: u128,
    pub(super) motions: u64,
}

impl Cluster {
    pub(super) const NEW: Self = Self {
        sum: 0,
        filled: 0,
        watch: Watch::NEW,
        squares: 0,
        motions: 0,
    };

    /// Adds a count.
    #[inline(always)]
    pub(super) fn add(&mut self, count: i32) {
        self.sum = self.sum.wrapping_add(count.into());
        self.filled = self.filled.wrapping_add(1);
    }

    /// Judges a full cluster and begins the next one.
    #[inline(never)]
    pub(super) fn judge(&mut self, rule: &Rule) {
        let (fate, difference) = self.watch.push(self.sum, rule);
        self.sum = 0;
        self.filled = 0;
        let (squares, motions) = match fate {
            Fate::Start | Fate::Learning | Fate::Ordinary => (0, 0),
            Fate::Learnt { outlier } => (outlier, u64::from(outlier > 0)),
            Fate::Out { first } => (square(difference), u64::from(first)),
            Fate::Back | Fate::Accepted => (square(difference), 0),
        };
        self.squares = self.squares.saturating_add(squares);
        self.motions = self.motions.saturating_add(motions);
    }
}
