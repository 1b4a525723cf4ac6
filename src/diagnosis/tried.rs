//! Third stage: the shapes that a scan found are fitted in full and become candidates.

use super::{
    scanned::Shapes,
    step::{Candidate, Candidates, Swap},
    trial::{Fitted, Rival, Trial},
};
use crate::{effect::Span, fit::Work, list, model::Model, observed::Observed, real::Real};

/// What the candidates are compared with, and how.
#[derive(Clone, Copy)]
pub(super) struct Contest {
    /// The score of the step's model.
    pub(super) score: Real,
    /// The tolerance of all models of the diagnosis.
    pub(super) tolerance: Real,
    pub(super) span: Span,
}

/// The lead in improvement that an effect needs over its own special case, which it can imitate. Where the special
/// case is true, the lead is larger in one of 150 records: half the probability of χ² with one degree of freedom
/// beyond 7, the lead and the cost of a parameter.
const OVER_SPECIAL_CASE: Real = 5.0;

/// Enters a candidate into the list, and returns its place. A candidate that does not lead over its special case
/// does not stay beside it.
fn enter(candidates: &mut Candidates, candidate: Candidate) -> Option<usize> {
    let leads = |general: &Candidate, special: &Candidate| {
        general.improvement > special.improvement + OVER_SPECIAL_CASE
    };
    let mut others = candidates.iter();
    if others.any(|other| other.is_special_case_of(&candidate) && !leads(&candidate, other)) {
        return None;
    }
    let mut others = candidates.iter();
    let imitates =
        |other: &Candidate| candidate.is_special_case_of(other) && !leads(other, &candidate);
    if let Some(place) = others.position(imitates) {
        list::remove(candidates, place);
        // The special case explains the curve as well, so that it takes the same place.
        list::insert(candidates, place, candidate);
        return Some(place);
    }
    list::rank(candidates, candidate, |other| {
        other.improvement < candidate.improvement
    })
}

/// The model beside which a scan was made, and the swap that leads from the step's model to it.
#[derive(Clone, Copy)]
pub(super) struct Base<'m> {
    pub(super) model: &'m Model,
    pub(super) swap: Option<Swap>,
}

/// The trials of several shapes, one after the other, in progress.
pub(super) struct Trying {
    shapes: Shapes,
    next: usize,
    trial: Option<(Trial, Candidate)>,
    /// Whether the model with the best candidate so far is adequate.
    explains: bool,
}

impl Trying {
    /// Begins to try shapes that a scan found.
    pub(super) const fn new(shapes: Shapes) -> Self {
        Self {
            shapes,
            next: 0,
            trial: None,
            explains: false,
        }
    }

    /// Does one piece of work, and returns whether all shapes have been tried. A shape that lowers the
    /// score becomes a candidate. The model with the best candidate is kept as `best`.
    #[inline(never)]
    pub(super) fn advance<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        contest: &Contest,
        base: Base<'_>,
        work: &mut Work<K, B>,
        candidates: &mut Candidates,
        best: &mut Fitted,
    ) -> bool {
        let Some((trial, candidate)) = &mut self.trial else {
            return self.begin_next(base, candidates);
        };
        let gained = candidates.first();
        let least = Some(Rival {
            score: contest.score - gained.map_or(0.0, |first| first.improvement),
            explains: self.explains,
        });
        let Contest {
            score,
            tolerance,
            span,
        } = contest;
        let completed = match trial.advance(observed, span, *tolerance, least, work, candidate) {
            Ok(None) => return false,
            Ok(completed) => completed,
            // An effect that cannot be fitted is no candidate.
            Err(_) => None,
        };
        if let Some(completed) = completed {
            let mut candidate = *candidate;
            candidate.improvement = score - completed.score - 2.0 * candidate.cost();
            if candidate.improvement > 0.0 && enter(candidates, candidate) == Some(0) {
                *best = completed.fitted;
                self.explains = completed.explains;
            }
        }
        self.trial = None;
        false
    }

    /// Begins with the next shape. Returns `true` if there is none.
    fn begin_next(&mut self, base: Base<'_>, candidates: &Candidates) -> bool {
        let Some(found) = self.shapes.get(self.next) else {
            return true;
        };
        self.next = self.next.saturating_add(1);
        let candidate = Candidate::of(found.term, base.swap);
        let mut others = candidates.iter();
        if others.any(|other| other.brings_the_same(&candidate)) {
            return false;
        }
        if let Ok(fitted) = Fitted::with(base.model, found) {
            self.trial = Some((Trial::new(fitted), candidate));
        }
        false
    }
}
