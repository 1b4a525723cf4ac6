//! The filter that is known to be in a sensor's signal path, as an option of the command line.

use super::effect_argument::EffectArgument;
use allanite::{
    Model, Term,
    effect::{AngleRandomWalk, CATALOGUE, Effect},
};
use allanite_host::words::{article, parameters, plain, shape};
use allanite_log::failure::Failure;
use clap::Args;
use serde::Serialize;
use serde_json::{Map, Value};

/// The option for a filter that is known.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct KnownFilter {
    /// A filter on the white noise that is known from the sensor's data sheet or its settings, such as
    /// `low_pass:cutoff_hz=42,poles=2` or `decimation_filter:width_s=0.014,stages=2`, a CIC. It replaces angle random walk
    /// in the model from the start, and its shape is not fitted
    #[arg(long, value_name = "FILTER:parameter=value,…")]
    filter: Option<String>,
}

impl KnownFilter {
    /// Whether no filter is known.
    pub(crate) const fn is_none(&self) -> bool {
        self.filter.is_none()
    }

    /// The five terms, behind the filter if there is one.
    ///
    /// # Errors
    /// When the effect is unknown or no filter, or lacks a parameter.
    pub(crate) fn model(&self) -> Result<Model, Failure> {
        let mut model = Model::ieee_952();
        if let Some(text) = &self.filter {
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
}

/// Whether an effect takes the place of white noise.
pub(crate) fn is_filter(effect: &dyn Effect) -> bool {
    let replaced = effect.replaces().map(|replaced| replaced.name());
    replaced == Some(AngleRandomWalk.description().name)
}

/// The filter that a model knows from the start, if it has one.
pub(crate) fn known_filter(model: &Model) -> Option<&Term> {
    let is_known = |term: &&Term| !term.fitted && is_filter(term.effect);
    model.terms().iter().find(is_known)
}

/// The terms of a model in a sentence, without an article: `five terms`, or `five terms behind the given low pass`.
pub(crate) fn terms(model: &Model) -> String {
    let behind = |term: &Term| format!(" behind the given {}", plain(term.effect.name()));
    let behind = known_filter(model).map_or(String::new(), behind);
    format!("five terms{behind}")
}

/// A filter in a sentence: `a low pass (cutoff 42.00 Hz, time constant 0.003789 s, poles 2)`.
pub(crate) fn described(term: &Term) -> String {
    format!(
        "{}{} ({})",
        article(term.effect.name()),
        plain(term.effect.name()),
        shape(term, None)
    )
}

/// An effect and its shape, as JSON documents have it.
#[derive(Serialize)]
pub(crate) struct Shape {
    effect: &'static str,
    parameters: Map<String, Value>,
}

impl Shape {
    /// The shape of a term.
    pub(crate) fn of(term: &Term) -> Self {
        let named = parameters(term, None).into_iter();
        Self {
            effect: term.effect.name(),
            parameters: named
                .map(|(name, value)| (name.to_owned(), Value::from(value)))
                .collect(),
        }
    }
}
