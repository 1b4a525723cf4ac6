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
    // Behind a name comes its mirror: nobody has told them apart.
    let mut at = 0_usize;
    while let Some(name) = step.ambiguous.get(at) {
        at = at.saturating_add(1);
        let mirror = effects.iter().find(|effect| is_mirror(**effect, name));
        if let Some(mirror) = mirror {
            // As many names as candidates bring, with their mirrors.
            list::insert(&mut step.ambiguous, at, mirror.name());
            at = at.saturating_add(1);
        }
    }
    let Some(Addition::Effect(added)) = &mut step.added else {
        return;
    };
    let name = added.effect.name();
    let Some(&mirror) = effects.iter().find(|effect| is_mirror(**effect, name)) else {
        return;
    };
    let at = better.model.terms().len().saturating_sub(1);
    let problem = Problem::new(curve, &better.model);
    let share = |k: usize| problem.share(k, at, &better.squares);
    let correlation_time_s = added.parameters[0];
    match kurtosis.map(|kurtosis| kurtosis.jumps(curve, correlation_time_s, share)) {
        Some(Some(true)) => {
            added.effect = mirror;
            if let Some(last) = better.model.terms_mut().last_mut() {
                last.effect = mirror;
            }
            if let Some(first) = step.candidates.first_mut() {
                first.term.effect = mirror;
            }
        }
        Some(Some(false)) => {}
        _ => {
            let _ = step.ambiguous.push(mirror.name());
        }
    }
}

fn is_mirror(effect: &dyn Effect, name: &str) -> bool {
    effect.mirror().is_some_and(|mirror| mirror.name() == name)
}
