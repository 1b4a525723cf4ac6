//! Turns a solution into coefficients with intervals, bounds, and the length of a record that would
//! show more.

use super::{method::Method, problem::Problem, result::Fit, shape::ShapeEquations, solver::Solver};
use crate::{
    coefficient::{Coefficient, State},
    curve::clusters,
    math,
    model::Term,
    nnls::NormalEquations,
    observability::record_length_s,
    real::{Real, real},
};

/// The number of rounds in which a bound and the covariance that it implies are computed in turn.
/// Chosen by hand, to save time; no study varies it.
const BOUND_ROUNDS: usize = 2;

/// The coefficients of a solution, estimated one per call.
pub(crate) struct Estimator {
    /// The equations of coefficients and fitted shapes. They are not valid if the model has no shapes or
    /// if the shapes cannot be told apart.
    shape: ShapeEquations,
    is_valid: bool,
    next: usize,
}

impl Estimator {
    /// No estimates yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NEW: Self = Self {
        shape: ShapeEquations::EMPTY,
        is_valid: false,
        next: 0,
    };

    /// Begins with a solution. What belongs to the whole model is written to the fit immediately.
    #[inline(never)]
    pub(crate) fn begin<const K: usize>(
        &mut self,
        problem: &Problem<'_, K>,
        solver: &Solver<K>,
        fit: &mut Fit,
    ) {
        // A model without shapes does not pay for their equations.
        self.is_valid = problem.model.terms().iter().any(|term| term.fitted)
            && self.shape.set(problem, &solver.weights, &solver.squares);
        fit.method = Method::Covariance;
        fit.coefficients.clear();
        fit.shape.clear();
        if self.is_valid {
            fit.shape = self.shape.estimates(&solver.free);
        }
        fit.chi_squared = solver.chi_squared;
        fit.degrees_of_freedom = solver.degrees_of_freedom();
        fit.p_value = solver.p_value();
        fit.minus_two_log_likelihood = solver.minus_two_log_likelihood();
        fit.tolerance = solver.weights.tolerance;
        fit.shrinkage = solver.weights.shrinkage;
    }

    /// Estimates one more coefficient and returns whether it was the last.
    #[inline(never)]
    pub(crate) fn advance<const K: usize>(
        &mut self,
        problem: &Problem<'_, K>,
        solver: &Solver<K>,
        fit: &mut Fit,
    ) -> bool {
        let Some(term) = problem.model.terms().get(self.next) else {
            return true;
        };
        let shape = self.is_valid.then_some(&self.shape);
        let coefficient = coefficient(problem, solver, self.next, term, shape);
        // There are as many places as a model has effects.
        let _ = fit
            .coefficients
            .push(coefficient.in_unit(problem.variance_unit));
        self.next = self.next.saturating_add(1);
        self.next >= problem.count()
    }
}

/// The coefficient of one effect, in the problem's variance unit.
fn coefficient<const K: usize>(
    problem: &Problem<'_, K>,
    solver: &Solver<K>,
    i: usize,
    term: &Term,
    shape: Option<&ShapeEquations>,
) -> Coefficient {
    if term.held {
        return Coefficient::new(term.effect, 0.0, None);
    }
    let with = solver.free.with(i);
    let linear = || solver.equations.variance(i, &with);
    let variance = match shape {
        Some(shape) => shape.variance(i, &with).or_else(linear),
        None => linear(),
    };
    let coefficient = Coefficient::new(term.effect, solver.squares[i], variance);
    if coefficient.state != State::UpperBound {
        return coefficient;
    }
    let bound = bound(problem, solver, i, coefficient.upper * coefficient.upper);
    let upper = math::sqrt(bound);
    let state = if is_informative(problem, solver, i, bound) {
        State::UpperBound
    } else {
        let last = problem.points.last();
        let after_s = record_length_s(
            i,
            bound,
            &solver.squares,
            &solver.free,
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

/// The one-sided 95 % bound of a square. It uses the covariance that the model would have at that
/// bound, because an effect that adds to an octave may also scatter it.
#[inline(never)]
fn bound<const K: usize>(
    problem: &Problem<'_, K>,
    solver: &Solver<K>,
    i: usize,
    first: Real,
) -> Real {
    let curve = |k: usize| problem.measured(k);
    let weights = &solver.weights;
    let mut equations = NormalEquations::EMPTY;
    let mut bound = first;
    for _ in 0..BOUND_ROUNDS {
        let scatter = |k: usize| 1.0 + bound * problem.unit(i, k) / weights.model[k];
        let set = weights.equations(problem, &scatter, &[], &curve, &mut equations);
        if set.is_err() {
            break;
        }
        let (squares, mut free) = equations.solve_non_negative_near(&solver.free, &problem.held());
        free.add(i);
        let Some(variance) = equations.variance(i, &free) else {
            break;
        };
        bound = Coefficient::one_sided_bound(squares[i], variance);
    }
    bound
}

/// Whether a bound says more than that the effect cannot exceed the whole curve.
fn is_informative<const K: usize>(
    problem: &Problem<'_, K>,
    solver: &Solver<K>,
    i: usize,
    bound: Real,
) -> bool {
    let mut octaves = 0..problem.points.len();
    octaves.all(|k| bound * problem.unit(i, k) < solver.weights.model[k])
}
