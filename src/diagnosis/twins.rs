//! Effects that share their Allan variance.

use super::{Addition, standing::Standing};
use crate::{curve::Curve, effect::Effect, fit::Problem, kurtosis::Kurtosis, list};

/// Of an effect that shares its Allan variance with another, names the one that the kurtosis speaks
/// for, or both.
#[inline(never)]
pub(super) fn tell<const K: usize>(
    curve: &Curve<K>,
    kurtosis: Option<&Kurtosis<K>>,
    effects: &[&'static dyn Effect],
    standing: &mut Standing<K>,
) {
    let Standing {
        step, best: better, ..
    } = standing;
    // Behind a name comes its twin: nobody has told them apart.
    let mut at = 0_usize;
    while let Some(name) = step.ambiguous.get(at) {
        at = at.saturating_add(1);
        let twin = effects.iter().find(|effect| is_twin(**effect, name));
        if let Some(twin) = twin {
            // As many names as candidates bring, with their twins.
            list::insert(&mut step.ambiguous, at, twin.name());
            at = at.saturating_add(1);
        }
    }
    let Some(Addition::Effect(added)) = &mut step.added else {
        return;
    };
    let name = added.effect.name();
    let Some(&twin) = effects.iter().find(|effect| is_twin(**effect, name)) else {
        return;
    };
    let at = better.model.terms().len().saturating_sub(1);
    let problem = Problem::new(curve, &better.model);
    let share = |k: usize| problem.share(k, at, &better.squares);
    let correlation_time_s = added.parameters[0];
    match kurtosis.map(|kurtosis| kurtosis.jumps(curve, correlation_time_s, share)) {
        Some(Some(true)) => {
            added.effect = twin;
            if let Some(last) = better.model.terms_mut().last_mut() {
                last.effect = twin;
            }
            if let Some(first) = step.candidates.first_mut() {
                first.term.effect = twin;
            }
        }
        Some(Some(false)) => {}
        _ => {
            let _ = step.ambiguous.push(twin.name());
        }
    }
}

fn is_twin(effect: &dyn Effect, name: &str) -> bool {
    effect.twin().is_some_and(|twin| twin.name() == name)
}
