//! The parts that the JSON documents of `compare` and `diagnose` share.

use crate::{
    dependence::candidates::{Candidate, Form},
    fit,
    schema::Numbers,
    units, words,
};
use allanite::{
    Comparison, Model, Term,
    comparison::ComparedOctave,
    covariate::{self, Slope},
    detection::Range,
    fit::Fit,
};
use allanite_log::{BINS, OCTAVES, unit::Unit};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// An effect of a model, with its shape and its coefficient.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "effect")]
pub struct Effect {
    name: &'static str,
    #[schemars(with = "Numbers")]
    parameters: Map<String, Value>,
    /// The column of a covariate; other effects have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    channel: Option<String>,
}

/// A covariate that the rate depends on: its slope, and its lag if it has one, each with its 95 % interval.
pub fn covariate(slope: &Slope, series: &Candidate) -> Effect {
    let (lower, upper) = slope.interval();
    let numbers = [
        ("slope", slope.value),
        ("slope_lower", lower),
        ("slope_upper", upper),
    ];
    let (lag, channel) = match &series.form {
        Form::Behind(lag) => {
            let lag = vec![
                ("lag_s", lag.lag_s),
                ("lag_lower_s", lag.lower_s),
                ("lag_upper_s", lag.upper_s),
            ];
            (lag, &series.column)
        }
        _ => (Vec::new(), &series.name),
    };
    let numbers = numbers.into_iter().chain(lag);
    Effect {
        name: covariate::NAME,
        parameters: numbers.map(|(name, x)| (name.into(), x.into())).collect(),
        channel: Some(channel.clone()),
    }
}

/// The octave with the largest disagreement.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "worst")]
pub struct Worst {
    /// The averaging time in seconds.
    tau_s: f64,
    /// Standard errors from the model.
    z: f64,
    /// The difference from the model, in percent.
    percent: f64,
}

/// The size of an effect that a record would have shown, over a range of shapes.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "detection_range")]
pub struct DetectionRange {
    effect: &'static str,
    /// The name of the number that is limited: the coefficient or, for a filter, a shape parameter.
    limited: &'static str,
    /// The size that the record would have shown with a probability of 95 %.
    limit: f64,
    /// The unit of the limit; empty for a pure number.
    unit: String,
    /// The ends of the range of the first shape parameter, by its name.
    #[serde(flatten)]
    #[schemars(with = "BTreeMap<String, [Option<f64>; 2]>")]
    ends: Map<String, Value>,
}

/// The limit of detection of a range of shapes.
pub fn detection_range(range: &Range, unit: Unit) -> DetectionRange {
    let effect = range.effect;
    let parameter = effect.parameters().first();
    let limited = parameter.filter(|_| range.is_of_shape);
    let (low, high) = range.ends;
    let ends = parameter.filter(|_| !range.is_of_shape);
    let ends = ends.map(|parameter| (parameter.name.to_owned(), Value::from(vec![low, high])));
    DetectionRange {
        effect: effect.name(),
        limited: limited.map_or(effect.coefficient(), |parameter| parameter.name),
        limit: range.size,
        unit: match limited {
            Some(parameter) => parameter.unit.to_owned(),
            None => units::unit(unit, effect.half_seconds()),
        },
        ends: ends.into_iter().collect(),
    }
}

/// The shape and the coefficient of a term by name; numbers that are not finite are `null`.
pub fn parameters(term: &Term, coefficient: f64) -> Map<String, Value> {
    words::parameters(term, Some(coefficient))
        .into_iter()
        .map(|(name, value)| (name.to_owned(), Value::from(value)))
        .collect()
}

/// The effects of a model.
pub fn effects(model: &Model, fit: &Fit) -> Vec<Effect> {
    let terms = model.terms().iter().zip(&fit.coefficients);
    terms
        .map(|(term, coefficient)| Effect {
            name: term.effect.name(),
            parameters: parameters(term, coefficient.value),
            channel: None,
        })
        .collect()
}

/// The coefficients, as `fit --json` prints them.
pub fn coefficients(fit: &Fit, unit: Unit) -> Vec<fit::json::Term> {
    let coefficients = fit.coefficients.iter();
    coefficients.map(|one| fit::json::term(one, unit)).collect()
}

/// The worst octave of a comparison.
pub fn worst(comparison: &Comparison<OCTAVES, BINS>) -> Option<Worst> {
    let worst = |octave: &ComparedOctave| Worst {
        tau_s: octave.tau_s,
        z: octave.z,
        percent: octave.percent(),
    };
    comparison.worst().map(worst)
}
