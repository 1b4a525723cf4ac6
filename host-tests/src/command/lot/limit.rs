//! A limit of a coefficient, as an option of the command line.

use crate::failure::{Failure, quoted};
use allanite::effect::{CATALOGUE, IEEE_952};

/// The largest value that a coefficient may have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// The name of the effect.
    pub(super) effect: &'static str,
    /// The limit, in rate unit · s^(half_seconds/2) of the effect.
    pub(super) value: f64,
}

impl Limit {
    /// Reads `EFFECT=VALUE`.
    ///
    /// # Errors
    /// When there is no such effect, or the value is not a positive number.
    pub(super) fn parse(text: &str) -> Result<Self, Failure> {
        let shown = quoted(text.as_bytes());
        let fail =
            |what: &str, remedy: &str| Failure::option(format!("--limit {shown}: {what}"), remedy);
        let Some((name, value)) = text.split_once('=') else {
            return Err(fail(
                "there is no value",
                "write EFFECT=VALUE, such as N=0.005",
            ));
        };
        let mut effects = IEEE_952.into_iter().chain(CATALOGUE);
        let name = name.trim();
        let found = effects.find(|effect| effect.name() == name || effect.symbol() == name);
        let Some(effect) = found else {
            return Err(fail(
                "there is no such effect",
                "give a symbol such as N, or a name such as angle_random_walk",
            ));
        };
        let value = value.trim().parse::<f64>().ok();
        let Some(value) = value.filter(|value| value.is_finite() && *value > 0.0) else {
            return Err(fail(
                "the value is not a positive number",
                "give a number such as 0.005",
            ));
        };
        Ok(Self {
            effect: effect.name(),
            value,
        })
    }
}
