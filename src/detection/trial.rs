//! The search for the limit of one shape.

use super::{
    expected::{Ground, Standing},
    limit::{Limit, keeps_coefficient},
};
use crate::{
    effect::Effect,
    math,
    model::Term,
    nnls::Vector,
    real::Real,
};

/// The largest number of steps towards the limit.
const STEPS: u8 = 12;
/// The steps end when root and needed root agree to this share, so that the limit of a coefficient is known
/// to half of it.
const AGREES: Real = 0.01;
/// The effect with which the search begins is at most this share of the curve in every octave.
const FIRST: Real = 0.1;
/// How far a coefficient is tried beyond the largest one that is informative. A larger limit is none.
const BEYOND: Real = 1.5;

/// The search for the limit of one shape, in progress. One step takes a fit to an expected curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    term: Term,
    /// The logarithms of sizes that are known to be too small and large enough.
    low: Real,
    high: Real,
    /// The logarithm of the size that is tried next.
    next: Real,
    step: u8,
    /// Whether a size that is large enough has been seen.
    is_bounded: bool,
}

/// What a step of the search found.
pub(super) enum Progress {
    Searching,
    /// There is no limit: the effect hides in the model at any size that the curve allows.
    Hidden,
    Found(Limit),
}

impl Trial {
    /// Begins with a shape. `range` is the range of the first shape parameter.
    pub(super) fn new<const K: usize>(
        ground: &Ground<'_, K>,
        term: Term,
        range: (Real, Real),
    ) -> Self {
        let (low, high, next) = if keeps_coefficient(term.effect) {
            let (low, high) = (math::log(range.0), math::log(range.1));
            (low, high, high)
        } else {
            let most = math::log(informative(ground, &term));
            (most - 30.0, most + math::log(BEYOND), most + math::log(FIRST))
        };
        Self {
            term,
            low,
            high,
            next,
            step: 0,
            is_bounded: false,
        }
    }

    /// Does one step.
    #[inline(never)]
    pub(super) fn advance<const K: usize>(
        &mut self,
        ground: &Ground<'_, K>,
        squares: &Vector,
        gain: Real,
    ) -> Progress {
        let size = math::exp(self.next);
        if keeps_coefficient(self.term.effect) {
            self.term.set_parameter(0, size);
        }
        let Some(standing) = standing(ground, squares, &self.term, size, gain) else {
            return Progress::Hidden;
        };
        self.step = self.step.saturating_add(1);
        let shows = standing.root >= standing.needed;
        if shows {
            self.high = self.next;
            self.is_bounded = true;
        } else {
            self.low = self.next;
        }
        let distance = math::log(standing.needed / standing.root);
        let agrees = distance.abs() < AGREES;
        if keeps_coefficient(self.term.effect) {
            if !self.is_bounded {
                return Progress::Hidden;
            }
            if agrees || self.step >= STEPS || self.high - self.low < AGREES {
                return self.found(ground, squares);
            }
            self.next = 0.5 * (self.low + self.high);
            return Progress::Searching;
        }
        if agrees {
            return self.found(ground, squares);
        }
        if self.step >= STEPS {
            return Progress::Hidden;
        }
        // The root is nearly proportional to the square of the coefficient.
        let guess = self.next + distance;
        if !self.is_bounded && guess >= self.high {
            if self.next >= self.high {
                return Progress::Hidden;
            }
            self.next = self.high;
        } else if self.low < guess && guess < self.high {
            self.next = guess;
        } else {
            self.next = 0.5 * (self.low + self.high);
        }
        Progress::Searching
    }

    fn found<const K: usize>(&self, ground: &Ground<'_, K>, squares: &Vector) -> Progress {
        let unit = ground.problem.variance_unit;
        if let Some(place) = replaced(ground, self.term.effect).filter(|_| keeps_coefficient(self.term.effect)) {
            let mut term = self.term;
            term.set_parameter(0, math::exp(self.high));
            return Progress::Found(Limit {
                term,
                coefficient: math::sqrt(squares[place] * unit),
            });
        }
        let square = math::exp(self.next);
        if square >= informative(ground, &self.term) {
            return Progress::Hidden;
        }
        Progress::Found(Limit {
            term: self.term,
            coefficient: math::sqrt(square * unit),
        })
    }
}

/// The largest square with which an effect does not exceed the model in any octave.
fn informative<const K: usize>(ground: &Ground<'_, K>, term: &Term) -> Real {
    let column = ground.problem.column(term);
    let octaves = 0..ground.problem.points.len().min(K);
    octaves
        .map(|k| ground.weights.model[k] / column[k])
        .fold(Real::INFINITY, Real::min)
}

/// The place of the effect that this one replaces.
fn replaced<const K: usize>(ground: &Ground<'_, K>, effect: &dyn Effect) -> Option<usize> {
    ground.problem.model.position(effect.replaces()?.name())
}

/// The standing of an effect: of a coefficient with the square `size`, or of a shape with the coefficient that
/// the replaced effect has.
#[inline(never)]
fn standing<const K: usize>(
    ground: &Ground<'_, K>,
    squares: &Vector,
    term: &Term,
    size: Real,
    gain: Real,
) -> Option<Standing> {
    let problem = ground.problem;
    let column = problem.column(term);
    let place = replaced(ground, term.effect);
    let square = match place {
        Some(place) if keeps_coefficient(term.effect) => squares[place],
        _ => size,
    };
    let taken = |k: usize| place.map_or(0.0, |place| problem.unit(place, k) * squares[place]);
    let model = &ground.weights.model;
    let expected = |k: usize| model[k] - taken(k) + square * column[k];
    // A deterministic effect g scatters a curve only where random effects c beat against it: the
    // covariance is that of (c + g)² − g².
    let shape = term.sampled_shape(problem.interval_s);
    let is_random = term.effect.response(1.0, &shape).is_none();
    let scatter = |k: usize| {
        if is_random {
            expected(k)
        } else {
            math::sqrt(model[k] * (model[k] + 2.0 * square * column[k]))
        }
    };
    let positive = (0..problem.points.len()).all(|k| expected(k) > 0.0);
    positive
        .then(|| ground.standing(&expected, &scatter, gain))
        .flatten()
}
