//! What the white noise is in the hypotheses that explain a record as well as the best one.

use super::{
    hypothesis::{AS_GOOD, Hypothesis},
    kind::is_filter,
    refine::Solver,
    variant::Variant,
};
use crate::{
    limits::{MAX_SHAPE, TWO_SIDED_95},
    list,
    numerics::{
        math,
        nnls::PassiveSet,
        real::{Real, real},
    },
    theory::model::Term,
};
use core::ops::ControlFlow;
use heapless::Vec;

/// The rounds of refinement of an exchange, which begins next to its place.
const ROUNDS: u8 = 4;

/// The interval that holds the 95 % intervals of the white noise's coefficient, in front of what it went through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WhiteRange {
    pub(crate) lower: Real,
    pub(crate) upper: Real,
}

impl<const B: usize> Solver<'_, '_, '_, B> {
    /// The range over the alternatives to the best hypothesis. `None` if there are none with white noise.
    pub(super) fn range_of_white(
        &mut self,
        best: &Hypothesis,
        alternatives: &[(Hypothesis, Real)],
    ) -> ControlFlow<(), Option<WhiteRange>> {
        let mut range: Option<WhiteRange> = None;
        for (other, _) in alternatives {
            self.hold_white_of(other, &mut range)?;
        }
        for place in 0..best.added.len() {
            let Some(exchanged) = exchanged(best, place) else {
                continue;
            };
            let refined = self.refine(exchanged, ROUNDS)?;
            if refined.score < best.score + AS_GOOD {
                self.hold_white_of(&refined, &mut range)?;
            }
        }
        ControlFlow::Continue(range)
    }

    /// Lets a range hold the interval of the white noise in a hypothesis, whose shapes are as uncertain as its coefficients.
    /// A hypothesis without white noise says nothing about it.
    #[inline(never)]
    fn hold_white_of(
        &mut self,
        hypothesis: &Hypothesis,
        range: &mut Option<WhiteRange>,
    ) -> ControlFlow<()> {
        (self.pause)()?;
        self.load(hypothesis)?;
        let place = self.work.common();
        let square = self.work.squares[place];
        let per_column = self.work.factor(0);
        if hypothesis.filter.or(self.white).is_none() || square <= 0.0 || per_column <= 0.0 {
            return ControlFlow::Continue(());
        }
        let terms = self.own_terms(hypothesis);
        self.work.set_shapes(self.observation, &terms, self.pause)?;
        (self.pause)()?;
        let shift: Vec<Real, MAX_SHAPE> = list::fill(self.work.slopes.iter().map(|_| 0.0));
        let count = self.work.count();
        let slopes = count..count.saturating_add(shift.len());
        let free =
            PassiveSet::of(|i| slopes.contains(&i) || (i < count && self.work.squares[i] > 0.0));
        let variance = if self.work.set_equations(None, &shift, 0.0) {
            self.work.equations.variance(place, &free)
        } else {
            None
        };
        let reach = real(TWO_SIDED_95) * math::sqrt(variance.unwrap_or(0.0).max(0.0));
        let root = |square: Real| math::sqrt(square.max(0.0) * per_column);
        let (lower, upper) = (root(square - reach), root(square + reach));
        let known = range.get_or_insert(WhiteRange { lower, upper });
        known.lower = known.lower.min(lower);
        known.upper = known.upper.max(upper);
        ControlFlow::Continue(())
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
