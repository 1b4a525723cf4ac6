//! The fit of a model to the curve that is expected if an effect is added to it.

use super::power::{Gate, Variances};
use crate::{
    fit::{Problem, Rows, Weights},
    limits::{MAX_EFFECTS, MAX_SHAPE},
    list::numbered,
    math,
    nnls::{Free, NormalEquations, Vector},
    real::{Real, real},
};
use heapless::Vec;

/// The number of rounds in which the expected fit and the weights that follow from it are computed in turn. With two
/// rounds, Gauss–Markov noise of 0.2 to 0.6 s, which flicker noise follows far, showed in 57 % at its limit, and with
/// six in 95 %.
const ROUNDS: usize = 6;
/// The share of χ² that remains because the weights of a fit follow the scatter of its own record. Records in which
/// nothing is hidden have a mean χ² of 0.93 times the degrees of freedom from octaves alone (`cargo xtask study theory`)
/// and of 0.97 times with a spectrum, and effects at their limit show in 94 to 97 % of records of either kind with the
/// latter (`cargo xtask study detection`).
const REMAINS: Real = 0.97;
/// The least share of an octave that a linearised model must leave, so that its weights mean something.
const LEAST_LEFT: Real = 0.1;

/// The changes of a model's variances with its fitted shapes.
pub(super) type Derivatives<const K: usize, const B: usize> = Vec<Rows<K, B, f32>, MAX_SHAPE>;

/// A fitted model, to which effects are added.
pub(super) struct Ground<'a, const K: usize, const B: usize> {
    pub(super) problem: &'a Problem<'a, K, B>,
    /// The weights at the model, with the tolerance that a model gets before it is called inadequate.
    pub(super) weights: &'a Weights<K, B>,
    pub(super) derivatives: &'a Derivatives<K, B>,
}

/// How far an effect lies above or below its limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// The root of the noncentrality.
    pub(super) root: Real,
    /// The root with which the effect would show with 95 %.
    pub(super) needed: Real,
}

