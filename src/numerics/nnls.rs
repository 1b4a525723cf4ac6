//! Least squares with coefficients that cannot be negative, solved by the normal equations.

mod interval;

pub(crate) use interval::Interval;

use crate::{
    error::Error,
    limits::UNKNOWNS,
    numerics::{
        algebra::{self, Choice, Triangle},
        cholesky, math,
        real::{Real, by_precision},
    },
};

/// The matrix `H` of normal equations `H β = b`.
pub(crate) type Matrix = Triangle<{ UNKNOWNS + 1 }, { UNKNOWNS / 2 }>;
const _: () = assert!(
    UNKNOWNS.is_multiple_of(2),
    "the rectangle that holds the triangle is that of an even number of unknowns"
);
/// One number for each unknown.
pub(crate) type Vector = algebra::Vector<UNKNOWNS>;

/// A pivot of the scaled equations below this limit is rounding and not information. Chosen by hand: in
/// single precision, it is about ten times the rounding of a sum of as many products as there are
/// unknowns. `src/numerics/nnls/tests.rs` checks what it refuses.
const LEAST_PIVOT: Real = by_precision(1e-10, 1e-5);
/// A slope of the scaled equations below this limit is rounding as well. Chosen by hand: in single
/// precision, it is some ten times the rounding of a product. `src/numerics/nnls/tests.rs` checks the solutions.
const LEAST_SLOPE: Real = by_precision(1e-12, 1e-6);

/// The choice of free unknowns, the passive set of Lawson & Hanson (1974, chapter 23). The others are held at zero.
pub(crate) type PassiveSet = Choice;

/// The normal equations, with every column scaled to one so that coefficients of any magnitude share
/// one tolerance.
#[derive(Clone)]
pub(crate) struct NormalEquations {
    scaled: Matrix,
    right: Vector,
    scale: Vector,
    count: usize,
}

