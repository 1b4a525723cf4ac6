//! Backward elimination: an effect that was added early may have stood for others that were found
//! later. The model is tried without each of the earlier additions, and drops what it does not need.

use super::{
    step::{Candidate, cost},
    trial::{Fitted, Trial},
    tried::Contest,
};
use crate::{
    fit::Work,
    list::numbered,
    model::{Model, Term},
    nnls::Vector,
    observed::Observed,
    real::Real,
};

/// The trials of a model without each of its earlier additions, in progress.
pub(super) struct Dropping {
    /// The number of fitted effects that the diagnosis began with. They are never dropped.
    given: usize,
    /// The number of additions that have been tried.
    next: usize,
    trial: Option<(Trial, Candidate)>,
    /// The effect that is needed least, by its place and by how much it improves the model, and the
    /// model without it.
    best: Option<(Term, Real, Fitted)>,
}

/// The place of an addition, counted from the first one. `None` for the last one, which has just been
/// found necessary.
fn earlier_addition(model: &Model, given: usize, which: usize) -> Option<usize> {
    let terms = model.terms();
    let additions = numbered(terms.iter()).filter(|(_, term)| term.fitted);
    let (place, _) = additions.skip(given).nth(which)?;
    (place.saturating_add(1) < terms.len()).then_some(place)
}

impl Dropping {
    /// Begins, or returns `None` if the model has no earlier additions.
    pub(super) fn new(model: &Model, given: usize) -> Option<Self> {
        earlier_addition(model, given, 0)?;
        Some(Self {
            given,
            next: 0,
            trial: None,
            best: None,
        })
    }

    /// Does one piece of work, and returns whether all additions have been tried.
    #[inline(never)]
    pub(super) fn advance<const K: usize, const B: usize>(
        &mut self,
        observed: Observed<'_, K, B>,
        contest: &Contest,
        model: &Model,
        squares: &Vector,
        work: &mut Work<K, B>,
    ) -> bool {
        let Some((trial, candidate)) = &mut self.trial else {
            return self.begin_next(model, squares);
        };
        let Contest {
            score,
            tolerance,
            span,
        } = contest;
        let dropped = candidate.term;
        // No other model competes, so no round is hopeless.
        let completed = match trial.advance(observed, span, *tolerance, None, work, candidate) {
            Ok(None) => {
                candidate.term = dropped;
                return false;
            }
            Ok(completed) => completed,
            // An effect without which there is no fit is needed.
            Err(_) => None,
        };
        if let Some(completed) = completed {
            let improvement = completed.score - score - 2.0 * cost(dropped.effect);
            if self
                .best
                .as_ref()
                .is_none_or(|(_, least, _)| improvement < *least)
            {
                self.best = Some((dropped, improvement, completed.fitted));
            }
        }
        self.trial = None;
        false
    }

    fn begin_next(&mut self, model: &Model, squares: &Vector) -> bool {
        let Some(place) = earlier_addition(model, self.given, self.next) else {
            return true;
        };
        self.next = self.next.saturating_add(1);
        let without = Fitted::without(model, squares, place);
        if let (Ok(fitted), Some(&term)) = (without, model.terms().get(place)) {
            self.trial = Some((Trial::new(fitted), Candidate::of(term, None)));
        }
        false
    }

    /// The model without the effect that improves it by less than `threshold`, and that effect. `None`
    /// if all are needed.
    pub(super) fn dropped(&self, threshold: Real) -> Option<(Term, &Fitted)> {
        let (term, improvement, fitted) = self.best.as_ref()?;
        (*improvement < threshold).then_some((*term, fitted))
    }
}
