//! The words that say what a verdict is. They stand here alone, so that text, documents, pages and pictures use the same.

use crate::number::probability;
use allanite::{diagnosis::Verdict, fit::Fit};

/// What a model is that explains the record within its errors.
pub const ADEQUATE: &str = "adequate";

/// What a model is that does not.
pub const INADEQUATE: &str = "not adequate";

/// A model that explains the record, in a sentence.
pub const ADEQUATE_MODEL: &str = "an adequate model";

/// The probability from which on a model is, as a setting.
pub const ADEQUATE_FROM: &str = "model is adequate from";

/// The verdict of a record in which something happened, as it is written in files.
pub const NOT_STATIONARY: &str = "not_stationary";

/// What the verdict of such a record begins with, in words.
pub const NOT_STATIONARY_IN_WORDS: &str = "not stationary";

/// What events during a record mean for its coefficients.
pub const MIXTURE: &str = "the record is not stationary: its coefficients are those of a mixture, so leave out the disturbed part or record again";

/// What a misfit means.
pub const ANOTHER_EFFECT: &str = "the record has another effect";

/// That other effects would do as well as the one that was chosen.
pub fn ambiguous(others: &str) -> String {
    format!("ambiguous, {others} would explain the record about as well")
}

/// The verdict of a fit in a word or two: whether its model explains the record; `None` if the record does not tell.
pub const fn word(adequate: Option<bool>) -> &'static str {
    match adequate {
        Some(true) => ADEQUATE,
        Some(false) => INADEQUATE,
        None => "too few octaves to judge",
    }
}

/// The same in a sentence about the five terms.
pub const fn explained(adequate: Option<bool>) -> &'static str {
    match adequate {
        Some(true) => "the five terms explain the record",
        Some(false) => "the five terms do not explain the record",
        None => "the record does not tell whether the five terms explain it",
    }
}

/// The verdict of a fit with its p-value, on a screen.
pub fn with_p(fit: &Fit) -> String {
    let adequate = fit.is_adequate();
    match adequate {
        Some(_) => format!("{}, p {}", word(adequate), probability(fit.p_value)),
        None => word(None).into(),
    }
}

/// The verdict of a fit in a comment of an export.
pub fn in_comment(fit: &Fit) -> String {
    let (adequate, p) = (fit.is_adequate(), probability(fit.p_value));
    match adequate {
        Some(true) => format!("{ADEQUATE} (p {p})"),
        Some(false) => {
            format!("{INADEQUATE} (p {p}): {ANOTHER_EFFECT}, and the overbound is the safer choice")
        }
        None => too_few("model"),
    }
}

/// The verdict on a record below the table of a fit, of the five terms and what is before them. `missing` names the effects that they
/// lack; it is empty if none was found.
pub fn of_five_terms(behind: &str, adequate: Option<bool>, missing: &str) -> String {
    match adequate {
        Some(true) => format!("The five-term model{behind} is {ADEQUATE} for this record."),
        Some(false) if missing.is_empty() => format!(
            "The five-term model{behind} is {}: the record has another effect, which \
             distorts the coefficients. `compare` shows where, and `diagnose` looks for it.",
            word(adequate)
        ),
        Some(false) => format!(
            "The five-term model{behind} is {}: it lacks {missing}, which distorts the \
             coefficients. `diagnose` fits them together.",
            word(adequate)
        ),
        None => format!(
            "There are too few octaves to judge the five-term model{behind}: record longer."
        ),
    }
}

/// The verdict on a record in which this happened, below the table of a fit.
pub fn of_a_mixture(event: &str) -> String {
    format!(
        "The record is {NOT_STATIONARY_IN_WORDS}: {event}. Its coefficients stand for a mixture; `diagnose` shows when it happened."
    )
}

/// That a record is too short, in a sentence.
pub fn too_few(model: &str) -> String {
    format!("there are too few octaves to judge the {model}")
}

/// A limit that is not decided, because no model explains the record.
pub const UNDECIDED: &str = "not decided, because no model explains the record: see `diagnose`";

/// A limit that is not decided, because something happened during the record.
pub const UNDECIDED_IN_MIXTURE: &str =
    "not decided, because the record is not stationary: see `diagnose`";

/// What is said of a curve that is not one of a gyro at rest.
pub const INVALID_CURVE: &str = "the curve is not valid";

/// A limit that is not decided, because the curve is not valid.
pub const UNDECIDED_INVALID: &str = "not decided, because the curve is not valid";

/// The verdicts of a diagnosis on these terms of a model with this p-value, in a sentence each.
pub mod sentence {
    use super::{ADEQUATE, INADEQUATE, INVALID_CURVE};

