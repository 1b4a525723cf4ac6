//! Verdicts as they are stored. They are separate from the public verdicts, which may be reordered.

use crate::{diagnosis::Verdict, record::integrity::Reason};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
pub(super) enum WireVerdict {
    None,
    Adequate,
    Improved,
    Unexplained,
    Invalid(WireReason),
    TooShort,
    Incomplete,
}

#[derive(Serialize, Deserialize)]
pub(crate) enum WireReason {
    Stuck(u32, u64, u64),
    Railed(u64, u64),
    Spiked(u64, u8),
    Moved(u64, u16, u8),
    Missing(u64, u64),
    LeftOut(u64, u64),
    Repeated(u8, u64, u64),
    Coarse(u16),
    DeadBand(u64, u64),
    Misread(u8),
    Changed(u64, u16),
    Unanswered(u64, u64),
    Stale(u64, u16, u64),
}

impl From<Option<Verdict>> for WireVerdict {
    fn from(verdict: Option<Verdict>) -> Self {
        match verdict {
            None => Self::None,
            Some(Verdict::Adequate) => Self::Adequate,
            Some(Verdict::Improved) => Self::Improved,
            Some(Verdict::Unexplained) => Self::Unexplained,
            Some(Verdict::Invalid(reason)) => Self::Invalid(reason.into()),
            Some(Verdict::TooShort) => Self::TooShort,
            Some(Verdict::Incomplete) => Self::Incomplete,
        }
    }
}

impl From<WireVerdict> for Option<Verdict> {
    fn from(verdict: WireVerdict) -> Self {
        match verdict {
            WireVerdict::None => None,
            WireVerdict::Adequate => Some(Verdict::Adequate),
            WireVerdict::Improved => Some(Verdict::Improved),
            WireVerdict::Unexplained => Some(Verdict::Unexplained),
            WireVerdict::Invalid(reason) => Some(Verdict::Invalid(reason.into())),
            WireVerdict::TooShort => Some(Verdict::TooShort),
            WireVerdict::Incomplete => Some(Verdict::Incomplete),
        }
    }
}

impl From<Reason> for WireReason {
    fn from(reason: Reason) -> Self {
        match reason {
            Reason::Stuck {
                longest_run,
                changes,
                samples,
            } => Self::Stuck(longest_run, changes, samples),
            Reason::Railed { hits, samples } => Self::Railed(hits, samples),
            Reason::Spiked { spikes, percent } => Self::Spiked(spikes, percent),
            Reason::Moved {
                motions,
                cluster,
                percent,
            } => Self::Moved(motions, cluster, percent),
            Reason::Missing { missing, sent } => Self::Missing(missing, sent),
            Reason::LeftOut { left_out, samples } => Self::LeftOut(left_out, samples),
            Reason::Repeated {
                times,
                changes,
                samples,
            } => Self::Repeated(times, changes, samples),
            Reason::Coarse { per_mille } => Self::Coarse(per_mille),
            Reason::DeadBand { zeros, samples } => Self::DeadBand(zeros, samples),
            Reason::Misread { bits } => Self::Misread(bits),
            Reason::Changed { after, percent } => Self::Changed(after, percent),
            Reason::Unanswered { reads, samples } => Self::Unanswered(reads, samples),
            Reason::Stale {
                stale,
                distance,
                samples,
            } => Self::Stale(stale, distance, samples),
        }
    }
}

impl From<WireReason> for Reason {
    fn from(reason: WireReason) -> Self {
        match reason {
            WireReason::Stuck(longest_run, changes, samples) => Self::Stuck {
                longest_run,
                changes,
                samples,
            },
            WireReason::Railed(hits, samples) => Self::Railed { hits, samples },
            WireReason::Spiked(spikes, percent) => Self::Spiked { spikes, percent },
            WireReason::Moved(motions, cluster, percent) => Self::Moved {
                motions,
                cluster,
                percent,
            },
            WireReason::Missing(missing, sent) => Self::Missing { missing, sent },
            WireReason::LeftOut(left_out, samples) => Self::LeftOut { left_out, samples },
            WireReason::Repeated(times, changes, samples) => Self::Repeated {
                times,
                changes,
                samples,
            },
            WireReason::Coarse(per_mille) => Self::Coarse { per_mille },
            WireReason::DeadBand(zeros, samples) => Self::DeadBand { zeros, samples },
            WireReason::Misread(bits) => Self::Misread { bits },
            WireReason::Changed(after, percent) => Self::Changed { after, percent },
            WireReason::Unanswered(reads, samples) => Self::Unanswered { reads, samples },
            WireReason::Stale(stale, distance, samples) => Self::Stale {
                stale,
                distance,
                samples,
            },
        }
    }
}
