//! Turns a solution into coefficients with intervals, bounds, and the length of a record that would
//! show more.

use super::{
    method::Method, peak::Peak, problem::Problem, result::Fit, shape::ShapeEquations,
    solver::Solver, weights::Weights,
};
use crate::{
    curve::clusters,
    fit::{
        coefficient::{Coefficient, State},
        observability::record_length_s,
    },
    limits::{CHI_SQUARED_95, MAX_SHAPE},
    numerics::{
        math,
        nnls::{Interval, NormalEquations, Vector},
        real::{Real, consts::FRAC_1_SQRT_2, real},
    },
    theory::model::Term,
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

    /// The variances of the fitted shapes relative to those that follow from the weights, in the order of the fit's shapes.
    pub(crate) fn widening_of_shapes(&self) -> [Real; MAX_SHAPE] {
        if self.is_valid {
            self.shape.widening_of_shapes()
        } else {
            [1.0; MAX_SHAPE]
        }
    }

    /// Begins with a solution. What belongs to the whole model is written to the fit immediately.
    #[inline(never)]
    pub(crate) fn begin<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        fit: &mut Fit,
    ) {
        // A model without shapes does not pay for their equations.
        self.is_valid = problem.model.terms().iter().any(|term| term.fitted)
            && self
                .shape
                .set_with_overlap(problem, &solver.weights, &solver.squares, &solver.free);
        fit.method = Method::Covariance;
        fit.coefficients.clear();
        fit.shape.clear();
        fit.chi_squared = solver.chi_squared;
        fit.degrees_of_freedom = solver.degrees_of_freedom();
        fit.deviance = solver.deviance;
        fit.p_value = solver.p_value();
        fit.peak = highest_peak(problem, &solver.weights, &solver.squares);
        fit.minus_two_log_likelihood = solver.minus_two_log_likelihood();
        fit.tolerance = solver.weights.tolerance;
        fit.shrinkage = solver.weights.shrinkage;
        fit.birge_ratio = birge_ratio(fit);
        if self.is_valid {
            fit.shape = self.shape.estimates(&solver.free, fit.birge_ratio);
        }
    }

    /// Estimates one more coefficient and returns whether it was the last.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &Solver<K, B>,
        fit: &mut Fit,
    ) -> bool {
        let Some(term) = problem.model.terms().get(self.next) else {
            return true;
        };
        let shape = self.is_valid.then_some(&self.shape);
        let widened = fit.birge_ratio;
        let coefficient = coefficient(problem, solver, self.next, term, shape, widened);
        // There are as many places as a model has effects.
        let _ = fit
            .coefficients
            .push(coefficient.in_unit(problem.variance_unit));
        self.next = self.next.saturating_add(1);
        self.next >= problem.count()
    }
}

/// The peak of the problem's spectrum above the model with these squared coefficients; `None` if there is no
/// spectrum.
#[inline(never)]
fn highest_peak<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    weights: &Weights<K, B>,
    squares: &Vector,
) -> Option<Peak> {
    if B == 0 {
        return None;
    }
    let rows = problem.rows().skip(problem.points.len());
    let mut highest: Option<(Real, Real)> = None;
    for (row, bin) in rows.zip(problem.bins) {
        let error = weights.relative_error(row);
        let per_degree = error * error / 9.0;
        let ratio = problem.measured(row) / problem.variance(row, squares);
        let root = math::exp(math::log(ratio) / 3.0);
        let z = (root - 1.0 + per_degree) * 3.0 / error;
        if highest.is_none_or(|(_, highest)| z > highest) {
            highest = Some((bin.frequency_hz, z));
        }
    }
    let (frequency_hz, z) = highest?;
    let one = 0.5 * math::erfc(z * FRAC_1_SQRT_2);
    Some(Peak {
        frequency_hz,
        z,
        p_value: (real(problem.bins.len()) * one).min(1.0),
    })
}

