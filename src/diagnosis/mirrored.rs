//! Last stage: the kurtosis tells an effect from another one that has the same Allan variance. If it
//! cannot, both are named.

use super::{
    step::{Addition, Step},
    trial::Fitted,
};
use crate::{
    effect::Effect,
    fit::{Columns, Problem},
    kurtosis::Kurtosis,
    list,
    observed::Observed,
};

/// Names the mirror of every ambiguous effect beside it. For the best candidate, the kurtosis may
/// decide between the effect and its mirror. The right one is then added, and the other one is not
/// named. The memory of `columns` is used.
#[inline(never)]
pub(super) fn tell_from_mirror<const K: usize, const B: usize>(
    observed: Observed<'_, K, B>,
    kurtosis: Option<&Kurtosis<K>>,
    effects: &[&'static dyn Effect],
    columns: &mut Columns<K, B>,
    best: &mut Fitted,
    step: &mut Step<K, B>,
) {
    let Step {
        added,
        ambiguous,
        candidates,
        ..
    } = step;
    // Behind each name comes the name of its mirror, because nothing has told the two apart.
    let mut at = 0_usize;
    while let Some(name) = ambiguous.get(at) {
        at = at.saturating_add(1);
        if let Some(mirror) = mirror_of(name, effects) {
            // There is a place for every name that candidates can bring, and for its mirror.
            list::insert(ambiguous, at, mirror.name());
            at = at.saturating_add(1);
        }
    }
    let Some(Addition::Effect(term)) = added else {
        return;
    };
    let Some(mirror) = mirror_of(term.effect.name(), effects) else {
        return;
    };
    let place = best.model.terms().len().saturating_sub(1);
    // The kurtosis is known by octaves, and not only by those that are fitted.
    let octaves = observed.octaves();
    columns.set(octaves, &best.model);
    let problem = Problem::new(octaves, &best.model, columns);
    let share = |k: usize| problem.share(k, place, &best.squares);
    let correlation_time_s = term.parameters[0];
    let jumps =
        kurtosis.and_then(|kurtosis| kurtosis.jumps(observed.curve(), correlation_time_s, share));
    match jumps {
        Some(true) => {
            term.effect = mirror;
            if let Some(last) = best.model.terms_mut().last_mut() {
                last.effect = mirror;
            }
            if let Some(first) = candidates.first_mut() {
                first.term.effect = mirror;
            }
        }
        Some(false) => {}
        None => {
            let _ = ambiguous.push(mirror.name());
        }
    }
}

/// The effect of the list whose Allan variance is that of the effect with this name.
fn mirror_of(name: &str, effects: &[&'static dyn Effect]) -> Option<&'static dyn Effect> {
    let is_mirror = |effect: &dyn Effect| effect.mirror().is_some_and(|other| other.name() == name);
    effects.iter().copied().find(|effect| is_mirror(*effect))
}
