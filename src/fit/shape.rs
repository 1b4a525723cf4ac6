//! The uncertainty of fitted shapes, and what it adds to the uncertainty of the coefficients.

use super::{
    overlap::Overlap, problem::Problem, result::ShapeEstimate, rows::Rows, weights::Weights,
};
use crate::{
    limits::{MAX_SHAPE, TWO_SIDED_95},
    list::{self, numbered},
    numerics::{
        math,
        nnls::{NormalEquations, PassiveSet, Vector},
        real::{Real, real, single},
    },
    theory::model::Term,
};
use heapless::Vec;

/// The relative step of the numerical derivatives. It is near the cube root of the rounding of single
/// precision, 0.005, where the error of a central difference is smallest.
const STEP: Real = 0.01;

/// The change of a column over two steps, relative to twice the column, up to which a central difference is taken for the
/// derivative. Chosen by hand: only lines change by more, since they leave their bin within the first step, which says
/// nothing of the derivative.
const SMOOTH: Real = 0.3;

/// The factor by which a step becomes smaller if it is too large, and how often it does so at most. With segments of 64
/// blocks, the smallest step, 4·10⁻⁵, is a hundredth of a bin of the second level for a line at half the sample rate.
const SMALLER: Real = 0.25;
const SMALLER_TIMES: u8 = 4;

/// The variance of an unknown is never taken for less than a quarter of the one that follows from the weights. Chosen by
/// hand. That of a line's frequency is a third, since neighbouring bins beat together less than the weights say.
const MOST_LESS: Real = -0.75;

/// The change of the model's variances with the logarithm of parameter `j` of the term at a place.
pub(crate) fn derivative<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    (place, j, term): (usize, usize, Term),
    squares: &Vector,
) -> Rows<K, B, f32> {
    let column = |factor: Real| {
        let mut term = term;
        term.scale_parameter(j, factor);
        problem.column(&term)
    };
    let mut step = STEP;
    let mut left = SMALLER_TIMES;
    loop {
        let (above, below) = (column(math::exp(step)), column(math::exp(-step)));
        if left == 0 || is_smooth(problem, &above, &below) {
            let scale = 0.5 * squares[place] / step;
            let mut derivative = Rows::ZEROS;
            for row in problem.rows() {
                let passed = problem.passed(place, row, squares);
                derivative.put(row, single((above[row] - below[row]) * scale * passed));
            }
            return derivative;
        }
        step *= SMALLER;
        left = left.saturating_sub(1);
    }
}

/// Whether a column changes little from one value of a parameter to another one, measured in shares of what is measured.
fn is_smooth<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    above: &Rows<K, B>,
    below: &Rows<K, B>,
) -> bool {
    let (mut change, mut size) = (0.0, 0.0);
    for row in problem.rows() {
        let measured = problem.measured(row);
        if measured > 0.0 {
            let difference = (above[row] - below[row]) / measured;
            let sum = (above[row] + below[row]) / measured;
            change += difference * difference;
            size += sum * sum;
        }
    }
    change <= SMOOTH * SMOOTH * size
}

/// The derivatives by the fitted shape parameters of the effects above zero, computed one per call.
pub(crate) struct Derivatives<const K: usize, const B: usize> {
    columns: Vec<Rows<K, B, f32>, MAX_SHAPE>,
}

/// The fitted shape parameters of the effects above zero: the place of the effect, that of the parameter, and the effect.
/// `None` if there are too many.
fn fitted_shapes<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    squares: &Vector,
) -> Option<Vec<(usize, usize, Term), MAX_SHAPE>> {
    let mut shapes = Vec::new();
    for (i, term) in numbered(problem.model.terms().iter()) {
        for j in term.fitted_parameters().filter(|_| squares[i] > 0.0) {
            shapes.push((i, j, *term)).ok()?;
        }
    }
    Some(shapes)
}

