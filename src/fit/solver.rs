//! Generalised least squares: octaves weighted by the covariance of the curve at the model that the
//! weights lead to, found by alternating the two.

use super::{
    independent, method::ADEQUATE_P, problem::Problem, shape::ShapeEquations, weights::Weights,
};
use crate::{
    algebra,
    chi_squared::chi_squared_tail,
    error::Error,
    list::numbered,
    nnls::{Free, NormalEquations, Vector},
    real::Real,
};

/// The most rounds of covariance and solution. Two to four bring the model to within 0.1 %, hardly ever
/// more than eight.
const ROUNDS: u8 = 8;
/// A p-value after the first round that no further round makes plausible.
const HOPELESS_P: Real = 1e-6;
/// A relative change of the model that ends the rounds.
const CONVERGED: Real = 3e-3;
/// A shape parameter with a larger standard error of its logarithm is not determined.
const UNDETERMINED: Real = 0.3;
/// The error of an undetermined shape has to fall by this factor when a coefficient is held at zero.
const DETERMINED_BY: Real = 3.0;

/// The tolerance of a model: how far an octave may be off, relative to its variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tolerance {
    /// Granted only to a model that is not adequate without it.
    IfNeeded(Real),
    /// Granted in any case, because it was granted to the model that this one is compared with; 0 where
    /// it was not.
    Fixed(Real),
}

/// Where the rounds start.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// From the solution for independent octaves.
    Independent,
    /// From these squared coefficients.
    From(Vector),
    /// From these squared coefficients, for a single round: a caller that changes shapes comes again.
    Once(Vector),
}

/// How many rounds there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rounds {
    /// A single one.
    One,
    /// Until covariance and solution agree, or the first says that no fit without tolerance explains the
    /// curve.
    Promising,
    /// Until they agree.
    All,
}

/// Squared coefficients and the covariance that they were found with. One call of
/// [`advance`](Self::advance) computes a row of the covariance or solves the normal equations, so that
/// a caller can do something else in between.
pub(crate) struct Solver<const K: usize> {
    pub(crate) weights: Weights<K>,
    pub(crate) equations: NormalEquations,
    pub(crate) squares: Vector,
    pub(crate) free: Free,
    pub(crate) chi_squared: Real,
    /// The squares that the covariance is taken at; they approach those that it gives.
    pub(crate) assumed: Vector,
    degrees_of_freedom: usize,
    /// Relative change of the model in the last round, and the share of it that was taken.
    last: Option<algebra::Vector<K>>,
    stride: Real,
    round: u8,
    rounds: Rounds,
    /// The tolerance that a model is granted if it turns out not to be adequate.
    if_needed: Option<Real>,
}

