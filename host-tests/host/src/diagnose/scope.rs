//! What a search for effects tries, and how far it goes.

use crate::own::Given;
use allanite::{
    diagnosis::Options,
    effect::{CATALOGUE, Effect},
};
use allanite_log::failure::{Failure, quoted};

/// The effects that are tried, and the options of the search.
#[derive(Clone)]
pub struct Scope {
    /// The options.
    pub options: Options,
    /// The catalogue, and effects of the user's own.
    pub effects: Vec<&'static dyn Effect>,
}

impl Default for Scope {
    fn default() -> Self {
        Self {
            options: Options::default(),
            effects: CATALOGUE.to_vec(),
        }
    }
}

impl Scope {
    /// The catalogue with effects that formulas describe, of which at most so many are added.
    ///
    /// # Errors
    /// When a formula is not understood, a parameter has no range, or two effects have one name.
    pub fn new(max_effects: Option<usize>, formulas: &[String]) -> Result<Self, Failure> {
        let mut scope = Self::default();
        scope.options.max_effects = max_effects.unwrap_or(scope.options.max_effects);
        for text in formulas {
            let given = Given::parse("--try", text)?;
            let effect: &'static dyn Effect = given.effect;
            let fail = |what: &str, remedy: &str| {
                Failure::option(format!("--try {}: {what}", quoted(text.as_bytes())), remedy)
            };
            if given.size.is_some() {
                return Err(fail("size is fitted, not given", "leave it out"));
            }
            if !given.is_fitted && !effect.parameters().is_empty() {
                return Err(fail(
                    "its parameters are known",
                    "write ranges, such as corner_hz=0.1..30, or the numbers into the formula",
                ));
            }
            if scope
                .effects
                .iter()
                .any(|other| other.name() == effect.name())
            {
                return Err(fail(
                    &format!("there is an effect named {} already", effect.name()),
                    "give it another name: ; name=…",
                ));
            }
            scope.effects.push(effect);
        }
        Ok(scope)
    }
}
