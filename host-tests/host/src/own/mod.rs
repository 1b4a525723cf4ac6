//! Effects of a user's own, as formulas: `density: 1/(1 + (f/corner_hz)^2); corner_hz=0.1..30`.

mod covariance;
mod density;
mod effect;
mod examination;
mod file;
mod formula;
mod kind;
mod refusal;
mod sampled;
#[cfg(test)]
mod tests;
mod value;

pub(crate) use density::Density;
pub use effect::{FormulaEffect, find, named};

use allanite::effect::MAX_PARAMETERS;
use allanite_log::failure::{Failure, quoted};
use effect::SIZE;
use examination::examine;
use formula::Formula;
use kind::kind_of;
use refusal::Refusal;
use value::{NAME, Value, in_order, values};

/// An effect with the shape that a text gives it.
pub struct Given {
    /// The effect.
    pub effect: &'static FormulaEffect,
    /// The parameters: what they are, or where a search begins. Zeros for a search in the whole range.
    pub parameters: [f64; MAX_PARAMETERS],
    /// Whether they are to be fitted.
    pub is_fitted: bool,
    /// The coefficient, if the text gives it.
    pub size: Option<f64>,
}

/// Whether a text is that of a formula, and not of an effect of the catalogue.
pub fn is_formula(text: &str) -> bool {
    kind_of(text).is_some()
}

/// The name of the effect in a text that is a formula; `None` for another text.
pub fn name_in(text: &str) -> Option<&str> {
    let (_, rest) = kind_of(text)?;
    let names = rest.split(';').skip(1).filter_map(|part| {
        let (own, name) = part.split_once('=')?;
        (own.trim() == "name").then(|| name.trim())
    });
    Some(names.last().unwrap_or(NAME))
}

impl Given {
    /// Reads an option such as `--with`, whose text [is a formula](is_formula).
    ///
    /// # Errors
    /// When the formula is not understood, a parameter has no value, or the effect is none that a record can have.
    pub fn parse(option: &str, text: &str) -> Result<Self, Failure> {
        let Some((kind, rest)) = kind_of(text) else {
            return Err(Failure::option(
                format!("{option} {}: no formula", quoted(text.as_bytes())),
                "write density: … or covariance: …",
            ));
        };
        let fail = |(what, remedy): Refusal| {
            Failure::option(format!("{option} {}: {what}", kind.name()), remedy)
        };
        let mut parts = rest.split(';');
        let formula = parts.next().unwrap_or_default().trim();
        let mut names = Vec::new();
        let read = match formula.strip_prefix('@') {
            Some(path) => Formula::through(file::points(path.trim())?),
            None => Formula::parse(formula, kind.variable(), &mut names).map_err(fail)?,
        };
        let (name, mut values) = values(parts).map_err(fail)?;
        let size = values.iter().position(|(name, _)| *name == SIZE);
        let size = match size.map(|at| values.remove(at).1) {
            None => None,
            Some(Value::Known(size)) => Some(size),
            Some(_) => {
                let what = "size is a number".to_owned();
                return Err(fail((what, "write size=VALUE".into())));
            }
        };
        let values = in_order(&names, &values).map_err(fail)?;
        let mut parameters = [0.0; MAX_PARAMETERS];
        for (parameter, value) in parameters.iter_mut().zip(&values) {
            match value {
                Value::Known(value) | Value::Begin(value) => *parameter = *value,
                Value::Range(_) => {}
            }
        }
        let is_fitted = match values.first() {
            None | Some(Value::Known(_)) => false,
            Some(_) => true,
        };
        let effect = FormulaEffect::made(kind, read, formula, (&name, &names), &values);
        let given = Self {
            effect,
            parameters,
            is_fitted,
            size,
        };
        examine(given.effect, &values).map_err(fail)?;
        Ok(given)
    }
}