impl<const K: usize> Solver<K> {
    /// A solver without a problem.
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self {
            weights: Weights::empty(),
            equations: NormalEquations::empty(),
            squares: Vector::zeros(),
            free: Free::default(),
            chi_squared: Real::NAN,
            assumed: Vector::zeros(),
            degrees_of_freedom: 0,
            last: None,
            stride: 1.0,
            round: 1,
            rounds: Rounds::All,
            if_needed: None,
        }
    }

    /// Begins with a problem.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn begin(
        &mut self,
        problem: &Problem<'_, K>,
        start: Start,
        tolerance: Tolerance,
    ) -> Result<(), Error> {
        let start_squares = match start {
            Start::Independent => {
                let weight = independent::by_relative_accuracy;
                independent::equations(problem, weight, &mut self.equations)?;
                self.equations.solve_non_negative(&problem.held()).0
            }
            Start::From(squares) | Start::Once(squares) => squares,
        };
        let (granted, if_needed) = match tolerance {
            Tolerance::IfNeeded(tolerance) if tolerance > 0.0 => (0.0, Some(tolerance)),
            Tolerance::IfNeeded(tolerance) | Tolerance::Fixed(tolerance) => (tolerance, None),
        };
        self.if_needed = if_needed;
        let rounds = match (start, if_needed) {
            (Start::Once(_), _) => Rounds::One,
            (_, Some(_)) => Rounds::Promising,
            (_, None) => Rounds::All,
        };
        self.begin_rounds(problem, start_squares, granted, rounds)
    }

    fn begin_rounds(
        &mut self,
        problem: &Problem<'_, K>,
        start: Vector,
        tolerance: Real,
        rounds: Rounds,
    ) -> Result<(), Error> {
        self.assumed = start;
        self.last = None;
        self.stride = 1.0;
        self.round = 1;
        self.rounds = rounds;
        self.weights.begin(problem, &self.assumed, tolerance)
    }

    /// Does one piece of work and returns whether the solution is complete. The problem must be the one
    /// that was begun with.
    ///
    /// # Errors
    /// [`Error::Singular`].
    #[inline(never)]
    pub(crate) fn advance(&mut self, problem: &Problem<'_, K>) -> Result<bool, Error> {
        if !self.weights.advance(problem, &self.assumed)? {
            return Ok(false);
        }
        if !self.end_round(problem)? {
            return Ok(false);
        }
        match self.if_needed.take() {
            Some(tolerance) if self.p_value() < ADEQUATE_P => {
                self.begin_rounds(problem, self.squares, tolerance, Rounds::All)?;
                Ok(false)
            }
            _ => Ok(true),
        }
    }

    /// Solves the normal equations with the weights at hand. Returns whether this was the last round;
    /// otherwise the next one has begun.
    #[inline(never)]
    fn end_round(&mut self, problem: &Problem<'_, K>) -> Result<bool, Error> {
        let curve = |k: usize| problem.measured(k);
        let (weights, equations) = (&self.weights, &mut self.equations);
        weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
        (self.squares, self.free) = self.equations.solve_non_negative(&problem.held());
        self.degrees_of_freedom = degrees_of_freedom(problem, &self.free);
        let change = algebra::Vector::<K>::from_fn(|k| {
            if k < problem.points.len() {
                problem.variance(k, &self.squares) / self.weights.model[k] - 1.0
            } else {
                0.0
            }
        });
        let is_last = change.amax() < CONVERGED
            || match self.rounds {
                Rounds::One => true,
                Rounds::Promising if self.round == 1 => {
                    self.chi_squared = self.weights.chi_squared(problem, &self.squares);
                    self.p_value() < HOPELESS_P
                }
                _ => self.round >= ROUNDS,
            };
        if is_last {
            self.chi_squared = self.weights.chi_squared(problem, &self.squares);
            return Ok(true);
        }
        if let Some(last) = self.last {
            // Rounds that swing to and fro, or creep, have a ratio: go where it leads (Aitken 1926).
            let ratio = change.dot(&last) / last.norm_squared();
            self.stride = (self.stride / (1.0 - ratio.min(0.5))).clamp(0.3, 2.0);
        }
        self.last = Some(change);
        let next = *self.assumed + (*self.squares - *self.assumed) * self.stride;
        self.assumed = next.map(|square| square.max(0.0)).into();
        self.round = self.round.saturating_add(1);
        let tolerance = self.weights.tolerance;
        self.weights.begin(problem, &self.assumed, tolerance)?;
        Ok(false)
    }

    /// Octaves less coefficients above zero and their fitted shapes.
    pub(crate) const fn degrees_of_freedom(&self) -> usize {
        self.degrees_of_freedom
    }

    /// The probability of a larger χ² if the model is true; NaN without degrees of freedom.
    pub(crate) fn p_value(&self) -> Real {
        chi_squared_tail(self.chi_squared, self.degrees_of_freedom)
    }

    /// `−2 ln L = r'C⁻¹r + ln det C`, up to a constant.
    pub(crate) fn minus_two_log_likelihood(&self) -> Real {
        self.chi_squared + self.weights.log_determinant
    }

    /// An effect above zero that a fitted shape could take the place of: held at zero, it leaves the
    /// shape determined.
    pub(crate) fn confused(
        &self,
        problem: &Problem<'_, K>,
        shape: &ShapeEquations,
    ) -> Option<usize> {
        let before = shape.worst_error(&self.free);
        if before < UNDETERMINED {
            return None;
        }
        let terms = numbered(problem.model.terms().iter());
        terms
            .filter(|&(i, term)| self.free.has(i) && term.effect.parameters().is_empty())
            .map(|(i, _)| {
                let mut without = self.free;
                without.drop(i);
                (i, shape.worst_error(&without))
            })
            .filter(|&(_, error)| DETERMINED_BY * error < before)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(i, _)| i)
    }

    /// The standard error of a squared coefficient with its neighbours in the model free, although they
    /// may have been held at zero: what one of them has, this one may have taken over. Infinite where
    /// they cannot be told apart.
    pub(crate) fn error_beside(&self, problem: &Problem<'_, K>, i: usize) -> Real {
        let neighbours = [i.saturating_sub(1), i, i.saturating_add(1)];
        let known = neighbours.into_iter().filter(|&j| j < problem.count());
        let free = known.fold(self.free, Free::with);
        let variance = self.equations.variance(i, &free);
        variance.map_or(Real::INFINITY, crate::math::sqrt) * problem.variance_unit
    }
}

/// Octaves less coefficients above zero and their fitted shapes.
fn degrees_of_freedom<const K: usize>(problem: &Problem<'_, K>, free: &Free) -> usize {
    let terms = numbered(problem.model.terms().iter());
    let active = terms.filter(|&(i, _)| free.has(i));
    active.fold(problem.points.len(), |rest, (_, term)| {
        let shapes = term.fitted_parameters();
        shapes.fold(rest.saturating_sub(1), |rest, _| rest.saturating_sub(1))
    })
}
