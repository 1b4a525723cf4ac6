//! Generalised least squares: octaves weighted by the covariance of the curve.

use super::{Fit, Method, Problem, independent, shape::ShapeEquations, squared, weights::Weights};
use crate::{
    algebra,
    chi_squared::chi_squared_tail,
    coefficient::{Coefficient, State},
    curve::clusters,
    effect::Span,
    error::Error,
    list::numbered,
    math,
    model::Term,
    nnls::{Free, NormalEquations, Vector},
    observability::record_length_s,
    real::{Real, real},
    search::Search,
};

/// Rounds of covariance and solution; two to four bring the model to within 0.1 %, hardly ever more
/// than eight.
const ROUNDS: usize = 8;
/// A p-value that no further round makes plausible.
const HOPELESS: Real = 1e-6;
/// A change of the model that ends the rounds.
const CONVERGED: Real = 3e-3;
/// Below this p-value the curve's scatter does not explain the misfit, and the model is granted
/// its tolerance.
const UNEXPLAINED: Real = 0.05;
/// A shape parameter with a larger standard error of its logarithm is not determined.
const UNDETERMINED: Real = 0.3;
/// Rounds of a bound and the covariance that it implies.
const BOUND_ROUNDS: usize = 2;

/// How long to alternate covariance and solution.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rounds {
    /// Once: for a caller that comes again.
    One,
    /// Until they agree, or the first says that no tolerance-free fit explains the curve.
    Promising,
    /// Until they agree.
    All,
}

/// Squared coefficients, and the covariance that they were found with.
pub(crate) struct Solution<'a, 'b, const K: usize> {
    problem: &'a Problem<'b, K>,
    pub(crate) weights: Weights<K>,
    equations: NormalEquations,
    pub(crate) squares: Vector,
    pub(crate) free: Free,
    pub(crate) chi_squared: Real,
}

impl<'a, 'b, const K: usize> Solution<'a, 'b, K> {
    /// None yet.
    pub(crate) fn new(problem: &'a Problem<'b, K>) -> Self {
        Self {
            problem,
            weights: Weights::empty(),
            equations: NormalEquations::empty(),
            squares: Vector::zeros(),
            free: Free::default(),
            chi_squared: Real::NAN,
        }
    }

    /// Finds it, with the model's tolerance where the curve needs it.
    pub(crate) fn solve(&mut self, tolerance: Real) -> Result<(), Error> {
        let problem = self.problem;
        let weight = independent::by_relative_accuracy;
        independent::equations(problem, weight, &mut self.equations)?;
        let (start, _) = self.equations.solve_non_negative(&problem.held());
        let granted = tolerance > 0.0;
        self.converge(
            start,
            0.0,
            if granted {
                Rounds::Promising
            } else {
                Rounds::All
            },
        )?;
        if self.p_value() < UNEXPLAINED && granted {
            self.converge(self.squares, tolerance, Rounds::All)?;
        }
        Ok(())
    }

    /// Alternates covariance and solution.
    #[inline(never)]
    pub(crate) fn converge(
        &mut self,
        start: Vector,
        tolerance: Real,
        rounds: Rounds,
    ) -> Result<(), Error> {
        let problem = self.problem;
        let curve = |k: usize| problem.measured(k);
        // The squares that the covariance is taken at approach those that it gives.
        let mut assumed = start;
        let mut last: Option<algebra::Vector<K>> = None;
        let mut step: Real = 1.0;
        let mut round = 1_usize;
        loop {
            self.weights.set(problem, &assumed, tolerance)?;
            let (weights, equations) = (&self.weights, &mut self.equations);
            weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
            (self.squares, self.free) = self.equations.solve_non_negative(&problem.held());
            let change = algebra::Vector::<K>::from_fn(|k| {
                if k < problem.points.len() {
                    problem.variance(k, &self.squares) / self.weights.model[k] - 1.0
                } else {
                    0.0
                }
            });
            let last_round = change.amax() < CONVERGED
                || match rounds {
                    Rounds::One => true,
                    Rounds::Promising if round == 1 => {
                        self.chi_squared = self.weights.chi_squared(problem, &self.squares);
                        self.p_value() < HOPELESS
                    }
                    _ => round >= ROUNDS,
                };
            if last_round {
                self.chi_squared = self.weights.chi_squared(problem, &self.squares);
                return Ok(());
            }
            if let Some(last) = last {
                // Rounds that swing to and fro, or creep, have a ratio: go where it leads (Aitken).
                let ratio = change.dot(&last) / last.norm_squared();
                step = (step / (1.0 - ratio.min(0.5))).clamp(0.3, 2.0);
            }
            last = Some(change);
            let next = *assumed + (*self.squares - *assumed) * step;
            assumed = next.map(|square| square.max(0.0)).into();
            round = round.saturating_add(1);
        }
    }

