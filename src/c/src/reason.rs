//! Why a record is invalid.

use allanite::integrity::Reason;

/// Why a record is not that of a gyro at rest.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllaniteReason {
    /// The record is valid.
    Valid = 0,
    /// The values change too seldom.
    Stuck = 1,
    /// Every sample is there several times.
    Repeated = 2,
    /// The noise is below half a count.
    Coarse = 3,
    /// Too many values are at a rail of the converter.
    Railed = 4,
    /// Spikes contribute too much.
    Spiked = 5,
    /// The gyro was moved.
    Moved = 6,
    /// Too many samples were lost.
    Missing = 7,
    /// The gate left out too many samples.
    LeftOut = 8,
    /// Any other reason, of a later version.
    Other = 9,
    /// Small values are set to zero.
    DeadBand = 10,
    /// The counts were read without their sign, or with their bytes in the wrong order.
    Misread = 11,
    /// The noise changed, as by another range of the sensor.
    Changed = 12,
    /// Samples have one number on all axes, as a bus on which no sensor answers gives them.
    Unanswered = 13,
    /// Blocks of samples are there a second time, as a buffer that was not refilled leaves them.
    Stale = 14,
}

impl AllaniteReason {
    pub(crate) fn of(reason: Option<Reason>) -> Self {
        match reason {
            None => Self::Valid,
            Some(Reason::Stuck { .. }) => Self::Stuck,
            Some(Reason::Repeated { .. }) => Self::Repeated,
            Some(Reason::Coarse { .. }) => Self::Coarse,
            Some(Reason::Railed { .. }) => Self::Railed,
            Some(Reason::Spiked { .. }) => Self::Spiked,
            Some(Reason::Moved { .. }) => Self::Moved,
            Some(Reason::Missing { .. }) => Self::Missing,
            Some(Reason::LeftOut { .. }) => Self::LeftOut,
            Some(Reason::DeadBand { .. }) => Self::DeadBand,
            Some(Reason::Misread { .. }) => Self::Misread,
            Some(Reason::Changed { .. }) => Self::Changed,
            Some(Reason::Unanswered { .. }) => Self::Unanswered,
            Some(Reason::Stale { .. }) => Self::Stale,
            Some(_) => Self::Other,
        }
    }
}
