//! A coefficient beside its limit, for a station that measures once and decides.

use crate::{
    confidence::TWO_SIDED_95,
    curve_file::AxisCurve,
    judgement::Judgement,
    limit::{LimitArgument, Limited},
    number::number,
    units,
    verdict::{UNDECIDED, UNDECIDED_IN_MIXTURE, UNDECIDED_INVALID},
    words,
};
use allanite::{fit::Fit, self_test::BIAS};
use allanite_log::failure::Failure;
use schemars::JsonSchema;
use serde::Serialize;
use std::sync::atomic::{AtomicU8, Ordering};

/// What a limit says of an axis. The rule is that of `allanite::ieee_952::Limits`, which decides on a device: what is known to
/// keep a limit passes, and what is known to exceed one fails (ISO 14253-1).
#[derive(Clone, Copy, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "conformity")]
enum Conformity {
    /// The 95 % interval keeps the limit.
    Pass,
    /// The interval contains the limit, or the coefficient is not observable in this record.
    GuardBand,
    /// No model explains the record, so that no interval says anything about a limit.
    Misfit,
    /// Something happened during the record, and its coefficients are those of a mixture.
    NotStationary,
    /// The curve is not valid.
    Invalid,
    /// The interval lies above the limit.
    Fail,
}

impl Conformity {
    const fn words(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::GuardBand => "guard band: a longer record may decide",
            Self::Misfit => UNDECIDED,
            Self::NotStationary => UNDECIDED_IN_MIXTURE,
            Self::Invalid => UNDECIDED_INVALID,
            Self::Fail => "fail",
        }
    }
}

/// A limit of an axis, and what it says.
#[derive(Clone, Serialize, JsonSchema)]
#[schemars(rename = "limit")]
pub struct Judged {
    /// The name of an effect, or `bias` for the mean rate.
    effect: &'static str,
    symbol: &'static str,
    /// The limit, in `unit`.
    most: f64,
    unit: String,
    verdict: Conformity,
    /// The effects in whose presence the coefficient was compared, which the five terms lack.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    beside: Vec<&'static str>,
}

impl Judged {
    /// What all limits say of an axis: of the coefficients of the model that explains the record, which are those of the five terms
    /// if these explain it, and of the mean rate.
    ///
    /// # Errors
    /// When a limit is of an effect that is not fitted, or in a unit that its coefficient does not have, or of a mean rate that is
    /// not known.
    pub fn all(
        fit: &Fit,
        judgement: &Judgement,
        is_valid: bool,
        axis: &AxisCurve,
        limits: &[LimitArgument],
    ) -> Result<Vec<Self>, Failure> {
        let unit = axis.unit;
        let judged = limits.iter().map(|limit| {
            if let Limited::Bias = limit.limited() {
                return Self::of_bias(judgement, is_valid, axis, limit);
            }
            let mut coefficients = fit.coefficients.iter();
            let found = coefficients.find(|found| found.name == limit.name());
            let found = found.ok_or_else(|| limit.of_another_model())?;
            let most = limit.value_in(unit)?;
            let verdict = match judgement.coefficient(found.name) {
                _ if !is_valid => Conformity::Invalid,
                _ if judgement.event.is_some() => Conformity::NotStationary,
                None => Conformity::Misfit,
                Some(explained) if explained.lower > most => Conformity::Fail,
                Some(explained) if explained.upper <= most => Conformity::Pass,
                Some(_) => Conformity::GuardBand,
            };
            let is_decided = !matches!(
                verdict,
                Conformity::Invalid | Conformity::NotStationary | Conformity::Misfit
            );
            Ok(Self {
                effect: found.name,
                symbol: found.symbol,
                most,
                unit: units::unit(unit, found.half_seconds),
                verdict,
                beside: match is_decided {
                    true => judgement.missing.clone(),
                    false => Vec::new(),
                },
            })
        });
        judged.collect()
    }

    /// What a limit says of the mean rate. It is what it is, whatever effect the curve lacks, so that a misfit does not keep it
    /// from being decided.
    fn of_bias(
        judgement: &Judgement,
        is_valid: bool,
        axis: &AxisCurve,
        limit: &LimitArgument,
    ) -> Result<Self, Failure> {
        let most = limit.value_in(axis.unit)?;
        let unknown = || {
            Failure::option(
                format!(
                    "--limit {BIAS}: the mean rate of {} is not known",
                    axis.axis
                ),
                "give the log, or measure it again",
            )
        };
        let mean = axis.mean_rate.ok_or_else(unknown)?.abs();
        let half_width = TWO_SIDED_95 * judgement.error_of_mean(axis).ok_or_else(unknown)?;
        Ok(Self {
            effect: BIAS,
            symbol: BIAS,
            most,
            unit: units::unit(axis.unit, 0),
            verdict: match () {
                () if !is_valid => Conformity::Invalid,
                () if judgement.event.is_some() => Conformity::NotStationary,
                () if mean - half_width > most => Conformity::Fail,
                () if mean + half_width <= most => Conformity::Pass,
                () => Conformity::GuardBand,
            },
            beside: Vec::new(),
        })
    }

    /// The limit and the verdict in one line.
    pub fn words(&self) -> String {
        let (symbol, most, unit) = (self.symbol, number(self.most), &self.unit);
        let verdict = self.verdict.words();
        let line = format!("limit {symbol} ≤ {most} {unit}: {verdict}");
        if self.beside.is_empty() {
            return line;
        }
        let names = self.beside.iter().map(|name| words::in_sentence(name));
        format!(
            "{line} (in the model with {})",
            words::list_of(names.collect())
        )
    }
}

/// The worst verdict of all axes of all files, for the exit status.
#[derive(Default)]
pub struct Worst(AtomicU8);

impl Worst {
    /// Keeps the worst of these, if it is worse than what is kept.
    pub fn note(&self, judged: &[Judged]) {
        for one in judged {
            self.0.fetch_max(one.verdict as u8, Ordering::Relaxed);
        }
    }

    /// # Errors
    /// [`Failure::Limit`] if an axis does not pass.
    pub fn end(&self) -> Result<(), Failure> {
        let worst = self.0.load(Ordering::Relaxed);
        if worst == Conformity::Pass as u8 {
            return Ok(());
        }
        Err(Failure::Limit {
            is_exceeded: worst == Conformity::Fail as u8,
        })
    }
}
