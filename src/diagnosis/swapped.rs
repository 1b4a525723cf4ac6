//! Swaps: second thoughts on an effect that was added alone. Where two effects are missing, a third one
//! whose shape is free enough may have stood for both. The two effects in its place must be as simple
//! as it is, or simpler.

use super::{
    scanned::{Scanning, Shapes},
    step::{Candidate, MAX_CANDIDATES, Step, Swap, cost},
    trial::Fitted,
    tried::{Contest, Trying},
};
use crate::{
    curve::Curve,
    effect::Effect,
    fit::{Problem, Start, Tolerance, Work},
    limits::MAX_PARAMETERS,
    list,
    model::{Model, Term},
    real::{Real, single},
};
use heapless::Vec;

/// The number of shapes of a scan that are fitted in full beside each effect that was not preferred.
/// Chosen by hand. `cargo xtask study hidden-effect` runs with this value and does not vary it.
const TRIED: usize = 2;

/// An effect that was added, and the effects to which it was preferred.
#[derive(Clone)]
pub(super) struct Preferred {
    added: &'static dyn Effect,
    /// The other effects, with the shapes to start from. Single precision is enough for these.
    others: Vec<(&'static dyn Effect, [f32; MAX_PARAMETERS]), { MAX_CANDIDATES - 1 }>,
}

impl Preferred {
    /// The first of the candidates, and the others that would have been accepted and are as simple as
    /// it is or simpler.
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
}

fn is_as_simple(effect: &'static dyn Effect, as_what: &'static dyn Effect) -> bool {
    cost(effect) <= cost(as_what)
}

/// Swaps in progress. Beside each effect to which the last addition was preferred, the effects of the
/// list are scanned and the best ones are tried.
pub(super) struct Swapping<const K: usize> {
    preferred: Preferred,
    next: usize,
    stage: Stage<K>,
}

// The large variants share their memory with those of other stages.
#[allow(clippy::large_enum_variant)]
enum Stage<const K: usize> {
    /// The next effect to which the last addition was preferred takes its place.
    Exchanging,
    /// The model with that effect is fitted.
    Solving(Model, Swap),
    /// The list of effects is scanned beside that effect.
    Scanning(Model, Swap, Scanning<K>),
    /// The best effects of the scan are tried.
    Trying(Trying),
}

impl<const K: usize> Swapping<K> {
    pub(super) const fn new(preferred: Preferred) -> Self {
        Self {
            preferred,
            next: 0,
            stage: Stage::Exchanging,
        }
    }

    /// Does one piece of work, and returns whether all swaps have been tried. A model that cannot be
    /// fitted has no candidates.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        curve: &Curve<K>,
        effects: &[&'static dyn Effect],
        contest: &Contest,
        work: &mut Work<K>,
        step: &mut Step<K>,
        best: &mut Fitted,
    ) -> bool {
        let solved = match &mut self.stage {
            Stage::Exchanging => return self.exchange(curve, &step.model, contest, work),
            Stage::Solving(base, _) => {
                let problem = Problem::new(curve, base, &work.columns);
                match work.solver.advance(&problem) {
                    Ok(false) => return false,
                    Ok(true) => true,
                    Err(_) => false,
                }
            }
            Stage::Scanning(base, _, scanning) => {
                let problem = Problem::new(curve, base, &work.columns);
                if !scanning.advance(&problem, &work.solver, effects, &contest.span) {
                    return false;
                }
                true
            }
            Stage::Trying(trying) => {
                if !trying.advance(curve, contest, work, &mut step.candidates, best) {
                    return false;
                }
                false
            }
        };
        if solved {
            self.go_on(curve, work);
        } else {
            self.stage = Stage::Exchanging;
        }
        false
    }

    /// Scans beside a model that has been solved, or tries what has been scanned.
    #[inline(never)]
    fn go_on(&mut self, curve: &Curve<K>, work: &Work<K>) {
        match &self.stage {
            Stage::Solving(base, swap) => {
                let problem = Problem::new(curve, base, &work.columns);
                let scanning = Scanning::new(&problem, &work.solver.weights);
                self.stage = Stage::Scanning(base.clone(), *swap, scanning);
            }
            Stage::Scanning(base, swap, scanning) => {
                let simple = scanning.shapes().iter().copied().filter(|found| {
                    let effect = found.term.effect;
                    effect.name() != swap.dropped.name() && is_as_simple(effect, swap.dropped)
                });
                let shapes: Shapes = list::fill(simple.take(TRIED));
                self.stage = Stage::Trying(Trying::new(shapes, base.clone(), Some(*swap)));
            }
            Stage::Exchanging | Stage::Trying(_) => {}
        }
    }

    /// Begins with the next swap. Returns `true` if there is none.
    #[inline(never)]
    fn exchange(
        &mut self,
        curve: &Curve<K>,
        model: &Model,
        contest: &Contest,
        work: &mut Work<K>,
    ) -> bool {
        let Some(&(taken, parameters)) = self.preferred.others.get(self.next) else {
            return true;
        };
        self.next = self.next.saturating_add(1);
        let swap = Swap {
            dropped: self.preferred.added,
            taken,
        };
        let term = Term {
            parameters: parameters.map(Real::from),
            ..Term::fitted(taken)
        };
        let mut base = model.clone();
        if base.exchange(swap.dropped, term).is_ok() {
            let tolerance = Tolerance::Fixed(contest.tolerance);
            let begun = work.begin_at(curve, &base, Start::Independent, tolerance);
            if begun.is_ok() {
                self.stage = Stage::Solving(base, swap);
            }
        }
        false
    }
}