impl NormalEquations {
    /// Of no unknowns.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        scaled: Matrix::ZEROS,
        right: Vector::ZEROS,
        scale: Vector::ZEROS,
        count: 0,
    };

    /// Sets `H` and `b` for the first `count` unknowns. `row(i, own)` fills `own` with `H_ij` for
    /// `j ≤ i`, and returns `b_i`.
    ///
    /// # Errors
    /// [`Error::Singular`] if a column is zero or not finite.
    pub(crate) fn set(
        &mut self,
        count: usize,
        row: &dyn Fn(usize, &mut Vector) -> Real,
    ) -> Result<(), Error> {
        self.count = count.min(UNKNOWNS);
        let mut own = Vector::zeros();
        for i in 0..self.count {
            let right = row(i, &mut own);
            let diagonal = own[i];
            if !(diagonal.is_finite() && diagonal > 0.0) {
                return Err(Error::Singular);
            }
            self.scale.put(i, 1.0 / math::sqrt(diagonal));
            self.right.put(i, right * self.scale[i]);
            for j in 0..=i {
                let scaled = own[j] * self.scale[i] * self.scale[j];
                self.scaled.put((i, j), scaled);
            }
        }
        Ok(())
    }

    /// Exchanges one unknown for another. `entry(j)` is the element of `H` for the new unknown and
    /// unknown `j`, and `right` is its element of `b`.
    ///
    /// # Errors
    /// [`Error::Singular`] if the new column is zero or not finite.
    pub(crate) fn exchange(
        &mut self,
        place: usize,
        entry: &dyn Fn(usize) -> Real,
        right: Real,
    ) -> Result<(), Error> {
        let diagonal = entry(place);
        if !(diagonal.is_finite() && diagonal > 0.0) {
            return Err(Error::Singular);
        }
        self.scale.put(place, 1.0 / math::sqrt(diagonal));
        self.right.put(place, right * self.scale[place]);
        for j in 0..self.count {
            let scaled = entry(j) * self.scale[place] * self.scale[j];
            self.scaled.put((place, j), scaled);
        }
        Ok(())
    }

    /// The number of unknowns.
    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// Factors the equations of the free unknowns. The rows of the others become those of the identity.
    #[inline(never)]
    fn factor(&self, free: &PassiveSet, factor: &mut Matrix) -> bool {
        for i in 0..self.count {
            for j in 0..=i {
                let element = match (i == j, free.has(i) && free.has(j)) {
                    (_, true) => self.scaled[(i, j)],
                    (true, false) => 1.0,
                    (false, false) => 0.0,
                };
                factor.put((i, j), element);
            }
        }
        // The diagonal of the factor holds reciprocals.
        cholesky::factor(factor, self.count)
            && (0..self.count).all(|i| factor[(i, i)] * factor[(i, i)] * LEAST_PIVOT < 1.0)
    }

    /// Solves the scaled equations of the free unknowns for any right side, in place. Returns `false`
    /// if they cannot be distinguished.
    #[inline(never)]
    fn solve_for(&self, free: &PassiveSet, x: &mut Vector) -> bool {
        let mut factor = Matrix::ZEROS;
        let regular = self.factor(free, &mut factor);
        if regular {
            cholesky::forward(&factor, self.count, x);
            cholesky::backward(&factor, self.count, x);
        }
        regular
    }

    fn solve_scaled(&self, free: &PassiveSet) -> Option<Vector> {
        // Elements beyond the count may be left over from an earlier use, so they are not copied.
        let mut solution = Vector::zeros();
        for i in (0..self.count).filter(|&i| free.has(i)) {
            solution.put(i, self.right[i]);
        }
        self.solve_for(free, &mut solution).then_some(solution)
    }

    /// The gradient `b − H β` at a scaled solution.
    fn gradient(&self, scaled: &Vector) -> Vector {
        let mut gradient = Vector::zeros();
        for i in 0..self.count {
            let row = (0..self.count).map(|j| self.scaled[(i, j)] * scaled[j]);
            gradient.put(i, self.right[i] - row.sum::<Real>());
        }
        gradient
    }

    /// By how much a solution lowers the sum of squared residuals.
    pub(crate) fn explained(&self, solution: &Vector) -> Real {
        let scale = self.scale.map(|x| if x > 0.0 { x } else { 1.0 });
        let scaled = Vector::from(solution.component_div(&scale));
        let rest = self.gradient(&scaled);
        (0..self.count)
            .map(|i| scaled[i] * (self.right[i] + rest[i]))
            .sum()
    }

    /// The solution with the given unknowns free, whatever their signs. `None` if they cannot be told
    /// apart.
    pub(crate) fn solve_free(&self, free: &PassiveSet) -> Option<Vector> {
        let solution = self.solve_scaled(free)?;
        Some(solution.component_mul(&self.scale).into())
    }

    /// The unconstrained solution.
    ///
    /// # Errors
    /// [`Error::Singular`] if the unknowns cannot be told apart.
    pub(crate) fn solve(&self) -> Result<Vector, Error> {
        let all = PassiveSet::of(|i| i < self.count);
        let solution = self.solve_scaled(&all).ok_or(Error::Singular)?;
        Ok(solution.component_mul(&self.scale).into())
    }

    /// The solution without negative coefficients, and the choice of those above zero. The coefficients
    /// of `held` stay at zero. The algorithm is that of Lawson & Hanson 1974, ch. 23, applied to the
    /// normal equations.
    pub(crate) fn solve_non_negative(&self, pinned: &PassiveSet) -> (Vector, PassiveSet) {
        self.improve(Vector::zeros(), PassiveSet::default(), pinned)
    }

    /// Finds the same solution, and does so sooner if `guess` is the right choice of coefficients above
    /// zero.
    pub(crate) fn solve_non_negative_near(
        &self,
        guess: &PassiveSet,
        pinned: &PassiveSet,
    ) -> (Vector, PassiveSet) {
        match self.solve_scaled(guess) {
            Some(trial) if (0..self.count).all(|i| !guess.has(i) || trial[i] > 0.0) => {
                self.improve(trial, *guess, pinned)
            }
            _ => self.solve_non_negative(pinned),
        }
    }

    #[inline(never)]
    fn improve(
        &self,
        mut solution: Vector,
        mut free: PassiveSet,
        pinned: &PassiveSet,
    ) -> (Vector, PassiveSet) {
        let mut refused = PassiveSet::default();
        // Each round frees one coefficient. Three times their number is the customary limit.
        for _ in 0..3 * UNKNOWNS {
            let gradient = self.gradient(&solution);
            let candidate = (0..self.count)
                .filter(|&i| {
                    !(free.has(i) || refused.has(i) || pinned.has(i)) && gradient[i] > LEAST_SLOPE
                })
                .max_by(|&a, &b| gradient[a].total_cmp(&gradient[b]));
            let Some(entering) = candidate else { break };
            free.add(entering);
            let Some(trial) = self
                .solve_scaled(&free)
                .filter(|trial| trial[entering] > 0.0)
            else {
                // The coefficient cannot be told from those that are already free.
                free.drop(entering);
                refused.add(entering);
                continue;
            };
            solution = self.retreat(solution, trial, &mut free);
            // A coefficient that was refused beside others may be accepted once the others have
            // changed.
            refused = PassiveSet::of(|i| refused.has(i) && i == entering);
        }
        (solution.component_mul(&self.scale).into(), free)
    }

    /// Goes from a solution towards one that may have negative coefficients. Coefficients that reach
    /// zero are held there, until none is negative.
    fn retreat(&self, mut solution: Vector, mut trial: Vector, free: &mut PassiveSet) -> Vector {
        for _ in 0..self.count {
            let pinned = (0..self.count)
                .filter(|&i| free.has(i) && trial[i] <= 0.0)
                .map(|i| (i, solution[i] / (solution[i] - trial[i])))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((leaving, fraction)) = pinned else {
                break;
            };
            solution = (*solution + (*trial - *solution) * fraction).into();
            free.drop(leaving);
            solution.put(leaving, 0.0);
            match self.solve_scaled(free) {
                Some(next) => trial = next,
                None => return solution,
            }
        }
        trial
    }

    /// The variance of one of the free unknowns. `None` if they cannot be distinguished.
    pub(crate) fn variance(&self, i: usize, free: &PassiveSet) -> Option<Real> {
        let mut unit = Vector::zeros();
        unit.put(i, 1.0);
        let regular = self.solve_for(free, &mut unit);
        regular.then(|| unit[i] * self.scale[i] * self.scale[i])
    }

    /// The covariances of one of the free unknowns with all of them. `None` if they cannot be told
    /// apart.
    pub(crate) fn column(&self, i: usize, free: &PassiveSet) -> Option<Vector> {
        let mut unit = Vector::zeros();
        unit.put(i, 1.0);
        let regular = self.solve_for(free, &mut unit);
        regular.then(|| (unit.component_mul(&self.scale) * self.scale[i]).into())
    }
}

#[cfg(test)]
mod tests;
