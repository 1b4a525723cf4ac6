//! The same additions behind every other filter.

use super::{hypothesis::{Added, Hypothesis}, price::has_frequency, refine::Solver};
use crate::{list, real::Real};
use core::ops::ControlFlow;

/// Noise that is correlated over fewer samples imitates a filter, and so does a resonance of lower quality.
const FAST: Real = 30.0;
const BROAD: Real = 2.5;

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// Hands the additions of a hypothesis behind each filter but its own to `each`.
    pub(super) fn cross(
        &mut self,
        added: &Added,
        own: Option<&Hypothesis>,
        each: &mut dyn FnMut(&Hypothesis),
    ) -> ControlFlow<()> {
        let shapes = self.shapes.clone();
        let filters = core::iter::once(None).chain(shapes.into_iter().map(Some));
        for filter in filters {
            let begun = Hypothesis::new(filter, added.clone());
            let is_own = own.is_some_and(|own| own.has_filter_of(&begun));
            if !is_own && begun.has_room(self.limits.effects) {
                let refined = self.refine(begun, 8)?;
                each(&refined);
            }
        }
        ControlFlow::Continue(())
    }
}

/// The additions less those that a filter may imitate.
pub(super) fn suspects(added: &Added, interval_s: Real) -> Added {
    let is_kept = |term: &&crate::model::Term| {
        if has_frequency(term.effect) {
            term.effect.parameters().len() < 2 || term.parameter(1) >= BROAD
        } else {
            term.parameter(0) >= FAST * interval_s
        }
    };
    list::fill(added.iter().filter(is_kept).copied())
}