    /// The terms explain the curve of a record in which something happened.
    pub fn mixture(terms: &str, p: &str) -> String {
        format!("its curve looks like that of the {terms} (p {p}), which stand for a mixture.")
    }

    /// The terms explain the record.
    pub fn adequate(terms: &str, p: &str) -> String {
        format!("the {terms} are {ADEQUATE} (p {p}): no effect is missing.")
    }

    /// The terms do not explain the record, for this reason.
    pub fn inadequate(terms: &str, p: &str, why: &str) -> String {
        format!("the {terms} are {INADEQUATE} (p {p}), {why}.")
    }

    /// What was found explains the record.
    pub fn improved(found: &str, p: &str) -> String {
        format!("{found}; the model is {ADEQUATE} now (p {p}).")
    }

    /// What was found explains a part of it.
    pub fn incomplete(found: &str, p: &str) -> String {
        format!("{found}; a difference remains that no effect explains (p {p}).")
    }

    /// The record is too short.
    pub fn too_short(terms: &str) -> String {
        format!("{}: record longer.", super::too_few(terms))
    }

    /// The curve is not valid.
    pub fn invalid(reason: &str) -> String {
        format!("no effect was looked for, because {INVALID_CURVE}: {reason}.")
    }

    /// The same of a curve that is shown.
    pub fn invalid_curve(reason: &str) -> String {
        format!("{INVALID_CURVE}: {reason}; no effect was looked for.")
    }

    /// Something happened during the record, and this is said of its curve.
    pub fn not_stationary(event: &str, of_curve: &str) -> String {
        format!("the record is not stationary: {event}; {of_curve}")
    }
}

/// The verdict of a diagnosis on these terms of a model as the conclusion has it, if the record is valid.
pub fn concluded(verdict: Verdict, terms: &str, is_disturbed: bool) -> String {
    match verdict {
        // What happened is no part of the noise that the terms stand for.
        Verdict::Adequate if is_disturbed => {
            format!("its curve looks like that of the {terms}, which stand for a mixture")
        }
        Verdict::Adequate => format!("the {terms} explain the record, no effect is missing"),
        Verdict::TooShort => format!("too short to judge the {terms}"),
        Verdict::Improved => format!("the {terms} and what follows explain the record"),
        Verdict::Unexplained => {
            format!("the {terms} do not explain the record, and nothing in the catalogue does")
        }
        _ => format!("the {terms} and what follows explain a part of the record"),
    }
}

/// The verdict of a diagnosis in a few words, with the effects that it found.
pub fn brief(verdict: Verdict, found: &str) -> String {
    match verdict {
        Verdict::Invalid(reason) => format!("not valid: {reason}"),
        Verdict::Adequate => "no effect is missing".into(),
        Verdict::TooShort => "too short to judge".into(),
        Verdict::Unexplained => "no known effect explains the difference".into(),
        Verdict::Improved => format!("missing: {found}"),
        _ => format!("missing: {found}, and more"),
    }
}

/// The verdict of a diagnosis on the badge of a page.
pub const fn on_badge(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Adequate => "five terms suffice",
        Verdict::Improved => "effects found",
        Verdict::Incomplete => "effects found, part unexplained",
        Verdict::Unexplained => "unexplained",
        Verdict::TooShort => "too short to judge",
        Verdict::Invalid(_) => "record invalid",
        _ => "unknown",
    }
}

/// The name of a verdict in files, where `is_disturbed` says whether something happened during the record: that of a valid record is
/// then `not_stationary`, whether its curve is explained or not.
pub const fn name(verdict: Verdict, is_disturbed: bool) -> &'static str {
    match verdict {
        Verdict::Invalid(_) => verdict.name(),
        _ if is_disturbed => NOT_STATIONARY,
        _ => verdict.name(),
    }
}

/// The verdict that a certificate has, with the effects that were found, which are none if the text is empty.
pub fn certified(verdict: Option<Verdict>, is_disturbed: bool, found: &str) -> String {
    match verdict {
        Some(Verdict::Invalid(reason)) => format!("invalid, {reason}"),
        Some(_) if is_disturbed => NOT_STATIONARY_IN_WORDS.into(),
        None => "not diagnosed".into(),
        Some(Verdict::Adequate) => ADEQUATE.into(),
        Some(verdict @ (Verdict::Improved | Verdict::Incomplete)) if found.is_empty() => {
            verdict.name().into()
        }
        Some(Verdict::Improved) => format!("with {found}"),
        Some(Verdict::Incomplete) => format!("with {found}, part unexplained"),
        Some(Verdict::Unexplained) => "unexplained".into(),
        Some(Verdict::TooShort) => "too short to judge".into(),
        Some(verdict) => verdict.name().into(),
    }
}
