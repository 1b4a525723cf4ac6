//! The kinds of an effect: one for each whole number that a shape parameter takes, such as the poles of a filter.

use super::rows::Observation;
use crate::{
    limits::MAX_PARAMETERS,
    numerics::{
        math,
        real::{Real, real},
    },
    theory::{
        effect::{DecimationFilter, Effect, SearchRange, Span},
        model::Term,
    },
};

/// Means over so many times the number of samples are tried.
const NEARLY_LOW: Real = 0.7;
const NEARLY_HIGH: Real = 1.4;

/// An effect, with its whole number if it has one.
#[derive(Clone, Copy)]
pub(super) struct Variant {
    pub(super) effect: &'static dyn Effect,
    /// The whole number, or 0.
    pub(super) whole: u8,
}

impl Variant {
    /// The variants of an effect, one after the other.
    pub(super) fn of(
        effect: &'static dyn Effect,
        observation_span: &Span,
    ) -> impl Iterator<Item = Self> {
        let whole = (0..MAX_PARAMETERS).find(|&j| effect.is_whole(j));
        let range = whole.and_then(|j| effect.search_range(j, observation_span));
        let (low, high) = range.map_or((0, 0), |range| (range.low as u8, range.high as u8));
        (low..=high).map(move |whole| Self { effect, whole })
    }

    /// The variant of a term.
    pub(super) fn of_term(term: &Term) -> Self {
        let whole = (0..MAX_PARAMETERS).find(|&j| term.effect.is_whole(j));
        Self {
            effect: term.effect,
            whole: whole.map_or(0, |j| (term.parameter(j) + 0.5) as u8),
        }
    }

    /// The filters of the list that all noise passes and that are like one that the white noise alone passes: the effect
    /// that has this one as its special case, at the same shape. Like a filter of one stage are means over nearly as many
    /// samples.
    pub(super) fn passing(
        effects: &[&'static dyn Effect],
        filter: &Term,
        interval_s: Real,
    ) -> impl Iterator<Item = Term> {
        let is_general = |effect: &&'static dyn Effect| {
            let special = effect.description().special_case;
            let is_special = special.is_some_and(|s| s.name() == filter.effect.name());
            effect.passes_all() && is_special && !effect.is_whole(0)
        };
        let general = effects.iter().copied().find(is_general);
        let parameters = filter.parameters;
        let same = general.map(|effect| {
            let mut term = Term::fitted(effect);
            term.parameters = parameters;
            term
        });
        let is_mean = filter.effect.name() == DecimationFilter.description().name
            && Self::of_term(filter).whole < 2;
        let samples = if is_mean {
            filter.parameter(0) / interval_s
        } else {
            0.0
        };
        same.into_iter().chain(Self::means(effects, samples))
    }

    /// The means of the list over nearly this number of samples, which all noise passes.
    pub(super) fn means(
        effects: &[&'static dyn Effect],
        samples: Real,
    ) -> impl Iterator<Item = Term> {
        let (low, high) = (
            math::floor(NEARLY_LOW * samples),
            math::ceil(NEARLY_HIGH * samples),
        );
        let counted = |effect: &&'static dyn Effect| effect.passes_all() && effect.is_whole(0);
        let counted = effects.iter().copied().filter(counted);
        counted.flat_map(move |effect| {
            let parameter = effect.parameters().first();
            let span = Span {
                interval_s: 1.0,
                longest_tau_s: high,
            };
            let range = parameter.map(|parameter| (parameter.search_range)(&span));
            let (least, most) = range.map_or((1.0, 0.0), |range| (range.low, range.high));
            let (first, last) = (low.max(least) as u32, high.min(most) as u32);
            (first..=last).map(move |count| {
                let mut term = Term::fitted(effect);
                term.set_parameter(0, real(count));
                term
            })
        })
    }

    /// Whether two variants are the same.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.effect.name() == other.effect.name() && self.whole == other.whole
    }

    /// The term with these numbers for the parameters that are not whole.
    fn term(&self, numbers: [Real; MAX_PARAMETERS]) -> Term {
        let mut term = Term::fitted(self.effect);
        let mut numbers = numbers.into_iter();
        for j in 0..self.effect.parameters().len().min(MAX_PARAMETERS) {
            let number = if self.effect.is_whole(j) {
                real(u32::from(self.whole))
            } else {
                numbers.next().unwrap_or(0.0)
            };
            term.set_parameter(j, number);
        }
        term
    }

    /// The shapes of a grid: `per_octave` values of the first parameter for each factor of two, and at most `others`
    /// values of each other one.
    pub(super) fn grid<const B: usize>(
        self,
        observation: &Observation<'_, B>,
        per_octave: Real,
        others: u32,
    ) -> Grid {
        let mut axes = [Axis::SINGLE; MAX_PARAMETERS];
        let mut places = axes.iter_mut();
        let mut is_first = true;
        for j in 0..self.effect.parameters().len().min(MAX_PARAMETERS) {
            if self.effect.is_whole(j) {
                continue;
            }
            if let (Some(range), Some(axis)) = (
                self.effect.search_range(j, &observation.span),
                places.next(),
            ) {
                *axis = Axis::new(
                    &range,
                    if is_first { Some(per_octave) } else { None },
                    others,
                );
                is_first = false;
            }
        }
        Grid {
            variant: self,
            axes,
            interval_s: observation.interval_s,
        }
    }
}

/// A range of less than an octave or two, such as that of an exponent, has this many values. Between two whole exponents of
/// other terms lie two or three, so that no mixture of these hides them all.
const FEWEST: u32 = 7;

/// The values of one parameter, from a low one on, each by a factor higher than the one before.
#[derive(Clone, Copy)]
struct Axis {
    low: Real,
    factor: Real,
    count: u32,
}

impl Axis {
    const SINGLE: Self = Self {
        low: 0.0,
        factor: 1.0,
        count: 1,
    };

    fn new(range: &SearchRange, per_octave: Option<Real>, most: u32) -> Self {
        let octaves = (math::log(range.high.max(range.low) / range.low)).max(0.0)
            / real(core::f64::consts::LN_2);
        let count = match per_octave {
            Some(per_octave) => (math::ceil(octaves * per_octave) as u32)
                .saturating_add(1)
                .max(FEWEST),
            None => most.min((math::ceil(octaves) as u32).saturating_add(1)),
        };
        let step = if count > 1 {
            octaves / real(count.saturating_sub(1))
        } else {
            0.0
        };
        Self {
            low: range.low,
            factor: math::exp(step * real(core::f64::consts::LN_2)),
            count,
        }
    }

    fn at(&self, place: u32) -> Real {
        let mut value = self.low;
        for _ in 0..place {
            value *= self.factor;
        }
        value
    }
}

/// Shapes of a variant.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    variant: Variant,
    axes: [Axis; MAX_PARAMETERS],
    interval_s: Real,
}

impl Grid {
    /// The terms of the grid.
    pub(super) fn terms(&self) -> impl Iterator<Item = Term> + use<> {
        let grid = *self;
        let count = grid
            .axes
            .iter()
            .fold(1_u32, |n, axis| n.saturating_mul(axis.count));
        (0..count).map(move |place| {
            let mut rest = place;
            let mut term = grid.variant.term(grid.axes.map(|axis| {
                let value = axis.at(rest % axis.count.max(1));
                rest /= axis.count.max(1);
                value
            }));
            term.make_distinct(grid.interval_s);
            term
        })
    }
}
