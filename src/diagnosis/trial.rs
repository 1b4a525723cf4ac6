//! A model with one more effect, fitted in full.

use super::{Candidate, scan::span};
use crate::{
    curve::Curve,
    effect::Span,
    error::Error,
    fit::{
        Problem,
        generalized::{Rounds, Solution},
        shape::{MAX_SHAPE, ShapeEquations},
    },
    math,
    model::Model,
    nnls::Vector,
    real::{Real, real, single},
    search::Found,
};
use heapless::Vec;

/// Rounds of fitting and polishing the shapes of a candidate.
const ROUNDS: usize = 10;
/// A change of `−2 ln L` that ends the rounds.
const SETTLED: Real = 0.5;
/// A lag of `−2 ln L` behind the best candidate that ends them too …
const HOPELESS: Real = 60.0;
/// … where a round makes up for less than this share of it.
const CATCHING_UP: Real = 0.25;

/// The longest step of a shape's logarithm.
const STRIDE: Real = 0.2;
/// Times that a step is halved because it led too far.
const HALVINGS: u32 = 4;

/// Changes of the logarithms of fitted shapes, by effect and parameter, in little room.
type Steps = Vec<(u8, u8, f32), MAX_SHAPE>;

/// A model with one more effect, and its squared coefficients.
#[derive(Clone, Debug)]
pub(super) struct Better {
    pub(super) model: Model,
    pub(super) squares: Vector,
}

impl Better {
    /// Of no effects yet.
    pub(super) fn empty() -> Self {
        Self {
            model: Model::default(),
            squares: Vector::zeros(),
        }
    }

    /// Becomes a model with an effect as a scan found it: in the place of what it replaces, or behind the
    /// others.
    pub(super) fn begin(&mut self, model: &Model, found: &Found) -> Result<(), Error> {
        self.model.clone_from(model);
        self.squares = found.squares;
        let replaced = found.term.effect.replaces();
        if let Some(place) = replaced.and_then(|effect| self.model.remove(effect.name())) {
            for i in place..self.model.terms().len() {
                let (one, other) = (self.squares[i], self.squares[i + 1]);
                self.squares.put(i, other);
                self.squares.put(i + 1, one);
            }
        }
        self.model.add(found.term)
    }

    /// Fits the model with its own covariance, and its shapes by the method of Gauss and Newton, until
    /// the score settles or lags behind the `best` so far without catching up. `None` where a
    /// coefficient has to be held at zero in every round.
    #[inline(never)]
    pub(super) fn fit<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        tolerance: Real,
        best: Real,
        candidate: &mut Candidate,
    ) -> Result<Option<Real>, Error> {
        let span = span(curve);
        let mut trial = self.clone();
        let mut tried = *candidate;
        let mut kept: Option<Real> = None;
        let mut before = Real::INFINITY;
        let mut steps = Steps::new();
        let mut halvings = 0_u32;
        for _ in 0..ROUNDS {
            let mut next = Steps::new();
            let Some(now) = trial.round(curve, tolerance, &mut next, &mut tried)? else {
                // Another model, with scores of its own.
                before = Real::INFINITY;
                continue;
            };
            let (gain, lag) = (before - now, now - best);
            if kept.is_none_or(|score| now < score) {
                kept = Some(now);
                *candidate = tried;
                self.clone_from(&trial);
            }
            if gain > -SETTLED {
                if gain < SETTLED || (lag > HOPELESS && gain < CATCHING_UP * lag) {
                    if kept == Some(now) {
                        self.go(&next, 1.0, &span);
                    }
                    break;
                }
                before = now;
                steps = next;
                trial.go(&steps, 1.0, &span);
            } else {
                // Too far: half the way back.
                halvings = halvings.saturating_add(1);
                if halvings > HALVINGS {
                    break;
                }
                for step in &mut steps {
                    step.2 *= 0.5;
                }
                trial.go(&steps, -1.0, &span);
            }
        }
        Ok(kept)
    }

    /// Changes shapes.
    fn go(&mut self, steps: &Steps, sign: Real, span: &Span) {
        for &(i, j, step) in steps {
            let (j, step) = (usize::from(j), real(step));
            let Some(term) = self.model.terms_mut().get_mut(usize::from(i)) else {
                continue;
            };
            let Some(range) = term.effect.search_range(j, span) else {
                continue;
            };
            let changed = term.parameter(j) * math::exp(sign * step);
            let highest = range.high.max(range.low);
            term.set_parameter(j, changed.max(range.low).min(highest));
        }
    }

    /// One round: the score, the candidate without its improvement, and how the shapes ought to change.
    /// `None` if a coefficient has to be held at zero first.
    #[inline(never)]
    fn round<const K: usize>(
        &mut self,
        curve: &Curve<K>,
        tolerance: Real,
        steps: &mut Steps,
        candidate: &mut Candidate,
    ) -> Result<Option<Real>, Error> {
        let problem = Problem::new(curve, &self.model);
        let mut solution = Solution::new(&problem);
        solution.converge(self.squares, tolerance, Rounds::One)?;
        self.squares = solution.squares;
        match judge(&problem, &solution, steps, candidate) {
            None => Ok(Some(solution.minus_two_log_likelihood())),
            Some(confused) => {
                if let Some(term) = self.model.terms_mut().get_mut(confused) {
                    term.held = true;
                }
                self.squares.put(confused, 0.0);
                Ok(None)
            }
        }
    }
}

/// The candidate as it was fitted and how the shapes ought to change, or the effect that has to be held
/// at zero for them to be determined.
#[inline(never)]
fn judge<const K: usize>(
    problem: &Problem<'_, K>,
    solution: &Solution<'_, '_, K>,
    steps: &mut Steps,
    candidate: &mut Candidate,
) -> Option<usize> {
    let mut shape = ShapeEquations::empty();
    let told = shape.set(problem, &solution.weights, &solution.squares);
    if told {
        if let Some(confused) = solution.confused(&shape) {
            return Some(confused);
        }
        shape.steps(&solution.free, |i, j, step| {
            // As many as fitted shapes.
            let _ = steps.push((i as u8, j as u8, single(step.clamp(-STRIDE, STRIDE))));
        });
    }
    if let Some((last, others)) = problem.model.terms().split_last() {
        candidate.term = *last;
        candidate.coefficient =
            math::sqrt(solution.squares[others.len()].max(0.0) * problem.variance_unit);
    }
    candidate.chi_squared = solution.chi_squared;
    None
}
