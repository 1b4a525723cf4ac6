//! Generalised least squares. The weights of the octaves come from the covariance of the curve at the
//! fitted model, and the fitted model depends on the weights. The solver alternates between the two
//! until they agree.

use super::{
    independent, method::ADEQUATE_P, problem::Problem, rows::Rows, shape::ShapeEquations,
    weights::Weights,
};
use crate::{
    error::Error,
    list::numbered,
    numerics::{
        chi_squared::chi_squared_tail,
        deviance::judged,
        nnls::{NormalEquations, PassiveSet, Vector},
        real::Real,
    },
};

/// The limit of the rounds of covariance and solution. Two to four bring the model to within 0.1 %, and
/// more than eight are hardly ever needed. Four rounds without Aitken's steps had left χ² off by up to
/// a factor of two, which set this limit.
const ROUNDS: u8 = 8;
/// The p-value after the first round below which no further round can make the model plausible. Chosen
/// by hand: with 11 degrees of freedom, its χ² of 49 is twice that of [`ADEQUATE_P`].
const HOPELESS_P: Real = 1e-6;
/// The rounds end when the relative change of the model is smaller than this. Chosen by hand, to save
/// rounds; no study varies it.
pub(super) const CONVERGED: Real = 3e-3;
/// The share of a square that is left at least where a step goes too far. It takes ten rounds to lose
/// three decades, which is more than there are, so a square that is needed stays within reach.
const LEAST_LEFT: Real = 0.5;
/// A shape parameter is not determined if the standard error of its logarithm is larger than this.
/// Chosen by hand: the 95 % interval then spans a factor of 1.8 to either side.
/// `cargo xtask study hidden-effect` runs with this value and does not vary it.
const UNDETERMINED: Real = 0.3;
/// A coefficient is held at zero if this makes the error of an undetermined shape fall by this factor.
/// Chosen by hand. `cargo xtask study hidden-effect` runs with this value and does not vary it.
const DETERMINED_BY: Real = 3.0;

/// The tolerance of a model: how far an octave may be off, relative to its variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tolerance {
    /// The tolerance is granted only to a model that is not adequate without it.
    IfNeeded(Real),
    /// The tolerance is granted in any case, because it was granted to the model that this one is
    /// compared with. It is 0 if it was not granted there.
    Fixed(Real),
}

/// The squared coefficients with which the rounds start.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// The rounds start with the solution for independent octaves.
    Independent,
    /// The rounds start with these squared coefficients.
    From(Vector),
    /// There is a single round, with these squared coefficients: a caller that changes shapes begins
    /// again.
    Once(Vector),
}

/// The number of rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rounds {
    /// There is a single round.
    One,
    /// The rounds go on until covariance and solution agree. They end after the first one if it shows
    /// that no fit without a tolerance explains the curve.
    Promising,
    /// The rounds go on until covariance and solution agree.
    All,
}

/// Squared coefficients, and the covariance with which they were found. One call of
/// [`advance`](Self::advance) computes a row of the covariance, factors it, or solves the normal equations, so
/// that a caller can do something else in between.
pub(crate) struct Solver<const K: usize, const B: usize = 0> {
    pub(crate) weights: Weights<K, B>,
    pub(crate) equations: NormalEquations,
    pub(crate) squares: Vector,
    pub(crate) free: PassiveSet,
    /// χ², or the deviance where this decides, and the probability of a larger one.
    pub(crate) chi_squared: Real,
    p_value: Real,
    pub(crate) deviance: Real,
    /// What the solution makes smallest, `r'C⁻¹r`.
    pub(crate) squared_residuals: Real,
    /// The squares at which the covariance is taken. They approach the squares that it leads to.
    pub(crate) assumed: Vector,
    degrees_of_freedom: usize,
    /// The relative change of the model in the last round, and the share of the change that was taken.
    last: Option<Rows<K, B>>,
    stride: Real,
    round: u8,
    /// Whether the weights of the round are complete, so that its equations come next.
    is_weighed: bool,
    rounds: Rounds,
    /// The tolerance that a model is granted if it turns out not to be adequate.
    if_needed: Option<Real>,
}

