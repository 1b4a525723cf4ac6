//! How a diagnosis ends.

use crate::record::integrity::Reason;

/// How a diagnosis ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Verdict {
    /// The model that was asked about explains the curve.
    Adequate,
    /// The model explains the curve with the effects that were added.
    Improved,
    /// The effects that were added improve the model, but it still does not explain the curve, or the curve
    /// has too few octaves to judge it.
    Incomplete,
    /// The model does not explain the curve, and no effect in the list helps.
    Unexplained,
    /// The curve has too few octaves to judge the model that was asked about.
    TooShort,
    /// The curve is not valid, and no effect was looked for.
    Invalid(Reason),
}

impl Verdict {
    /// The names of all verdicts, as [`Verdict::name`] gives them.
    pub const NAMES: [&'static str; 6] = [
        "adequate",
        "improved",
        "incomplete",
        "unexplained",
        "too_short",
        "invalid",
    ];

    /// The verdict's name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Adequate => "adequate",
            Self::Improved => "improved",
            Self::Incomplete => "incomplete",
            Self::Unexplained => "unexplained",
            Self::TooShort => "too_short",
            Self::Invalid(_) => "invalid",
        }
    }
}
