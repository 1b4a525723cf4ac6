//! An effect of the catalogue by itself.

use crate::effect_argument::EffectArgument;
use allanite_log::failure::Failure;

/// The name of the effect that a text gives, which may be a formula.
pub fn effect_name(text: &str) -> &str {
    EffectArgument::name_in(text)
}

/// Reads an effect as the options of `compare` and `diagnose` read it, without a model. The shape of a fitted one may be left
/// out.
///
/// # Errors
/// When there is no such effect, or it has not these parameters.
pub fn check_effect(text: &str, fitted: bool) -> Result<(), Failure> {
    let mut argument = EffectArgument::parse("effect", text)?;
    let effect = argument.effect()?;
    if fitted {
        argument.known_or_fitted(effect)?;
    } else {
        argument.shape(effect)?;
    }
    argument.finish()
}