impl<const K: usize, const B: usize> Derivatives<K, B> {
    /// No derivatives yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const NONE: Self = Self {
        columns: Vec::new(),
    };

    /// Computes all of them.
    #[inline(never)]
    pub(crate) fn set(&mut self, problem: &Problem<'_, K, B>, squares: &Vector) {
        self.columns.clear();
        while !self.advance(problem, squares) {}
    }

    /// Computes one more derivative, and returns whether there was none left.
    #[inline(never)]
    pub(crate) fn advance(&mut self, problem: &Problem<'_, K, B>, squares: &Vector) -> bool {
        let shapes = fitted_shapes(problem, squares);
        let next = shapes.and_then(|shapes| shapes.get(self.columns.len()).copied());
        let Some(shape) = next else {
            return true;
        };
        let column = derivative(problem, shape, squares);
        // There is a place for every parameter.
        self.columns.push(column).is_err()
    }

    /// Forgets them.
    pub(crate) fn clear(&mut self) {
        self.columns.clear();
    }
}

/// The normal equations of the coefficients and of the logarithms of the fitted shape parameters,
/// linearised around the solution.
pub(crate) struct ShapeEquations {
    equations: NormalEquations,
    parameters: Vec<(usize, usize, Term), MAX_SHAPE>,
    /// The variance of each unknown beyond the one that follows from the weights, relative to that one.
    excess: Vector,
}

