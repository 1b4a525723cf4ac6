//! Generalised least squares: octaves weighted by the covariance of the curve.

use super::{Columns, Fit, Method, Problem, clusters, independent, squared};
use crate::{
    chi_squared::chi_squared_tail,
    coefficient::{Coefficient, State},
    covariance::covariance,
    error::Error,
    math,
    nnls::{Free, NormalEquations, Vector},
    observability::record_length_s,
};
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// Rounds of covariance and solution; the model converges to 0.1 % in two or three.
const ROUNDS: usize = 4;
/// A change of the model that ends the rounds.
const CONVERGED: f64 = 1e-3;
/// Below this p-value the curve's scatter does not explain the misfit, and the model is granted
/// its tolerance.
const UNEXPLAINED: f64 = 0.05;
/// Rounds of a bound and the covariance that it implies.
const BOUND_ROUNDS: usize = 3;

/// The fit, with the model's tolerance where the curve needs it.
pub(super) fn fit<const K: usize>(problem: &Problem<'_, K>, tolerance: f64) -> Result<Fit, Error> {
    let start = independent::equations(problem, independent::by_relative_accuracy)?;
    let (start, _) = start.solve_non_negative();
    let mut solution = Solution::converge(problem, start, 0.0)?;
    if solution.p_value() < UNEXPLAINED && tolerance > 0.0 {
        solution = Solution::converge(problem, solution.squares, tolerance)?;
    }
    Ok(solution.fit())
}

/// Squared coefficients, and the covariance that they were found with.
struct Solution<'a, 'b, const K: usize> {
    problem: &'a Problem<'b, K>,
    weights: Weights<K>,
    equations: NormalEquations,
    squares: Vector,
    free: Free,
    chi_squared: f64,
}

impl<'a, 'b, const K: usize> Solution<'a, 'b, K> {
    fn converge(problem: &'a Problem<'b, K>, start: Vector, tolerance: f64) -> Result<Self, Error> {
        let mut squares = start;
        let mut round = 1;
        loop {
            let weights = Weights::new(problem, &squares, tolerance)?;
            let whitened = weights.whiten(problem, |_| 1.0)?;
            let equations = whitened.equations(problem.count())?;
            let (next, free) = equations.solve_non_negative();
            let change = largest_change(problem, &squares, &next);
            squares = next;
            if change < CONVERGED || round == ROUNDS {
                let residual = whitened.curve - whitened.columns * squares;
                return Ok(Self {
                    problem,
                    weights,
                    equations,
                    squares,
                    free,
                    chi_squared: residual.norm_squared(),
                });
            }
            round += 1;
        }
    }

    fn degrees_of_freedom(&self) -> usize {
        let active = self.free.iter().filter(|&&free| free).count();
        self.problem.points.len().saturating_sub(active)
    }

    fn p_value(&self) -> f64 {
        chi_squared_tail(self.chi_squared, self.degrees_of_freedom())
    }

    fn fit(&self) -> Fit {
        let count = self.problem.count();
        Fit {
            method: Method::Covariance,
            coefficients: (0..count).map(|i| self.coefficient(i)).collect(),
            chi_squared: self.chi_squared,
            degrees_of_freedom: self.degrees_of_freedom(),
            p_value: self.p_value(),
            minus_two_log_likelihood: self.chi_squared + self.weights.log_determinant,
            tolerance: self.weights.tolerance,
            shrinkage: self.weights.shrinkage,
        }
    }

    fn coefficient(&self, i: usize) -> Coefficient {
        let mut with = self.free;
        with[i] = true;
        let variance = self
            .equations
            .covariance(&with)
            .map(|matrix| matrix[(i, i)]);
        let effect = self.problem.model.terms()[i].effect;
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
                last.map_or(0.0, |point| clusters(point) * f64::from(point.m)),
            );
            State::NotObservable { after_s }
        };
        Coefficient {
            upper,
            state,
            ..coefficient
        }
    }

    /// The one-sided 95 % bound of a square, with the covariance that the model would have at that
    /// bound: where an effect may add to an octave, it may also scatter it.
    fn bound(&self, i: usize, first: f64) -> f64 {
        let mut bound = first;
        for _ in 0..BOUND_ROUNDS {
            let scatter =
                |k: usize| 1.0 + bound * self.problem.columns[(k, i)] / self.weights.model[k];
            let next = self
                .weights
                .whiten(self.problem, scatter)
                .and_then(|whitened| {
                    let equations = whitened.equations(self.problem.count())?;
                    let (squares, mut free) = equations.solve_non_negative();
                    free[i] = true;
                    let covariance = equations.covariance(&free).ok_or(Error::Singular)?;
                    Ok(Coefficient::one_sided_bound(squares[i], covariance[(i, i)]))
                });
            match next {
                Ok(next) => bound = next,
                Err(_) => break,
            }
        }
        bound
    }

    /// Whether a bound says more than that the effect cannot exceed the whole curve.
    fn is_informative(&self, i: usize, bound: f64) -> bool {
        let octaves = 0..self.problem.points.len();
        octaves
            .into_iter()
            .all(|k| bound * self.problem.columns[(k, i)] < self.weights.model[k])
    }
}