/// The factor by which the errors of a model that is not adequate are widened. They come from the covariance
/// of the curve at the model, and residuals this large say that the model is off by more than that.
fn birge_ratio(fit: &Fit) -> Real {
    match fit.is_adequate() {
        // A model may fail by a single peak, with a χ² that is not large.
        Some(false) => math::sqrt(fit.chi_squared / real(fit.degrees_of_freedom)).max(1.0),
        _ => 1.0,
    }
}

/// The coefficient of one effect, in the problem's variance unit. Its errors are multiplied by `widened`.
fn coefficient<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    i: usize,
    term: &Term,
    shape: Option<&ShapeEquations>,
    widened: Real,
) -> Coefficient {
    if term.pinned {
        return Coefficient::new(term.effect, 0.0, None);
    }
    let square = solver.squares[i];
    let interval = |widened| interval(problem, solver, i, shape, widened);
    let coefficient = Coefficient::new(term.effect, square, interval(1.0));
    // Whether an effect is observable does not depend on how well the others explain the curve.
    let coefficient = match coefficient.state {
        State::UpperBound => bounded(problem, solver, i, coefficient),
        _ => coefficient,
    };
    if widened <= 1.0 || matches!(coefficient.state, State::NotObservable { .. }) {
        return coefficient;
    }
    let wide = Coefficient::new(term.effect, square, interval(widened));
    Coefficient {
        upper: wide.upper.max(coefficient.upper),
        ..wide
    }
}

/// A coefficient whose interval includes zero, with its bound, or with the length of a record that would show
/// it.
#[inline(never)]
fn bounded<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    i: usize,
    coefficient: Coefficient,
) -> Coefficient {
    // At its own covariance the best square may be smaller than at that of the fit. A bound lies above the value.
    let bound = bound(problem, solver, i, coefficient.upper * coefficient.upper);
    let bound = bound.max(coefficient.square);
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

/// The 95 % interval of a square by the likelihood ratio: χ² with the other coefficients fitted anew, at zero
/// or above, exceeds its minimum by no more than the quantile of one degree of freedom. A coefficient that is
/// zero at the minimum may grow in the place of this one, and its neighbours may fall to zero. If shapes are
/// fitted, the interval is not shorter than that of the normal distribution with the shapes free.
#[inline(never)]
fn interval<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    i: usize,
    shape: Option<&ShapeEquations>,
    widened: Real,
) -> Option<Interval> {
    let overlap = shape.map_or(1.0, |shape| shape.widening(i));
    let rise = real(CHI_SQUARED_95) * widened * widened * overlap;
    let (squares, free, pinned) = (&solver.squares, &solver.free, problem.pinned());
    let mut interval = solver.equations.interval(i, squares, free, &pinned, rise)?;
    interval.variance *= widened * widened * overlap;
    let with_shapes = shape.and_then(|shape| shape.variance(i, &free.with(i)));
    if let Some(variance) = with_shapes {
        let normal = Interval::normal(squares[i], variance, widened);
        interval = Interval {
            variance: normal.variance,
            lower: interval.lower.min(normal.lower),
            upper: interval.upper.max(normal.upper),
        };
    }
    Some(interval)
}

/// The one-sided 95 % bound of a square. It uses the covariance that the model would have at that
/// bound, because an effect that adds to an octave may also scatter it.
#[inline(never)]
fn bound<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
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
        let (squares, mut free) =
            equations.solve_non_negative_near(&solver.free, &problem.pinned());
        free.add(i);
        let Some(variance) = equations.variance(i, &free) else {
            break;
        };
        bound = Coefficient::one_sided_bound(squares[i], variance);
    }
    bound
}

/// Whether a bound says more than that the effect cannot exceed the whole curve.
fn is_informative<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    i: usize,
    bound: Real,
) -> bool {
    let mut rows = problem.rows();
    rows.all(|k| bound * problem.unit(i, k) < solver.weights.model[k])
}