impl<const K: usize, const B: usize> Ground<'_, K, B> {
    /// The standing of an effect with which octave `k` has the variance `expected(k)` and the scatter of
    /// a random curve of the variance `scatter(k)`. `surplus` is the relative variance of the effect's power that
    /// this scatter lacks. `gain` is the least fall of the score for which the
    /// effect is added. `None` if the model follows the effect wherever it leads, or has no degrees of
    /// freedom.
    ///
    /// This is the fit to the expected curve, which Cowan, Cranmer, Gross & Vitells (Eur. Phys. J. C 71,
    /// 1554, 2011) call the Asimov data set. What the model does not follow is the noncentrality of χ². The
    /// weights are those of the fit, which takes the effect for a part of its own; the curve scatters as
    /// the effect makes it scatter.
    #[inline(never)]
    pub(super) fn standing(
        &self,
        expected: &dyn Fn(usize) -> Real,
        scatter: &dyn Fn(usize) -> Real,
        surplus: Real,
        gain: Real,
    ) -> Option<Standing> {
        let Self {
            problem, weights, ..
        } = self;
        let n = problem.row_count();
        let mut fitted = Rows::of(problem.rows(), expected);
        let mut free = Free::NONE;
        for _ in 0..ROUNDS {
            free = self.fit(expected, &mut fitted)?;
        }
        let scale = |k: usize| fitted[k] / weights.model[k];
        let shift = weights.whiten(problem, &scale, &|k| expected(k) - fitted[k]);
        let distance = math::sqrt(shift.norm_squared());
        let ratio = |k: usize| scatter(k) / fitted[k];
        let per_distance = 1.0 / distance.max(Real::MIN_POSITIVE);
        let direction = shift.map(|shift| shift * per_distance);
        let octaves = weights.variance_along(problem, &direction, &ratio);
        let along = octaves + surplus * distance * distance;
        let basis = self.basis(&scale, &free);
        let unknowns = basis.len();
        let degrees_of_freedom = n.saturating_sub(unknowns);
        let total: Real = problem
            .rows()
            .map(|row| weights.variance_along(problem, &Rows::of(row..=row, |_| 1.0), &ratio))
            .sum();
        let followed: Real = basis
            .iter()
            .map(|column| weights.variance_along(problem, column, &ratio))
            .sum();
        let others = real(degrees_of_freedom.saturating_sub(1).max(1));
        let variances = Variances {
            along: REMAINS * along,
            rest: REMAINS * ((total - followed - octaves) / others).max(LEAST_LEFT),
        };
        let root = math::sqrt(REMAINS) * distance;
        let valid = root.is_finite() && along.is_finite() && along > 0.0;
        let gate = Gate::new(degrees_of_freedom, gain)?;
        valid.then(|| Standing {
            root,
            needed: gate.needed(variances),
        })
    }

    /// By how much the model's coefficients and shapes follow a shift of the curve, in the linear
    /// approximation: the squared coefficients above zero come first, and the logarithms of the fitted
    /// shapes behind them. `None` if they cannot be told apart.
    #[inline(never)]
    pub(super) fn followed(
        &self,
        squares: &Vector,
        shift: &dyn Fn(usize) -> Real,
    ) -> Option<Vector> {
        let Self {
            problem,
            weights,
            derivatives,
        } = self;
        let count = problem.count();
        let mut equations = NormalEquations::EMPTY;
        let set = weights.equations(problem, &|_| 1.0, derivatives, shift, &mut equations);
        set.ok()?;
        let shapes = count..equations.count();
        let free = Free::of(|i| (i < count && squares[i] > 0.0) || shapes.contains(&i));
        equations.solve_free(&free)
    }

    /// The change of octave `k` with the steps of the fitted shapes.
    pub(super) fn change(&self, k: usize, solution: &Vector) -> Real {
        let count = self.problem.count();
        let changes = numbered(self.derivatives.iter());
        changes
            .map(|(at, change)| real(change[k]) * solution[count.saturating_add(at)])
            .sum()
    }

    /// Fits the model to the expected curve, with the weights at `fitted`, which becomes the fit. Returns the
    /// coefficients above zero.
    fn fit(&self, expected: &dyn Fn(usize) -> Real, fitted: &mut Rows<K, B>) -> Option<Free> {
        let Self {
            problem,
            weights,
            derivatives,
        } = self;
        let count = problem.count();
        let mut equations = NormalEquations::EMPTY;
        let scale = |k: usize| fitted[k] / weights.model[k];
        let set = weights.equations(problem, &scale, derivatives, expected, &mut equations);
        set.ok()?;
        let shapes = count..equations.count();
        let held = problem.held();
        let held = Free::of(|i| held.has(i) || shapes.contains(&i));
        let (mut solution, free) = equations.solve_non_negative(&held);
        if !derivatives.is_empty() {
            let with_shapes = Free::of(|i| free.has(i) || shapes.contains(&i));
            solution = equations.solve_free(&with_shapes)?;
        }
        for k in problem.rows() {
            let value = problem.variance(k, &solution) + self.change(k, &solution);
            let is_left = value > LEAST_LEFT * fitted[k];
            if !is_left {
                return None;
            }
            fitted.put(k, value);
        }
        Some(free)
    }

    /// Orthonormal columns that span what the model can follow.
    #[inline(never)]
    fn basis(
        &self,
        scale: &dyn Fn(usize) -> Real,
        free: &Free,
    ) -> Vec<Rows<K, B>, { MAX_EFFECTS + MAX_SHAPE }> {
        let Self {
            problem,
            weights,
            derivatives,
        } = self;
        let mut basis = Vec::<Rows<K, B>, { MAX_EFFECTS + MAX_SHAPE }>::new();
        let columns = problem.columns().iter();
        let columns = numbered(columns).filter(|(i, _)| free.has(*i));
        for column in columns.map(|(_, column)| column).chain(derivatives.iter()) {
            let mut own = weights.whiten(problem, scale, &|k| real(column[k]));
            let before = own.norm_squared();
            for other in &basis {
                let share = other.dot(&own);
                own = Rows::of(problem.rows(), |row| own[row] - share * other[row]);
            }
            let after = own.norm_squared();
            if after > 1e-6 * before {
                // There is a place for every column.
                let size = 1.0 / math::sqrt(after);
                let _ = basis.push(own.map(|own| own * size));
            }
        }
        basis
    }
}

/// The squared coefficients of a model, without those that are not known.
pub(super) fn at_least_zero(squares: &Vector) -> Vector {
    Vector::from_fn(|i| squares[i].max(0.0))
}