impl<const K: usize, const B: usize> Solver<K, B> {
    /// A solver without a problem.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NEW: Self = Self {
        weights: Weights::EMPTY,
        equations: NormalEquations::EMPTY,
        squares: Vector::ZEROS,
        free: PassiveSet::NONE,
        chi_squared: 0.0,
        p_value: 0.0,
        deviance: 0.0,
        squared_residuals: 0.0,
        assumed: Vector::ZEROS,
        degrees_of_freedom: 0,
        last: None,
        stride: 0.0,
        round: 0,
        is_weighed: false,
        rounds: Rounds::One,
        if_needed: None,
    };

    /// Begins with a problem.
    ///
    /// # Errors
    /// [`Error::Singular`] if a column is zero or not finite, or if the model has no variance in an
    /// octave.
    #[inline(never)]
    pub(crate) fn begin(
        &mut self,
        problem: &Problem<'_, K, B>,
        start: Start,
        tolerance: Tolerance,
    ) -> Result<(), Error> {
        let start_squares = match start {
            Start::Independent => {
                let weight = |row| independent::by_relative_accuracy(problem, row);
                independent::equations(problem, weight, &mut self.equations)?;
                self.equations.solve_non_negative(&problem.pinned()).0
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

    /// Begins with the first of several rounds.
    pub(super) fn begin_rounds(
        &mut self,
        problem: &Problem<'_, K, B>,
        start: Vector,
        tolerance: Real,
        rounds: Rounds,
    ) -> Result<(), Error> {
        self.assumed = start;
        self.last = None;
        self.stride = 1.0;
        self.round = 1;
        self.is_weighed = false;
        self.rounds = rounds;
        self.weights.begin(problem, &self.assumed, tolerance)
    }

    /// Does one piece of work and returns whether the solution is complete. The problem must be the one
    /// that the solver began with.
    ///
    /// # Errors
    /// [`Error::Singular`] if the covariance cannot be made positive definite, if a column is zero or
    /// not finite, or if the model has no variance in an octave.
    #[inline(never)]
    pub(crate) fn advance(&mut self, problem: &Problem<'_, K, B>) -> Result<bool, Error> {
        if !self.is_weighed {
            self.is_weighed = self.weights.advance(problem, &self.assumed)?;
            return Ok(false);
        }
        self.is_weighed = false;
        if !self.end_round(problem)? {
            return Ok(false);
        }
        match self.if_needed.take() {
            Some(tolerance) if self.p_value() < ADEQUATE_P => {
                let (start, rounds) = match self.rounds {
                    Rounds::One => (self.assumed, Rounds::One),
                    Rounds::Promising | Rounds::All => (self.squares, Rounds::All),
                };
                self.begin_rounds(problem, start, tolerance, rounds)?;
                Ok(false)
            }
            _ => Ok(true),
        }
    }

    /// Solves the normal equations with the present weights. Returns whether this was the last round.
    /// If it was not, the next round has begun.
    #[inline(never)]
    fn end_round(&mut self, problem: &Problem<'_, K, B>) -> Result<bool, Error> {
        let curve = |k: usize| problem.measured(k);
        let (weights, equations) = (&self.weights, &mut self.equations);
        weights.equations(problem, &|_| 1.0, &[], &curve, equations)?;
        (self.squares, self.free) = self.equations.solve_non_negative(&problem.pinned());
        self.degrees_of_freedom = degrees_of_freedom(problem, &self.free);
        let change = self.change(problem);
        let is_last = change.amax() < CONVERGED
            || match self.rounds {
                Rounds::One => true,
                Rounds::Promising if self.round == 1 => self.is_hopeless(problem),
                _ => self.round >= ROUNDS,
            };
        if is_last {
            self.judge(problem);
            return Ok(true);
        }
        self.begin_next(problem, change)?;
        Ok(false)
    }

    /// Whether no further round can make the model plausible. This asks χ² alone: the deviance of a solution with the weights of
    /// another model is large where a term is about to vanish.
    fn is_hopeless(&self, problem: &Problem<'_, K, B>) -> bool {
        let (weights, squares) = (&self.weights, &self.squares);
        let residuals = weights.squared_residuals(problem, squares);
        let chi_squared = weights.chi_squared(problem, squares, residuals);
        chi_squared_tail(chi_squared, self.degrees_of_freedom) < HOPELESS_P
    }

    /// Sets χ² of the solution, and what follows from it.
    fn judge(&mut self, problem: &Problem<'_, K, B>) {
        let (weights, squares) = (&self.weights, &self.squares);
        self.squared_residuals = weights.squared_residuals(problem, squares);
        let chi_squared = weights.chi_squared(problem, squares, self.squared_residuals);
        self.deviance = weights.deviance(problem, squares);
        let degrees = self.degrees_of_freedom;
        (self.chi_squared, self.p_value) = judged(chi_squared, self.deviance, degrees);
    }

    /// Whether the rounds have ended at a solution that the caller has put into `squares`, because the model changed
    /// by less than `converged`. If they have not, the next round has begun.
    pub(super) fn has_ended(
        &mut self,
        problem: &Problem<'_, K, B>,
        converged: Real,
    ) -> Result<bool, Error> {
        let change = self.change(problem);
        let has_ended = change.amax() < converged || self.round >= ROUNDS;
        if !has_ended {
            self.begin_next(problem, change)?;
        }
        Ok(has_ended)
    }

    /// The relative change of the model from the squares at which the covariance is taken to the
    /// solution.
    fn change(&self, problem: &Problem<'_, K, B>) -> Rows<K, B> {
        let mut change = Rows::ZEROS;
        for row in problem.rows() {
            let ratio = problem.variance(row, &self.squares) / self.weights.model[row];
            change.put(row, ratio - 1.0);
        }
        change
    }

    /// Begins the next round, nearer to the solution.
    fn begin_next(&mut self, problem: &Problem<'_, K, B>, change: Rows<K, B>) -> Result<(), Error> {
        if let Some(last) = self.last {
            // The changes of rounds that swing to and fro, or that creep, have a ratio. The next round
            // starts where this ratio leads (Aitken 1926).
            let ratio = change.dot(&last) / last.norm_squared();
            // The three limits of the step are chosen by hand; no study varies them.
            self.stride = (self.stride / (1.0 - ratio.min(0.5))).clamp(0.3, 2.0);
        }
        self.last = Some(change);
        // However far a step goes, it loses no effect that both ends of it have. A model that had lost
        // them all would have no variance, and so no weights.
        let (from, to, stride) = (self.assumed, self.squares, self.stride);
        self.assumed = Vector::from_fn(|i| {
            let least = LEAST_LEFT * from[i].min(to[i]);
            (from[i] + (to[i] - from[i]) * stride).max(least)
        });
        self.round = self.round.saturating_add(1);
        let tolerance = self.weights.tolerance;
        self.weights.begin(problem, &self.assumed, tolerance)
    }

    /// The number of octaves, less the number of coefficients above zero and of their fitted shape
    /// parameters.
    pub(crate) const fn degrees_of_freedom(&self) -> usize {
        self.degrees_of_freedom
    }

    /// The probability of a larger χ² if the model is true; NaN without degrees of freedom.
    pub(crate) const fn p_value(&self) -> Real {
        self.p_value
    }

    /// `−2 ln L = r'C⁻¹r + ln det C`, up to a constant.
    pub(crate) fn minus_two_log_likelihood(&self) -> Real {
        self.squared_residuals + self.weights.log_determinant
    }

    /// The effect above zero whose place a fitted shape could take. If the effect is held at zero, the
    /// shape becomes determined. `None` if all shapes are determined or no such effect exists.
    pub(crate) fn confused(
        &self,
        problem: &Problem<'_, K, B>,
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
}

/// The number of octaves, less the number of coefficients above zero and of their fitted shape
/// parameters.
fn degrees_of_freedom<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    free: &PassiveSet,
) -> usize {
    let terms = numbered(problem.model.terms().iter());
    let active = terms.filter(|&(i, _)| free.has(i));
    active.fold(problem.row_count(), |rest, (_, term)| {
        let shapes = term.fitted_parameters();
        shapes.fold(rest.saturating_sub(1), |rest, _| rest.saturating_sub(1))
    })
}
