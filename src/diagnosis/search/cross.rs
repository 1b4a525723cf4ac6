//! The same additions behind every other filter.

use super::{
    hypothesis::{Added, Hypothesis},
    kind::has_frequency,
    refine::Solver,
    values::Values,
};
use crate::{list, numerics::real::Real, theory::model::Term};
use core::ops::ControlFlow;

/// Noise that is correlated over fewer samples imitates a filter, and so does a resonance of lower quality.
const FAST: Real = 30.0;
const BROAD: Real = 2.5;
/// The factors by which the first parameter of a filter is tried around the one with a given cut-off frequency.
const NEAR: [Real; 5] = [0.7, 0.85, 1.0, 1.2, 1.4];

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Hands additions behind each filter to `each`, which returns the score that others have to beat, beginning at its best shape in the continuum, or at the one with the
    /// cut-off frequency of the filter in the hypothesis that they come from. If they are all that it adds, its own filter
    /// is left out.
    pub(super) fn cross(
        &mut self,
        added: &Added,
        from: &Hypothesis,
        is_own: bool,
        each: &mut dyn FnMut(&Hypothesis) -> Real,
    ) -> ControlFlow<()> {
        let shapes = self.shapes.clone();
        let narrow = suspects(added, self.observation.interval_s);
        let is_narrow = is_own && from.filter.is_none() && narrow.len() == added.len();
        let cutoff_hz = from.filter.and_then(|filter| self.cutoff_hz(&filter));
        let filters = core::iter::once(None).chain(shapes.iter().copied().map(Some));
        for filter in filters {
            let begun = Hypothesis::new(filter, added.clone());
            let is_known = is_own && from.has_filter_of(&begun);
            if is_known || !begun.has_room(self.limits.effects) {
                continue;
            }
            let mut best = (begun, Real::INFINITY);
            if let Some(filter) = filter {
                let matched = cutoff_hz.and_then(|cutoff_hz| self.with_cutoff(&filter, cutoff_hz));
                let around = matched.into_iter().flat_map(|matched| {
                    NEAR.into_iter().map(move |factor| {
                        let mut near = matched;
                        near.scale_parameter(0, factor);
                        near
                    })
                });
                for shape in core::iter::once(filter).chain(around) {
                    let tried = Hypothesis::new(Some(shape), added.clone());
                    let deviance = self.deviance(&tried)?;
                    if deviance < best.1 {
                        best = (tried, deviance);
                    }
                }
            }
            let (begun, deviance) = best;
            // Narrow additions leave the continuum as it was, so that such a filter shows before all is refined.
            if is_narrow && deviance + 2.0 * begun.parameters() > from.score {
                continue;
            }
            let refined = self.refine(begun, 8)?;
            let bar = each(&refined);
            self.raise(&refined, bar);
        }
        ControlFlow::Continue(())
    }

    /// The lowest frequency at which a filter passes less than half of the white noise, in Hz.
    pub(super) fn cutoff_hz(&self, filter: &Term) -> Option<Real> {
        let white = self.white?;
        let (mut passed, mut all) = (Values::<B>::NONE, Values::<B>::NONE);
        self.observation.column(&white, Some(1.0), &mut all);
        self.observation.column(filter, Some(1.0), &mut passed);
        let rows = self.observation.rows();
        let below = rows.filter(|&row| passed[row] < 0.5 * all[row]);
        let frequencies = below.filter_map(|row| Some(self.observation.place(row)?.0));
        let lowest = frequencies.fold(Real::INFINITY, Real::min);
        lowest.is_finite().then_some(lowest)
    }

    /// A filter whose first parameter is changed so that it has this cut-off frequency.
    fn with_cutoff(&self, filter: &Term, cutoff_hz: Real) -> Option<Term> {
        let own_hz = self.cutoff_hz(filter)?;
        let mut matched = *filter;
        let range = matched.effect.search_range(0, &self.observation.span)?;
        // A time grows where a frequency falls.
        let ratio = if has_frequency(matched.effect) {
            cutoff_hz / own_hz
        } else {
            own_hz / cutoff_hz
        };
        let changed = matched.parameter(0) * ratio;
        matched.set_parameter(0, changed.max(range.low).min(range.high));
        Some(matched)
    }
}

/// The additions less those that a filter may imitate.
pub(super) fn suspects(added: &Added, interval_s: Real) -> Added {
    let is_kept = |term: &&crate::theory::model::Term| {
        if has_frequency(term.effect) {
            term.effect.parameters().len() < 2 || term.parameter(1) >= BROAD
        } else {
            term.parameter(0) >= FAST * interval_s
        }
    };
    list::fill(added.iter().filter(is_kept).copied())
}
