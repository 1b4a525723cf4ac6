//! Distinguishes two effects with the same Allan variance by the kurtosis. If the kurtosis does not decide, both are named.

use super::polish::Fitted;
use crate::{
    evidence::{kurtosis::Kurtosis, observed::Observed},
    fit::{Columns, Problem},
    theory::effect::Effect,
};

/// What the kurtosis says of an effect.
pub(super) enum Mirrored {
    /// The effect is what it is called, or no other one has its Allan variance.
    Same,
    /// It is this one.
    Other(&'static dyn Effect),
    /// It may be this one as well.
    Unknown(&'static dyn Effect),
}

/// Asks the kurtosis whether the effect at a place of a model is its mirror.
#[inline(never)]
pub(super) fn tell_from_mirror<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    kurtosis: Option<&Kurtosis<K>>,
    effects: &[&'static dyn Effect],
    fitted: &Fitted,
    place: usize,
) -> Mirrored {
    let Some(term) = fitted.model.terms().get(place) else {
        return Mirrored::Same;
    };
    let Some(mirror) = mirror_of(term.effect.name(), effects) else {
        return Mirrored::Same;
    };
    // The kurtosis is known by octaves, and not only by those that are fitted.
    let octaves = observed.octaves();
    let mut columns = Columns::<K, B>::EMPTY;
    columns.set(octaves, &fitted.model);
    let problem = Problem::new(octaves, &fitted.model, &columns);
    let share = |k: usize| problem.share(k, place, &fitted.squares);
    let correlation_time_s = term.parameter(0);
    let jumps =
        kurtosis.and_then(|kurtosis| kurtosis.jumps(observed.curve(), correlation_time_s, share));
    match jumps {
        Some(true) => Mirrored::Other(mirror),
        Some(false) => Mirrored::Same,
        None => Mirrored::Unknown(mirror),
    }
}

/// The effect of the list whose Allan variance is that of the effect with this name.
fn mirror_of(name: &str, effects: &[&'static dyn Effect]) -> Option<&'static dyn Effect> {
    let is_mirror = |effect: &dyn Effect| effect.mirror().is_some_and(|other| other.name() == name);
    effects.iter().copied().find(|effect| is_mirror(*effect))
}
