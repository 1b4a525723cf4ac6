//! The JSON document of a fit.

use super::{
    fitted::{Fitted, MethodName},
    judged::Judged,
};
use crate::{
    known_filter::{Shape, known_filter},
    rounding, schema,
    tried::{self, TriedCovariate},
    units,
};
use allanite::{Coefficient, fit::State, integrity::Reason};
use allanite_log::unit::Unit;
use schemars::JsonSchema;
use serde::{Serialize, Serializer};

/// The fits of one file.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axes")]
pub struct Document<'a> {
    /// The axes, in their order in the record.
    pub axes: Vec<Axis<'a>>,
}

/// The fit of an axis.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "axis")]
pub struct Axis<'a> {
    /// The name of the axis.
    axis: &'a str,
    /// Samples per second.
    rate_hz: f64,
    /// The unit of the rate.
    #[schemars(with = "schema::UnitName")]
    unit: Unit,
    /// The mean rate, which no term of the noise stands for; `null` if it is not known.
    mean_rate: Option<f64>,
    /// The Allan curve.
    octaves: Vec<Octave>,
    /// How the octaves are weighted.
    #[schemars(with = "MethodName")]
    method: &'static str,
    /// The filter that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    filter: Option<Shape>,
    /// The coefficients, in the order of the model.
    pub coefficients: Vec<Term>,
    /// χ² of the fit; `null` for a method without error model.
    pub chi2: Option<f64>,
    /// Its degrees of freedom.
    pub dof: Option<usize>,
    /// Squared deviance residuals in units of their correlation: about χ² for a true model, larger for one that lies far above the
    /// curve; `null` if the method has no χ².
    pub deviance: Option<f64>,
    /// The probability of a larger χ² if the model is true, or ten times that of a larger deviance if this is smaller.
    pub p_value: Option<f64>,
    /// Whether the five terms explain a valid record and the diagnosis finds nothing else in it; `null` if this is not known.
    pub adequate: Option<bool>,
    /// The verdict of the diagnosis, as `diagnose` has it; `null` if none was made.
    #[schemars(with = "Option<schema::VerdictName>")]
    verdict: Option<&'static str>,
    /// The effects and the covariate that the five terms lack.
    missing: &'a [&'static str],
    /// The factor by which intervals and bounds are widened.
    #[schemars(with = "Option<f64>")]
    birge_ratio: f64,
    /// Why the curve is not valid; `null` if it is.
    pub invalid: Option<&'a str>,
    /// The same in a word.
    #[schemars(with = "Option<schema::ReasonName>")]
    reason: Option<&'static str>,
    /// The covariates that were tried.
    covariates: Vec<tried::Document>,
    /// The limits that were asked for.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    limits: &'a [Judged],
    /// Notes, a sentence each.
    notes: Vec<String>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "octave")]
struct Octave {
    /// The averaging factor.
    m: u32,
    /// The averaging time in seconds.
    tau_s: f64,
    /// The number of differences of adjacent clusters.
    differences: u64,
    /// The Allan variance in rate units squared.
    variance: f64,
}

/// A coefficient in a unit that follows from the log's.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "coefficient")]
pub struct Term {
    /// The name of the effect.
    effect: &'static str,
    /// Its symbol, such as `N`.
    pub symbol: &'static str,
    /// The best estimate.
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// The lower end of the 95 % interval; zero unless the coefficient is measured.
    #[schemars(with = "Option<f64>")]
    pub lower: f64,
    /// The upper end of the 95 % interval, or the one-sided 95 % bound; `null` if nothing bounds it.
    #[schemars(with = "Option<f64>")]
    pub upper: f64,
    /// Whether the interval excludes zero.
    #[serde(serialize_with = "state")]
    #[schemars(with = "schema::StateName")]
    pub state: State,
    /// The unit of the three numbers.
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
