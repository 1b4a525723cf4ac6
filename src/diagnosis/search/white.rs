//! What the white noise is in the hypotheses that explain a record as well as the best one.

use super::{
    hypothesis::Hypothesis,
    kind::is_filter,
    refine::Solver,
    run::{AS_GOOD, Found},
    variant::Variant,
};
use crate::{model::Term, real::Real};
use core::ops::ControlFlow;

/// The rounds of refinement of an exchange, which begins next to its place.
const ROUNDS: u8 = 4;

/// The least and the largest coefficient of the white noise, in front of what it went through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WhiteRange {
    pub(crate) least: Real,
    pub(crate) largest: Real,
}

impl WhiteRange {
    /// Lets the range hold a coefficient. A hypothesis without white noise says nothing about it.
    fn hold(&mut self, coefficient: Real) {
        if coefficient > 0.0 && coefficient.is_finite() {
            self.least = self.least.min(coefficient);
            self.largest = self.largest.max(coefficient);
        }
    }
}

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// The range over what was found. `None` if no hypothesis has white noise.
    pub(super) fn range_of_white(&mut self, found: &Found) -> ControlFlow<(), Option<WhiteRange>> {
        let mut range = WhiteRange {
            least: Real::INFINITY,
            largest: 0.0,
        };
        range.hold(self.white_of(&found.best));
        for (other, _) in &found.alternatives {
            (self.pause)()?;
            range.hold(self.white_of(other));
        }
        for place in 0..found.best.added.len() {
            let Some(exchanged) = exchanged(&found.best, place) else {
                continue;
            };
            let refined = self.refine(exchanged, ROUNDS)?;
            if refined.score < found.best.score + AS_GOOD {
                range.hold(self.white_of(&refined));
            }
        }
        ControlFlow::Continue((range.largest > 0.0).then_some(range))
    }

    /// The coefficient of the white noise of a hypothesis.
    fn white_of(&mut self, hypothesis: &Hypothesis) -> Real {
        let Some(term) = hypothesis.filter.or(self.white) else {
            return 0.0;
        };
        let mut column = super::values::Values::<B>::NONE;
        let factor = self.observation.column(&term, None, &mut column);
        let square = hypothesis.squares.get(self.work.common());
        let square = square.map_or(0.0, |&square| Real::from(square));
        crate::math::sqrt((square * factor).max(0.0))
    }
}

/// The hypothesis in which a filter of one pole and noise with the spectrum of such a filter exchange their times. Both
/// densities are those of a Lorentzian, so that either of them may be the white noise.
fn exchanged(hypothesis: &Hypothesis, place: usize) -> Option<Hypothesis> {
    let filter = hypothesis.filter?;
    let noise = *hypothesis.added.get(place)?;
    let is_lorentzian = |term: &Term| {
        let special = term.effect.description().special_case;
        special.is_some_and(is_filter)
    };
    if Variant::of_term(&filter).whole != 1 || !is_lorentzian(&noise) {
        return None;
    }
    let mut other = Hypothesis::new(Some(filter), hypothesis.added.clone());
    other.filter.as_mut()?.set_parameter(0, noise.parameter(0));
    other
        .added
        .get_mut(place)?
        .set_parameter(0, filter.parameter(0));
    Some(other)
}
