//! The model that a record is compared with: the five terms, with the effects that are added or left out.

use crate::{
    effect_argument::{EffectArgument, Shape},
    known_filter, own,
};
use allanite::{Model, Term, effect::Effect, model::MAX_EFFECTS};
use allanite_log::failure::{Failure, quoted};

/// Effects to add and terms to leave out, as texts of options.
#[derive(Clone, Debug, Default)]
pub struct ModelChoice {
    /// The effects to add: `sinusoid:frequency_hz=0.3`, or `density: 1/(1+(f/3)^2)`.
    pub with: Vec<String>,
    /// The names of the terms to leave out.
    pub without: Vec<String>,
    /// The filter that is known: `low_pass:cutoff_hz=42,poles=2`.
    pub filter: Option<String>,
}

impl ModelChoice {
    /// Whether they change the five terms by more than a known filter.
    pub fn changes(&self) -> bool {
        !self.with.is_empty() || !self.without.is_empty()
    }

    /// Builds the model. A shape of zeros that is to be fitted is to be looked for in its whole range.
    ///
    /// # Errors
    /// When an effect is unknown, lacks a parameter, is in the model twice or not in it, or when the
    /// model gets too large or empty.
    pub fn model(&self) -> Result<Model, Failure> {
        let mut model = known_filter::model(self.filter.as_deref())?;
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
            if own::is_formula(text) {
                put_own(&mut model, text)?;
            } else {
                put(&mut model, text)?;
            }
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

fn too_many() -> String {
    format!("the model would have more than {MAX_EFFECTS} effects")
}

/// Adds an effect of the catalogue to a model.
fn put(model: &mut Model, text: &str) -> Result<(), Failure> {
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
    let full = |_| argument.failure(too_many(), "leave some out with --without");
    model.put(term).map_err(full)?;
    argument.finish()
}

/// Adds an effect of one's own to a model.
fn put_own(model: &mut Model, text: &str) -> Result<(), Failure> {
    let given = own::Given::parse("--with", text)?;
    let effect: &'static dyn Effect = given.effect;
    let fail = |what: &str, remedy: &str| {
        Failure::option(
            format!("--with {}: {what}", quoted(text.as_bytes())),
            remedy,
        )
    };
    if given.size.is_some() {
        return Err(fail("size is fitted, not given", "leave it out"));
    }
    if model.position(effect.name()).is_some() {
        let what = format!("an effect named {} is in the model already", effect.name());
        return Err(fail(&what, "give it another name: ; name=…"));
    }
    let term = Term {
        fitted: given.is_fitted,
        ..Term::known(effect, given.parameters)
    };
    model
        .put(term)
        .map_err(|_| fail(&too_many(), "leave some out with --without"))
}
