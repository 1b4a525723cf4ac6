//! The model of `compare`: the five terms, with the effects that options add or leave out.

use crate::{
    command::{effect_argument::EffectArgument, known_filter::KnownFilter},
    failure::{Failure, quoted},
};
use allanite::{Model, Term, model::MAX_EFFECTS};
use clap::Args;

/// Effects to add and terms to leave out.
#[derive(Debug, Args)]
pub(super) struct ModelArguments {
    /// Add an effect with its shape, such as `sinusoid:frequency_hz=0.3` or
    /// `decimation_filter:width_s=0.014,stages=2`; its coefficient is fitted. If the effect
    /// replaces a term, that term is removed
    #[arg(long, value_name = "EFFECT[:parameter=value,…]")]
    with: Vec<String>,
    /// Leave out a term, such as `rate_ramp`
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    #[command(flatten)]
    filter: KnownFilter,
}

impl ModelArguments {
    /// Builds the model.
    ///
    /// # Errors
    /// When an effect is unknown, lacks a parameter, is in the model twice or not in it, or when the
    /// model gets too large or empty.
    pub(super) fn model(&self) -> Result<Model, Failure> {
        let mut model = self.filter.model()?;
        for name in &self.without {
            if model.position(name).is_none() {
                let names = model.terms().iter().map(|term| term.effect.name());
                return Err(Failure::option(
                    format!(
                        "--without {}: the effect is not in the model",
                        quoted(name.as_bytes())
                    ),
                    format!("choose from {}", names.collect::<Vec<_>>().join(", ")),
                ));
            }
            model = model.without(name);
        }
        for text in &self.with {
            let mut argument = EffectArgument::parse("--with", text)?;
            let effect = argument.effect()?;
            if model.position(effect.name()).is_some() {
                return Err(argument.failure("is in the model already", "drop this option"));
            }
            let mut term = Term::new(effect);
            term.parameters = argument.shape(effect)?;
            if argument.take(effect.coefficient()).is_some() {
                let what = format!("{} is fitted, not given", effect.coefficient());
                return Err(argument.failure(what, "give only the shape parameters"));
            }
            model.put(term).map_err(|_| {
                argument.failure(
                    format!("the model would have more than {MAX_EFFECTS} effects"),
                    "leave some out with --without",
                )
            })?;
            argument.finish()?;
        }
        if model.terms().is_empty() {
            return Err(Failure::option(
                "the model has no effects left",
                "drop one of the options --without",
            ));
        }
        Ok(model)
    }
}