/// Largest relative change of the model between two sets of squared coefficients.
fn largest_change<const K: usize>(
    problem: &Problem<'_, K>,
    before: &Vector,
    after: &Vector,
) -> f64 {
    (0..problem.points.len())
        .map(|k| {
            let (old, new) = (problem.variance(k, before), problem.variance(k, after));
            if old > new {
                (old - new) / old
            } else {
                (new - old) / new
            }
        })
        .fold(0.0, f64::max)
}

/// The covariance of a curve relative to its model, factored.
struct Weights<const K: usize> {
    /// The model's variances.
    model: SVector<f64, K>,
    factor: Cholesky<f64, Const<K>>,
    /// Of the covariance in rate units.
    log_determinant: f64,
    tolerance: f64,
    shrinkage: f64,
}

impl<const K: usize> Weights<K> {
    fn new(problem: &Problem<'_, K>, squares: &Vector, tolerance: f64) -> Result<Self, Error> {
        let points = problem.points;
        let model = SVector::<f64, K>::from_fn(|k, _| {
            if k < points.len() {
                problem.variance(k, squares)
            } else {
                1.0
            }
        });
        if !model
            .iter()
            .all(|&variance| variance.is_finite() && variance > 0.0)
        {
            return Err(Error::Singular);
        }
        let mut matrix = covariance::<K>(
            points,
            problem.model,
            squares.as_slice(),
            problem.interval_s,
        );
        for k in 0..K {
            for j in 0..K {
                matrix[(j, k)] /= model[j] * model[k];
            }
            // Octaves that the curve does not have become the identity.
            matrix[(k, k)] += if k < points.len() {
                squared(tolerance)
            } else {
                1.0
            };
        }
        let (factor, shrinkage) = factor_positive(matrix)?;
        let lower = factor.l_dirty();
        let log_determinant = (0..points.len())
            .map(|k| 2.0 * math::log(lower[(k, k)] * model[k]))
            .sum();
        Ok(Self {
            model,
            factor,
            log_determinant,
            tolerance,
            shrinkage,
        })
    }

    /// Curve and columns in units in which octaves are independent and have a variance of one,
    /// with the standard error of octave `k` enlarged by `scatter(k)`.
    fn whiten(
        &self,
        problem: &Problem<'_, K>,
        scatter: impl Fn(usize) -> f64,
    ) -> Result<Whitened<K>, Error> {
        let mut columns = problem.columns;
        let mut curve = SVector::<f64, K>::zeros();
        for (k, point) in problem.points.iter().enumerate() {
            let unit = 1.0 / (self.model[k] * scatter(k));
            curve[k] = point.variance * unit;
            for i in 0..problem.count() {
                columns[(k, i)] *= unit;
            }
        }
        let lower = self.factor.l_dirty();
        let solved = lower.solve_lower_triangular_mut(&mut columns)
            && lower.solve_lower_triangular_mut(&mut curve);
        if solved {
            Ok(Whitened { columns, curve })
        } else {
            Err(Error::Singular)
        }
    }
}

/// Curve and columns in units in which octaves are independent.
struct Whitened<const K: usize> {
    columns: Columns<K>,
    curve: SVector<f64, K>,
}

impl<const K: usize> Whitened<K> {
    fn equations(&self, count: usize) -> Result<NormalEquations, Error> {
        let matrix = self.columns.tr_mul(&self.columns);
        let right = self.columns.tr_mul(&self.curve);
        NormalEquations::new(&matrix, &right, count)
    }
}

/// Cholesky factor of a covariance, its correlations shrunk by as little as makes it positive
/// definite, and by how much that was.
fn factor_positive<const K: usize>(
    matrix: SMatrix<f64, K, K>,
) -> Result<(Cholesky<f64, Const<K>>, f64), Error> {
    for shrinkage in [0.0, 0.01, 0.03, 0.1, 0.3] {
        let keep = 1.0 - shrinkage;
        let shrunk = SMatrix::from_fn(|j, k| matrix[(j, k)] * if j == k { 1.0 } else { keep });
        if let Some(factor) = Cholesky::new(shrunk) {
            return Ok((factor, shrinkage));
        }
    }
    Err(Error::Singular)
}
