//! Swaps: second thoughts on an effect that was added alone. Where two effects are missing, a third one
//! whose shape is free enough may have stood for both. The two effects in its place must be as simple
//! as it is, or simpler.

use super::{
    scanned::{Scanning, Shapes},
    step::{Candidate, MAX_CANDIDATES, Step, Swap, cost},
    trial::Fitted,
    tried::{Base, Contest, Trying},
};
use crate::{
    effect::Effect,
    fit::{Problem, Start, Tolerance, Work},
    limits::MAX_PARAMETERS,
    list,
    model::{Model, Term},
    observed::Observed,
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
pub(super) struct Swapping<const K: usize, const B: usize> {
    preferred: Preferred,
    next: usize,
    /// The present swap, and the model that it leads to.
    swap: Option<Swap>,
    base: Model,
    stage: Stage<K, B>,
}

// The large variants share their memory with those of other stages.
#[allow(clippy::large_enum_variant)]
enum Stage<const K: usize, const B: usize> {
    /// The next effect to which the last addition was preferred takes its place.
    Exchanging,
    /// The model with that effect is fitted.
    Solving,
    /// The list of effects is scanned beside that effect.
    Scanning(Scanning<K, B>),
    /// The best effects of the scan are tried.
    Trying(Trying),
}

impl<const K: usize, const B: usize> Swapping<K, B> {
    #[inline(always)]
    pub(super) fn new(preferred: Preferred) -> Self {
        Self {
            preferred,
            next: 0,
            swap: None,
            base: Model::default(),
            stage: Stage::Exchanging,
        }
    }

    /// Does one piece of work, and returns whether all swaps have been tried. A model that cannot be
    /// fitted has no candidates.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        observed: Observed<'_, K, B>,
        effects: &[&'static dyn Effect],
        contest: &Contest,
        work: &mut Work<K, B>,
        step: &mut Step<K, B>,
        best: &mut Fitted,
    ) -> bool {
        let problem = Problem::new(observed, &self.base, &work.columns);
        match &mut self.stage {
            Stage::Exchanging => return self.exchange(observed, &step.model, contest, work),
            Stage::Solving => match work.solver.advance(&problem) {
                Ok(false) => {}
                Ok(true) => self.scan(observed, work),
                Err(_) => self.stage = Stage::Exchanging,
            },
            Stage::Scanning(scanning) => {
                if scanning.advance(&problem, &work.solver, effects, &contest.span) {
                    self.try_shapes();
                }
            }
            Stage::Trying(trying) => {
                let base = Base {
                    model: &self.base,
                    swap: self.swap,
                };
                if trying.advance(observed, contest, base, work, &mut step.candidates, best) {
                    self.stage = Stage::Exchanging;
                }
            }
        }
        false
    }

    /// Begins to scan beside the solved model.
    // This is a function of its own, because its temporaries would lie on the stack below all stages.
    #[inline(never)]
    fn scan(&mut self, observed: Observed<'_, K, B>, work: &mut Work<K, B>) {
        self.stage = Stage::Scanning(Scanning::new());
        if let Stage::Scanning(scanning) = &mut self.stage {
            let problem = Problem::new(observed, &self.base, &work.columns);
            scanning.begin(&problem, &mut work.solver);
        }
    }

    /// Begins to try the best shapes of the scan whose effects are as simple as the effect that was
    /// added last, or simpler.
    #[inline(never)]
    fn try_shapes(&mut self) {
        let (Stage::Scanning(scanning), Some(swap)) = (&self.stage, self.swap) else {
            return;
        };
        let simple = scanning.shapes().iter().copied().filter(|found| {
            let effect = found.term.effect;
            effect.name() != swap.dropped.name() && is_as_simple(effect, swap.dropped)
        });
        let shapes: Shapes = list::fill(simple.take(TRIED));
        self.stage = Stage::Trying(Trying::new(shapes));
    }

    /// Begins with the next swap. Returns `true` if there is none.
    #[inline(never)]
    fn exchange(
        &mut self,
        observed: Observed<'_, K, B>,
        model: &Model,
        contest: &Contest,
        work: &mut Work<K, B>,
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
        self.swap = Some(swap);
        self.base.clone_from(model);
        if self.base.exchange(swap.dropped, term).is_ok() {
            let tolerance = Tolerance::Fixed(contest.tolerance);
            let begun = work.begin_at(observed, &self.base, Start::Independent, tolerance);
            if begun.is_ok() {
                self.stage = Stage::Solving;
            }
        }
        false
    }
}
