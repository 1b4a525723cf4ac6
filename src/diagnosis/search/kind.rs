//! The kinds of effects, according to their descriptions.

pub(crate) use crate::theory::model::is_white;

use crate::{
    list::{self, numbered},
    numerics::real::Real,
    theory::{
        effect::{Distribution, Effect},
        model::Term,
    },
};

/// Whether a frequency comes first among an effect's parameters.
pub(super) fn has_frequency(effect: &dyn Effect) -> bool {
    effect
        .parameters()
        .first()
        .is_some_and(|first| first.unit == "Hz")
}

/// Whether an effect is a line: deterministic, with a frequency.
pub(super) fn is_line(effect: &dyn Effect) -> bool {
    effect.description().distribution == Distribution::Deterministic && has_frequency(effect)
}

/// Whether an effect is an oscillation whose frequency moves over a range: the last of its parameters, beyond those of the
/// effect that it becomes without a range.
pub(super) fn is_drifting(effect: &dyn Effect) -> bool {
    let last = effect.parameters().last();
    last.is_some_and(|last| last.name == "drift_hz")
}

/// Whether an effect is a hump around a frequency, with a quality.
pub(super) fn is_resonance(effect: &dyn Effect) -> bool {
    let second = effect.parameters().get(1);
    has_frequency(effect) && second.is_some_and(|second| second.name == "quality")
}

/// Whether an effect has no shape and takes the place of no other, as most of the five terms.
pub(super) fn is_plain(effect: &'static dyn Effect) -> bool {
    effect.replaces().is_none() && effect.mirror().is_none() && effect.parameters().is_empty()
}

/// Whether an effect takes the place of the white noise, as what filters it does.
pub(crate) fn is_filter(effect: &dyn Effect) -> bool {
    let replaced = effect.replaces();
    replaced.is_some_and(is_white)
}

/// Whether an effect adds to the noise, and a search can find it: it is no filter, and has a shape. One that takes the
/// place of another term, as a power law that of flicker noise, is sought in addition to that term. An effect with the same Allan variance as another one is distinguished from it afterwards.
pub(super) fn is_added(effect: &'static dyn Effect) -> bool {
    !is_filter(effect) && effect.mirror().is_none() && !effect.parameters().is_empty()
}

/// The number of an effect's shape parameters that are not whole numbers.
pub(super) fn continuous(effect: &'static dyn Effect) -> u32 {
    list::count(Term::fitted(effect).fitted_parameters()) as u32
}

/// The term of an effect at a shape.
pub(super) fn at(effect: &'static dyn Effect, parameters: &[Real]) -> Term {
    let mut term = Term::fitted(effect);
    for (j, &parameter) in numbered(parameters) {
        term.set_parameter(j, parameter);
    }
    term
}
