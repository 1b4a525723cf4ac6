//! Second thoughts on an effect that was added alone: where two are missing, a third of a free enough
//! shape may have taken the part of both. Those two are as simple as it is, or simpler.

use super::{
    Candidate, Diagnosis, MAX_CANDIDATES, Swap, scan::scan_beside, standing::Standing, step::cost,
};
use crate::{
    curve::Curve,
    effect::Effect,
    error::Error,
    limits::MAX_PARAMETERS,
    list,
    model::{Model, Term},
    real::{Real, single},
};
use heapless::Vec;

/// Shapes of a scan that are fitted in full beside a runner-up.
const TRIED: usize = 2;

/// An effect that was added, and those that it was preferred to.
#[derive(Clone)]
pub(super) struct Preferred {
    added: &'static dyn Effect,
    /// Starting points need no more than single precision.
    others: Vec<(&'static dyn Effect, [f32; MAX_PARAMETERS]), { MAX_CANDIDATES - 1 }>,
}

impl Preferred {
    /// The first of the candidates to the others, as far as these would have been accepted and are no
    /// freer in shape.
    pub(super) fn of(candidates: &[Candidate], threshold: Real) -> Option<Self> {
        let (first, others) = candidates.split_first()?;
        let accepted = others.iter().filter(|other| {
            is_as_simple(other.term.effect, first.term.effect) && other.improvement >= threshold
        });
        let start = |other: &Candidate| (other.term.effect, other.term.parameters.map(single));
        Some(Self {
            added: first.term.effect,
            others: list::fill(accepted.map(start)),
        })
    }

    /// The model with another effect instead of the one that was added.
    #[inline(never)]
    fn instead(
        &self,
        model: &Model,
        (effect, parameters): (&'static dyn Effect, [f32; MAX_PARAMETERS]),
        base: &mut Model,
    ) -> Result<(), Error> {
        base.clone_from(model);
        let taken = Term {
            parameters: parameters.map(Real::from),
            ..Term::fitted(effect)
        };
        base.exchange(self.added, taken)
    }
}

fn is_as_simple(effect: &'static dyn Effect, as_what: &'static dyn Effect) -> bool {
    cost(effect) <= cost(as_what)
}

impl Diagnosis {
    /// Where even the effect that was added last leaves the curve unexplained: tries the effects beside
    /// each of those that it was preferred to.
    #[inline(never)]
    pub(super) fn revise<const K: usize>(
        &self,
        curve: &Curve<K>,
        effects: &[&'static dyn Effect],
        standing: &mut Standing<K>,
    ) {
        let Some(preferred) = standing.preferred.take() else {
            return;
        };
        for &other in &preferred.others {
            // A model that cannot be fitted has no candidates.
            let Standing {
                step, base, found, ..
            } = &mut *standing;
            if preferred.instead(&step.model, other, base).is_err() {
                continue;
            }
            found.clear();
            if scan_beside(curve, base, self.tolerance, effects, found).is_err() {
                continue;
            }
            let tried = found.iter().copied().filter(|found| {
                let effect = found.term.effect;
                effect.name() != preferred.added.name() && is_as_simple(effect, preferred.added)
            });
            *found = list::fill(tried.take(TRIED));
            let swap = Swap {
                dropped: preferred.added,
                taken: other.0,
            };
            self.try_all(curve, Some(swap), standing);
        }
    }
}
