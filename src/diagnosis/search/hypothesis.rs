//! A hypothesis: what the white noise went through, and what adds to it.

use super::{
    kind::{continuous, is_filter},
    price::price,
    rows::Observation,
    variant::Variant,
};
use crate::{
    limits::{MAX_EFFECTS, MAX_SHAPE},
    list,
    numerics::real::{Real, real},
    theory::model::Term,
};
use heapless::Vec;

/// The largest number of effects in addition to a filter.
pub(crate) const MAX_ADDED: usize = 3;

/// A hypothesis of as many effects whose score is less than this above that of the best one is as good.
pub(super) const AS_GOOD: Real = 2.0;

/// The effects in addition to a filter.
pub(crate) type Added = Vec<Term, MAX_ADDED>;

/// A story of the whole record. The terms that every hypothesis has, such as flicker noise, are not repeated in it.
#[derive(Clone, Debug)]
pub(crate) struct Hypothesis {
    /// What the white noise went through; `None` if it went through nothing.
    pub(crate) filter: Option<Term>,
    /// What adds to it.
    pub(crate) added: Added,
    /// The squared coefficients in units of their columns: the common terms, the white noise, what was added.
    pub(super) squares: [f32; MAX_EFFECTS],
    /// `−2 ln L` plus two for each parameter.
    pub(crate) score: Real,
    /// The score plus the price of each effect.
    pub(crate) cost: Real,
}

impl Hypothesis {
    /// A hypothesis that has not been solved.
    pub(super) fn new(filter: Option<Term>, added: Added) -> Self {
        Self {
            filter,
            added,
            squares: [0.0; MAX_EFFECTS],
            score: Real::INFINITY,
            cost: Real::INFINITY,
        }
    }

    /// The same with one more effect. `None` if there is no room for it or for its shapes.
    pub(super) fn with(&self, term: Term, most: usize) -> Option<Self> {
        let mut added = self.added.clone();
        added.push(term).ok()?;
        let more = Self {
            added,
            ..self.clone()
        };
        more.has_room(most).then_some(more)
    }

    /// Whether a fit has room for all shapes, and there are no more effects than `most`.
    pub(super) fn has_room(&self, most: usize) -> bool {
        let shapes = self
            .terms()
            .map(|term| list::count(term.fitted_parameters()));
        shapes.fold(0_usize, |sum, one| sum.saturating_add(one)) <= MAX_SHAPE
            && list::count(self.terms()) <= most
    }

    /// The filter, if there is one, and what adds to it.
    pub(crate) fn terms(&self) -> impl Iterator<Item = &Term> {
        self.filter.iter().chain(&self.added)
    }

    /// The number of parameters beyond the model without filter and additions.
    pub(super) fn parameters(&self) -> Real {
        let shapes = self.terms().map(|term| continuous(term.effect));
        let shapes = shapes.fold(0_u32, u32::saturating_add);
        real(shapes) + real(self.added.len() as u32)
    }

    /// Sets score and cost from `−2 ln L`.
    pub(super) fn judge<const B: usize>(
        &mut self,
        deviance: Real,
        observation: &Observation<'_, B>,
        threshold: Real,
    ) {
        self.score = deviance + 2.0 * self.parameters();
        let prices = self.terms().map(|term| {
            price(
                term,
                observation.interval_s,
                threshold,
                observation.has_bins(),
            )
        });
        let surcharge = observation.surcharge() * real(list::count(self.terms()) as u32);
        self.cost = self.score + prices.sum::<Real>() + surcharge;
    }

    /// Whether both have filters of the same variant, or none.
    pub(super) fn has_filter_of(&self, other: &Self) -> bool {
        match (&self.filter, &other.filter) {
            (Some(one), Some(other)) => Variant::of_term(one).is(&Variant::of_term(other)),
            (None, None) => true,
            _ => false,
        }
    }

    /// Whether both add the same kinds of effects.
    pub(super) fn adds_like(&self, other: &Self) -> bool {
        is_permutation(&self.added, &other.added)
    }

    /// Whether both have the same kinds of effects.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.has_filter_of(other) && self.adds_like(other)
    }

    /// Whether the other hypothesis has the special cases of the effects in which the two differ, so that the data do not
    /// tell the two apart.
    pub(super) fn is_general_form_of(&self, other: &Self) -> bool {
        let special = |term: &Term| {
            let special = term.effect.description().special_case?;
            (is_filter(special) == is_filter(term.effect)).then(|| special.name())
        };
        let times = |terms: &Self, name: &str| {
            list::count(terms.terms().filter(|term| term.effect.name() == name))
        };
        let mut differs = false;
        for term in self.terms() {
            let name = term.effect.name();
            if times(self, name) <= times(other, name) {
                continue;
            }
            differs = true;
            let is_special =
                special(term).is_some_and(|special| times(other, special) > times(self, special));
            if !is_special {
                return false;
            }
        }
        differs && list::count(self.terms()) == list::count(other.terms())
    }

    /// Whether both are called by the same names.
    pub(crate) fn is_named_like(&self, other: &Self) -> bool {
        let name = |one: &Self| one.filter.as_ref().map(|filter| filter.effect.name());
        name(self) == name(other) && self.adds_like(other)
    }
}

/// Whether two lists of terms have the same effects, each as often.
fn is_permutation(one: &[Term], other: &[Term]) -> bool {
    let times = |list: &[Term], name: &str| {
        list::count(list.iter().filter(|term| term.effect.name() == name))
    };
    one.len() == other.len()
        && one.iter().all(|term| {
            let name = term.effect.name();
            times(one, name) == times(other, name)
        })
}

/// Whether two lists of terms have the same effects at nearly the same frequencies or times.
pub(super) fn is_near(one: &[Term], other: &[Term]) -> bool {
    let near = |a: &Term, b: &Term| {
        let ratio = a.parameter(0) / b.parameter(0);
        a.effect.name() == b.effect.name() && ratio > 1.0 / NEAR && ratio < NEAR
    };
    is_permutation(one, other) && one.iter().all(|a| other.iter().any(|b| near(a, b)))
}

/// The factor between first parameters that are nearly the same.
const NEAR: Real = 1.15;
