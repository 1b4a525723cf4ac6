//! The filter that is known to be in a sensor's signal path.

use super::effect_argument::EffectArgument;
use crate::{
    schema::Numbers,
    words::{article, parameters, plain, shape},
};
use allanite::{
    Model, Term,
    effect::{AngleRandomWalk, CATALOGUE, Effect},
};
use allanite_log::failure::Failure;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// The five terms, behind the filter that this text of an option describes, if there is one.
///
/// # Errors
/// When the effect is unknown or no filter, or lacks a parameter.
pub fn model(filter: Option<&str>) -> Result<Model, Failure> {
    let mut model = Model::ieee_952();
    if let Some(text) = filter {
        let mut argument = EffectArgument::parse("--filter", text)?;
        let effect = argument.effect()?;
        if !is_filter(effect) {
            let filters = CATALOGUE.iter().filter(|effect| is_filter(**effect));
            let filters: Vec<&str> = filters.map(|effect| effect.name()).collect();
            let remedy = format!("choose from {}", filters.join(", "));
            return Err(argument.failure("is no filter on white noise", &remedy));
        }
        let known = Term::known(effect, argument.shape(effect)?);
        argument.finish()?;
        // A filter takes the place of a term, so that there is always room.
        let _ = model.put(known);
    }
    Ok(model)
}

/// Whether an effect takes the place of white noise.
pub fn is_filter(effect: &dyn Effect) -> bool {
    let replaced = effect.replaces().map(|replaced| replaced.name());
    replaced == Some(AngleRandomWalk.description().name)
}

/// The filter that a model knows from the start, if it has one.
pub fn known_filter(model: &Model) -> Option<&Term> {
    let is_known = |term: &&Term| !term.fitted && is_filter(term.effect);
    model.terms().iter().find(is_known)
}

/// The terms of a model in a sentence, without an article: `five terms`, or `five terms behind the given low pass`.
pub fn terms(model: &Model) -> String {
    let behind = |term: &Term| format!(" behind the given {}", plain(term.effect.name()));
    let behind = known_filter(model).map_or(String::new(), behind);
    format!("five terms{behind}")
}

/// A filter in a sentence: `a low pass (cutoff 42.00 Hz, time constant 0.003789 s, poles 2)`.
pub fn described(term: &Term) -> String {
    format!(
        "{}{} ({})",
        article(term.effect.name()),
        plain(term.effect.name()),
        shape(term, None)
    )
}

/// An effect and its shape, as JSON documents have it.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "shape")]
pub struct Shape {
    effect: &'static str,
    #[schemars(with = "Numbers")]
    parameters: Map<String, Value>,
}

impl Shape {
    /// The shape of a term.
    pub fn of(term: &Term) -> Self {
        let named = parameters(term, None).into_iter();
        Self {
            effect: term.effect.name(),
            parameters: named
                .map(|(name, value)| (name.to_owned(), Value::from(value)))
                .collect(),
        }
    }
}
