//! Models and how they fail, for programs.

use super::{fit_json, words};
use crate::{log::OCTAVES, unit::Unit};
use allanite::{ComparedOctave, Comparison, Fit, Model, Term};
use serde::Serialize;
use serde_json::{Map, Value};

/// An effect of a model, with its shape and its amplitude.
#[derive(Serialize)]
pub(super) struct Effect {
    name: &'static str,
    parameters: Map<String, Value>,
}

/// The octave that disagrees most.
#[derive(Serialize)]
pub(super) struct Worst {
    tau_s: f64,
    z: f64,
    percent: f64,
}

/// A shape with its coefficient, by name; numbers that are not finite are `null`.
pub(super) fn parameters(term: &Term, coefficient: f64) -> Map<String, Value> {
    words::parameters(term, Some(coefficient))
        .into_iter()
        .map(|(name, value)| (name.to_owned(), Value::from(value)))
        .collect()
}

/// The effects of a model.
pub(super) fn effects(model: &Model, fit: &Fit) -> Vec<Effect> {
    let terms = model.terms().iter().zip(&fit.coefficients);
    terms
        .map(|(term, coefficient)| Effect {
            name: term.effect.name(),
            parameters: parameters(term, coefficient.value),
        })
        .collect()
}

/// The coefficients, as `fit --json` prints them.
pub(super) fn coefficients(fit: &Fit, unit: Unit) -> Vec<fit_json::Term> {
    let coefficients = fit.coefficients.iter();
    coefficients.map(|one| fit_json::term(one, unit)).collect()
}

/// The worst octave of a comparison.
pub(super) fn worst(comparison: &Comparison<OCTAVES>) -> Option<Worst> {
    let worst = |octave: &ComparedOctave| Worst {
        tau_s: octave.tau_s,
        z: octave.z,
        percent: octave.percent,
    };
    comparison.worst().map(worst)
}
