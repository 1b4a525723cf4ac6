//! What is odd about one sample.

/// What is odd about a sample, for a caller that wants to leave it out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Observation {
    /// It prolongs a run of equal values that is implausibly long.
    pub stuck: bool,
    /// It lies at a rail.
    pub railed: bool,
    /// It lies far from the last ordinary sample: a spike, or the beginning of a step.
    pub outlying: bool,
    /// The last full cluster lay far from the last ordinary one: known up to 64 samples late, by
    /// the longer clusters up to 1024.
    pub moving: bool,
}

impl Observation {
    pub(super) const USUAL: Self = Self {
        stuck: false,
        railed: false,
        outlying: false,
        moving: false,
    };

    /// Whether anything is odd.
    pub const fn is_odd(self) -> bool {
        self.stuck || self.railed || self.outlying || self.moving
    }

    /// What is odd about either of two samples.
    #[inline(always)]
    pub(crate) const fn or(self, other: Self) -> Self {
        Self {
            stuck: self.stuck | other.stuck,
            railed: self.railed | other.railed,
            outlying: self.outlying | other.outlying,
            moving: self.moving | other.moving,
        }
    }
}
