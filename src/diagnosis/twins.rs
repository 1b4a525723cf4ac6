//! Effects that share their Allan variance.

use super::{Addition, Step, trial::Better};
use crate::{curve::Curve, effect::Effect, fit::Problem, kurtosis::Kurtosis};

/// Of an effect that shares its Allan variance with another, names the one that the kurtosis speaks
/// for, or both.
#[inline(never)]
pub(super) fn tell<const K: usize>(
    curve: &Curve<K>,
    kurtosis: Option<&Kurtosis<K>>,
    effects: &[&'static dyn Effect],
    better: &mut Better,
    step: &mut Step<K>,
) {
    let Some(Addition::Effect(added)) = &mut step.added else {
        return;
    };
    let is_twin = |effect: &&&'static dyn Effect| {
        effect
            .twin()
            .is_some_and(|twin| twin.name() == added.effect.name())
    };
    let Some(&twin) = effects.iter().find(is_twin) else {
        return;
    };
    let at = better.model.terms().len() - 1;
    let problem = Problem::new(curve, &better.model);
    let share = |k: usize| problem.share(k, at, &better.squares);
    let correlation_time_s = added.parameters[0];
    match kurtosis.map(|kurtosis| kurtosis.jumps(curve, correlation_time_s, share)) {
        Some(Some(true)) => {
            added.effect = twin;
            better.model.terms_mut()[at].effect = twin;
            if let Some(first) = step.candidates.first_mut() {
                first.term.effect = twin;
            }
        }
        Some(Some(false)) => {}
        _ => {
            // As many names as candidates fit; the twin is one of the first.
            let _ = step.ambiguous.push(twin.name());
        }
    }
}
