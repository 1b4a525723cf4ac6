//! The JSON document of a fit.

use super::{fitted::Fitted, judged::Judged};
use crate::{
    known_filter::{Shape, known_filter},
    rounding,
    tried::{self, TriedCovariate},
    units,
};
use allanite::{Coefficient, fit::State, integrity::Reason};
use allanite_log::unit::Unit;
use serde::{Serialize, Serializer};

/// The document of one file.
#[derive(Serialize)]
pub struct Document<'a> {
    /// The axes, in their order in the record.
    pub axes: Vec<Axis<'a>>,
}

/// An axis with its coefficients.
#[derive(Serialize)]
pub struct Axis<'a> {
    axis: &'a str,
    rate_hz: f64,
    unit: Unit,
    /// The mean rate, which no term of the noise stands for; `None` if it is not known.
    mean_rate: Option<f64>,
    octaves: Vec<Octave>,
    method: &'static str,
    /// The filter that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    filter: Option<Shape>,
    /// The coefficients, in the order of the model.
    pub coefficients: Vec<Term>,
    /// χ² of the fit; `None` if the method has none.
    pub chi2: Option<f64>,
    /// Its degrees of freedom.
    pub dof: Option<usize>,
    /// The deviance, which is larger for a model that lies far above the curve; `None` if the method has no χ².
    pub deviance: Option<f64>,
    /// The probability that χ² or the deviance is as large by chance.
    pub p_value: Option<f64>,
    /// Whether the five terms explain a valid curve; `null` if the record does not tell, or the method does not.
    pub adequate: Option<bool>,
    /// The verdict of the diagnosis.
    verdict: Option<&'static str>,
    /// The effects and the covariate that the five terms lack.
    missing: &'a [&'static str],
    /// The factor by which intervals and bounds are widened.
    birge_ratio: f64,
    /// Why the curve is not valid; `null` if it is.
    pub invalid: Option<&'a str>,
    /// The same in a word.
    reason: Option<&'static str>,
    /// The covariates that were tried.
    covariates: Vec<tried::Document>,
    /// What the limits that were asked for say.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    limits: &'a [Judged],
    notes: Vec<String>,
}

#[derive(Serialize)]
struct Octave {
    m: u32,
    tau_s: f64,
    differences: u64,
    variance: f64,
}

/// A coefficient in a unit that follows from the log's; infinite ends of an interval are `null`.
#[derive(Serialize)]
pub struct Term {
    effect: &'static str,
    /// The symbol: `N`.
    pub symbol: &'static str,
    /// The best estimate.
    pub value: f64,
    /// The lower end of the interval of 95 %.
    pub lower: f64,
    /// The upper end of the interval, or the upper bound.
    pub upper: f64,
    /// Whether it was measured.
    #[serde(serialize_with = "state")]
    pub state: State,
    unit: String,
}

/// The state as documents have it.
fn state<S: Serializer>(state: &State, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match state {
        State::Measured => "measured",
        State::UpperBound => "upper_bound",
        State::NotObservable { .. } => "not_observable",
    })
}

/// The document of the axes of one file.
pub fn document(fitted: &[Fitted]) -> Document<'_> {
    Document {
        axes: fitted.iter().map(axis).collect(),
    }
}

fn axis(fitted: &Fitted) -> Axis<'_> {
    let Fitted {
        axis,
        curve,
        model,
        method,
        fit,
        reason,
        invalid,
        tried,
        limits,
        judgement,
    } = fitted;
    let finite = |value: f64| value.is_finite().then_some(value);
    Axis {
        axis: &axis.axis,
        rate_hz: axis.rate_hz,
        unit: axis.unit,
        mean_rate: axis.mean_rate,
        octaves: curve
            .points()
            .iter()
            .map(|point| Octave {
                m: point.m,
                tau_s: point.tau_s,
                differences: point.differences,
                variance: point.variance,
            })
            .collect(),
        method: method.name(),
        filter: known_filter(model).map(Shape::of),
        coefficients: fit
            .coefficients
            .iter()
            .map(|one| term(one, axis.unit))
            .collect(),
        chi2: finite(fit.chi_squared),
        dof: finite(fit.chi_squared).map(|_| fit.degrees_of_freedom),
        deviance: finite(fit.deviance),
        p_value: finite(fit.p_value),
        adequate: fitted.is_adequate(),
        verdict: judgement.as_ref().map(|judgement| judgement.name),
        missing: judgement
            .as_ref()
            .map_or(&[], |judgement| &judgement.missing),
        birge_ratio: fit.birge_ratio,
        invalid: invalid.as_deref(),
        reason: reason.as_ref().map(Reason::name),
        covariates: tried.iter().map(TriedCovariate::document).collect(),
        limits,
        notes: invalid
            .iter()
            .cloned()
            .chain(rounding::note(axis, fit).filter(|_| invalid.is_none()))
            .chain(
                judgement
                    .iter()
                    .filter_map(|judgement| judgement.event.clone()),
            )
            .chain(fitted.covariate_notes())
            .collect(),
    }
}

/// One coefficient.
pub fn term(coefficient: &Coefficient, unit: Unit) -> Term {
    Term {
        effect: coefficient.name,
        symbol: coefficient.symbol,
        value: coefficient.value,
        lower: coefficient.lower,
        upper: coefficient.upper,
        state: coefficient.state,
        unit: units::unit(unit, coefficient.half_seconds),
    }
}
