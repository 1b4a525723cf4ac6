//! The search for a lower minimum beside a known one.

use super::{
    evaluations_a_call,
    likelihood::{Evaluation, Found, Profile},
};
use crate::real::Real;
use crate::{
    effect::Span,
    fit::{Problem, Solver},
    math,
    model::Term,
    real::real,
};

/// The largest distance that is tried, as a difference of logarithms. It spans four steps of the grid of
/// frequencies to either side: with two, one of 600 strong lines stayed in a wrong minimum.
const WIDEST: Real = 0.12;
/// How much closer each distance is than the one before, as a difference of logarithms.
const CLOSER: Real = 0.2;
/// The number of shapes that are tried. The closest ones lie a 3000th of the widest distance away.
const SHAPES: u32 = 80;

/// A search around the shape of a model's last effect. Shapes are tried on both sides, at distances that
/// shrink in equal ratios. Where an effect oscillates, χ² has many minima. They lie the closer together
/// the longer the octaves are that show the effect, and the method of Gauss and Newton leaves none of them.
pub(crate) struct Neighbourhood {
    tried: u32,
    best: Found,
}

impl Neighbourhood {
    /// Begins around the shape of this effect.
    pub(crate) const fn new(term: Term) -> Self {
        Self {
            tried: 0,
            best: Found::none(term),
        }
    }

    /// Does some evaluations beside a solved model. When no more are to do, returns the best shape, whose
    /// χ² is infinite if none can be fitted.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        span: &Span,
    ) -> Option<Found> {
        let Some((term, others)) = problem.model.terms().split_last() else {
            return Some(self.best);
        };
        let Some(j) = term.fitted_parameters().next() else {
            return Some(self.best);
        };
        let Some(range) = term.effect.search_range(j, span) else {
            return Some(self.best);
        };
        let mut profile = Profile::EMPTY;
        profile.begin(problem, &solver.weights);
        let chosen = profile.choose(problem, others.len(), &solver.squares);
        if chosen.is_err() || self.tried >= SHAPES {
            return Some(self.best);
        }
        let mut evaluation = Evaluation::new(&mut profile, problem, &solver.weights);
        for _ in 0..evaluations_a_call(B) {
            let distance = WIDEST * math::exp(-CLOSER * real(self.tried / 2));
            let sign = if self.tried.is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            let value = term.parameter(j) * math::exp(sign * distance);
            let mut shape = *term;
            shape.set_parameter(j, value.max(range.low).min(range.high.max(range.low)));
            self.best.improve(evaluation.found(shape));
            self.tried = self.tried.saturating_add(1);
        }
        None
    }
}