    fn degrees_of_freedom(&self) -> usize {
        let terms = numbered(self.problem.model.terms().iter());
        let active = terms.filter(|&(i, _)| self.free.has(i));
        let octaves = self.problem.points.len();
        active.fold(octaves, |rest, (_, term)| {
            let shapes = term.fitted_parameters();
            shapes.fold(rest.saturating_sub(1), |rest, _| rest.saturating_sub(1))
        })
    }

    pub(crate) fn p_value(&self) -> Real {
        chi_squared_tail(self.chi_squared, self.degrees_of_freedom())
    }

    pub(crate) fn minus_two_log_likelihood(&self) -> Real {
        self.chi_squared + self.weights.log_determinant
    }

    /// An active effect that a fitted shape could take the place of: held at zero, it leaves the
    /// shape determined.
    pub(crate) fn confused(&self, shape: &ShapeEquations) -> Option<usize> {
        let before = shape.worst_error(&self.free);
        if before < UNDETERMINED {
            return None;
        }
        let terms = numbered(self.problem.model.terms().iter());
        terms
            .filter(|&(i, term)| self.free.has(i) && term.effect.parameters().is_empty())
            .map(|(i, _)| {
                let mut without = self.free;
                without.drop(i);
                (i, shape.worst_error(&without))
            })
            .filter(|&(_, error)| 3.0 * error < before)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(i, _)| i)
    }

    /// The coefficients and what they are worth, in place.
    pub(crate) fn report(&self, fit: &mut Fit) {
        if self.problem.model.terms().iter().any(|term| term.fitted) {
            self.report_with_shape(fit);
        } else {
            self.report_of(None, fit);
        }
    }

    // Apart, so that a model without shapes does not need the stack for them.
    #[inline(never)]
    fn report_with_shape(&self, fit: &mut Fit) {
        let mut shape = ShapeEquations::empty();
        let told = shape.set(self.problem, &self.weights, &self.squares);
        self.report_of(told.then_some(&shape), fit);
    }

    #[inline(never)]
    fn report_of(&self, shape: Option<&ShapeEquations>, fit: &mut Fit) {
        fit.method = Method::Covariance;
        fit.coefficients.clear();
        for (i, term) in numbered(self.problem.model.terms().iter()) {
            // As many as effects.
            let coefficient = self.coefficient(i, term, shape);
            let _ = fit
                .coefficients
                .push(coefficient.in_unit(self.problem.variance_unit));
        }
        fit.shape = shape.map_or(heapless::Vec::new(), |shape| shape.estimates(&self.free));
        fit.chi_squared = self.chi_squared;
        fit.degrees_of_freedom = self.degrees_of_freedom();
        fit.p_value = self.p_value();
        fit.minus_two_log_likelihood = self.minus_two_log_likelihood();
        fit.tolerance = self.weights.tolerance;
        fit.shrinkage = self.weights.shrinkage;
    }

    /// Replaces the interval of a shape that is its effect's only one by that of its profile.
    #[inline(never)]
    pub(crate) fn bound_shapes(&self, fit: &mut Fit, span: &Span) -> Result<(), Error> {
        if fit.shape.is_empty() {
            return Ok(());
        }
        let problem = self.problem;
        let mut search = Search::new(problem, &self.weights, false);
        for shape in &mut fit.shape {
            let Some(&term) = problem.model.terms().get(shape.term) else {
                continue;
            };
            let mut parameters = term.fitted_parameters();
            if let (Some(j), None) = (parameters.next(), parameters.next()) {
                search.at(shape.term, &self.squares)?;
                search.release();
                (shape.lower, shape.upper) = search.joint_interval(term, j, span);
            }
        }
        Ok(())
    }

    /// One effect's coefficient.
    #[inline(never)]
    pub(crate) fn coefficient(
        &self,
        i: usize,
        term: &Term,
        shape: Option<&ShapeEquations>,
    ) -> Coefficient {
        if term.held {
            return Coefficient::new(term.effect, 0.0, None);
        }
        let with = self.free.with(i);
        let linear = || self.equations.variance(i, &with);
        let variance = match shape {
            Some(shape) => shape.variance(i, &with).or_else(linear),
            None => linear(),
        };
        let effect = term.effect;
        let coefficient = Coefficient::new(effect, self.squares[i], variance);
        if coefficient.state != State::UpperBound {
            return coefficient;
        }
        let bound = self.bound(i, squared(coefficient.upper));
        let upper = math::sqrt(bound);
        let state = if self.is_informative(i, bound) {
            State::UpperBound
        } else {
            let (problem, last) = (self.problem, self.problem.points.last());
            let after_s = record_length_s(
                i,
                bound,
                &self.squares,
                &self.free,
                problem.model,
                problem.interval_s,
                last.map_or(0.0, |point| clusters(point) * real(point.m)),
            );
            State::NotObservable { after_s }
        };
        Coefficient {
            upper,
            state,
            ..coefficient
        }
    }

    /// Standard error of a squared coefficient with those before and behind it in the model free, though
    /// they may have been held at zero: what one of them has, this one may have taken over. Infinite where
    /// they cannot be told apart.
    pub(crate) fn error_beside(&self, i: usize) -> Real {
        let neighbours = [i.saturating_sub(1), i, i.saturating_add(1)];
        let known = neighbours.into_iter().filter(|&j| j < self.problem.count());
        let free = known.fold(self.free, Free::with);
        let variance = self.equations.variance(i, &free);
        variance.map_or(Real::INFINITY, math::sqrt) * self.problem.variance_unit
    }

    /// The one-sided 95 % bound of a square, with the covariance that the model would have at that
    /// bound: where an effect may add to an octave, it may also scatter it.
    #[inline(never)]
    fn bound(&self, i: usize, first: Real) -> Real {
        let problem = self.problem;
        let curve = |k: usize| problem.measured(k);
        let mut equations = NormalEquations::empty();
        let mut bound = first;
        for _ in 0..BOUND_ROUNDS {
            let scatter = |k: usize| 1.0 + bound * problem.unit(i, k) / self.weights.model[k];
            let weights = &self.weights;
            let set = weights.equations(problem, &scatter, &[], &curve, &mut equations);
            if set.is_err() {
                break;
            }
            let (squares, mut free) =
                equations.solve_non_negative_near(&self.free, &problem.held());
            free.add(i);
            let Some(variance) = equations.variance(i, &free) else {
                break;
            };
            bound = Coefficient::one_sided_bound(squares[i], variance);
        }
        bound
    }

    /// Whether a bound says more than that the effect cannot exceed the whole curve.
    fn is_informative(&self, i: usize, bound: Real) -> bool {
        let octaves = 0..self.problem.points.len();
        octaves
            .into_iter()
            .all(|k| bound * self.problem.unit(i, k) < self.weights.model[k])
    }
}
