//! The model of `compare`: the five terms, with the effects that options add or leave out.

use crate::command::{
    effect_argument::{EffectArgument, Shape},
    known_filter::KnownFilter,
};
use allanite::{Model, Term, model::MAX_EFFECTS};
use allanite_log::failure::{Failure, quoted};
use clap::Args;

/// Effects to add and terms to leave out.
#[derive(Debug, Args)]
pub(in crate::command) struct ModelArguments {
    /// Add an effect; its coefficient is fitted. `sinusoid:frequency_hz=0.3` and
    /// `decimation_filter:width_s=0.014,stages=2` have a known shape. The shape of `sinusoid` is fitted, wherever it
    /// is in its range, and that of `sinusoid:frequency_hz~0.3` from 0.3 Hz on. If the effect replaces a term, that
    /// term is removed
    #[arg(long, value_name = "EFFECT[:parameter=value,…]")]
    with: Vec<String>,
    /// Leave out a term, such as `rate_ramp`
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    #[command(flatten)]
    filter: KnownFilter,
}

impl ModelArguments {
    /// The options with these values, for a caller without a command line.
    pub(in crate::command) fn new(with: Vec<String>, without: Vec<String>) -> Self {
        Self {
            with,
            without,
            filter: KnownFilter::default(),
        }
    }

    /// Whether the options change the five terms by more than a known filter.
    pub(in crate::command) fn changes(&self) -> bool {
        !self.with.is_empty() || !self.without.is_empty()
    }

    /// Builds the model. A shape of zeros that is to be fitted is to be looked for in its whole range.
    ///
    /// # Errors
    /// When an effect is unknown, lacks a parameter, is in the model twice or not in it, or when the
    /// model gets too large or empty.
    pub(in crate::command) fn model(&self) -> Result<Model, Failure> {
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
            // There can be several lines or resonances, but one filter, and one effect without a shape.
            let is_single = effect.parameters().is_empty() || effect.replaces().is_some();
            if is_single && model.position(effect.name()).is_some() {
                return Err(argument.failure("is in the model already", "drop this option"));
            }
            let term = match argument.known_or_fitted(effect)? {
                Shape::Known(parameters) => Term::known(effect, parameters),
                Shape::Fitted(parameters) => Term {
                    fitted: true,
                    ..Term::known(effect, parameters)
                },
            };
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