impl ShapeEquations {
    /// Of no model yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        equations: NormalEquations::EMPTY,
        parameters: Vec::new(),
        excess: Vector::ZEROS,
    };

    /// Sets the equations at a solution. Returns `false` if the model has no fitted shapes, or if they
    /// cannot be told from the rest.
    #[inline(never)]
    pub(crate) fn set<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        weights: &Weights<K, B>,
        squares: &Vector,
        derivatives: &Derivatives<K, B>,
    ) -> bool {
        self.excess = Vector::ZEROS;
        // The coefficients come first, the shapes follow.
        let shapes = fitted_shapes(problem, squares);
        let is_complete = |shapes: &Vec<_, MAX_SHAPE>| derivatives.columns.len() == shapes.len();
        let shapes = shapes.filter(is_complete);
        self.parameters = shapes.unwrap_or_default();
        if self.parameters.is_empty() {
            return false;
        }
        let residual = |k: usize| problem.measured(k) - problem.variance(k, squares);
        let (equations, columns) = (&mut self.equations, &derivatives.columns);
        let set = weights.equations(problem, &|_| 1.0, columns, &residual, equations);
        set.is_ok()
    }

    /// Does the same. With the feature `overlap`, it adds to the variances of all unknowns what the weights leave out,
    /// because bins of different levels and octaves look at the same samples.
    #[inline(never)]
    pub(crate) fn set_with_overlap<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        weights: &Weights<K, B>,
        squares: &Vector,
        free: &PassiveSet,
    ) -> bool {
        let mut derivatives = Derivatives::NONE;
        derivatives.set(problem, squares);
        let is_valid = self.set(problem, weights, squares, &derivatives);
        if cfg!(feature = "overlap") && B > 0 && is_valid {
            self.add_overlap(problem, weights, squares, free, &derivatives.columns);
        }
        is_valid
    }

    #[inline(never)]
    fn add_overlap<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        weights: &Weights<K, B>,
        squares: &Vector,
        free: &PassiveSet,
        derivatives: &[Rows<K, B, f32>],
    ) {
        let (count, unknowns) = (self.count(), self.equations.count());
        let free = self.with_shapes(free, count);
        let overlap = Overlap::new(problem, squares, &weights.model);
        // An unknown's variance, and the factors by which it changes with the rows.
        let factors = |i: usize| {
            let covariances = self.equations.covariances(i, &free.with(i))?;
            let change = |row: usize| -> Real {
                let of = |j: usize| match j.checked_sub(count) {
                    None => problem.unit(j, row),
                    Some(at) => derivatives.get(at).map_or(0.0, |column| real(column[row])),
                };
                (0..unknowns).map(|j| covariances[j] * of(j)).sum()
            };
            let factors = weights.solve(problem, &|_| 1.0, &change);
            Some((covariances[i], factors))
        };
        let mut excess = Vector::ZEROS;
        let mut levels = overlap.levels().peekable();
        while let Some(level) = levels.next() {
            let fine = overlap.fine(&level);
            for i in 0..unknowns {
                if let Some((_, factors)) = factors(i) {
                    let more = overlap.of_level(&level, levels.peek(), &fine, &factors);
                    excess.put(i, excess[i] + more);
                }
            }
        }
        for i in 0..unknowns {
            if let Some((variance, factors)) = factors(i) {
                let more = excess[i] + overlap.of_lines(&factors);
                excess.put(i, (more / variance).max(MOST_LESS));
            }
        }
        self.excess = excess;
    }

    /// The variance of an unknown relative to the one that follows from the weights.
    pub(crate) fn widening(&self, i: usize) -> Real {
        1.0 + self.excess[i]
    }

    /// The same for the shapes, in their order.
    pub(crate) fn widening_of_shapes(&self) -> [Real; MAX_SHAPE] {
        let count = self.count();
        core::array::from_fn(|at| self.widening(count.saturating_add(at)))
    }

    fn with_shapes(&self, free: &PassiveSet, count: usize) -> PassiveSet {
        PassiveSet::of(|i| {
            (i < count && free.has(i)) || (count..self.equations.count()).contains(&i)
        })
    }

    fn count(&self) -> usize {
        self.equations.count().saturating_sub(self.parameters.len())
    }

    /// The step of Gauss and Newton: the change of the shapes' logarithms that leads to the smallest
    /// χ², with all free coefficients fitted anew. Calls `each(effect, parameter, change)`.
    pub(crate) fn steps(&self, free: &PassiveSet, mut each: impl FnMut(usize, usize, Real)) {
        let count = self.count();
        let free = self.with_shapes(free, count);
        let Some(steps) = self.equations.solve_free(&free) else {
            return;
        };
        for (at, &(i, j, _)) in numbered(self.parameters.iter()) {
            each(i, j, steps[count.saturating_add(at)]);
        }
    }

    /// The variance of a squared coefficient with the shapes free.
    pub(crate) fn variance(&self, i: usize, free: &PassiveSet) -> Option<Real> {
        let free = self.with_shapes(free, self.count());
        let variance = self.equations.variance(i, &free)?;
        Some(variance * self.widening(i))
    }

    /// The covariances of a squared coefficient with all coefficients, with the shapes free.
    pub(crate) fn column(&self, i: usize, free: &PassiveSet) -> Option<Vector> {
        let free = self.with_shapes(free, self.count());
        self.equations.column(i, &free)
    }

    /// The largest standard error of a shape's logarithm. It is infinite where the curve does not
    /// determine a shape.
    pub(crate) fn worst_error(&self, free: &PassiveSet) -> Real {
        let count = self.count();
        let free = self.with_shapes(free, count);
        let variance = |at: usize| self.equations.variance(count.saturating_add(at), &free);
        (0..self.parameters.len())
            .map(|at| variance(at).map_or(Real::INFINITY, math::sqrt))
            .fold(0.0, Real::max)
    }

    /// The fitted parameters with their intervals, which are symmetric in the logarithm. The standard errors are
    /// multiplied by `widened`.
    pub(crate) fn estimates(
        &self,
        free: &PassiveSet,
        widened: Real,
    ) -> Vec<ShapeEstimate, MAX_SHAPE> {
        let count = self.count();
        let free = self.with_shapes(free, count);
        let parameters = numbered(self.parameters.iter());
        list::fill(parameters.map(|(at, &(term, j, shape))| {
            let value = shape.parameter(j);
            let unknown = count.saturating_add(at);
            let variance = self.equations.variance(unknown, &free);
            let widened = widened * math::sqrt(self.widening(unknown));
            let error = variance.map_or(Real::INFINITY, math::sqrt);
            let factor = math::exp(real(TWO_SIDED_95) * error * widened);
            ShapeEstimate {
                term,
                name: shape.parameter_name(j),
                value,
                lower: value / factor,
                upper: value * factor,
            }
        }))
    }
}
