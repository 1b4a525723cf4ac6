//! The interval of an unknown by the likelihood ratio: how far the unknown can go while the others, which
//! cannot be negative, make the best of it.

use super::{LEAST_SLOPE, NormalEquations, PassiveSet, Vector};
use crate::{
    limits::TWO_SIDED_95,
    numerics::{
        math,
        real::{Real, by_precision, real},
    },
};

/// The number of steps to an end. A step is exact unless an unknown reaches or leaves zero on the way, so that
/// a few are enough. `src/numerics/nnls/tests.rs` compares the ends with bisections.
const STEPS: u8 = 12;
/// An end is found if the sum of squared residuals is off by less than this share of its rise.
const CLOSE: Real = by_precision(1e-6, 1e-3);

/// The interval of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    /// The variance of the unknown if the unknowns at zero stay there.
    pub(crate) variance: Real,
    /// The lower end, which is zero if the interval includes zero.
    pub(crate) lower: Real,
    /// The upper end.
    pub(crate) upper: Real,
}

impl Interval {
    /// The 95 % interval of a normal unknown with this variance, widened by a factor.
    pub(crate) fn normal(value: Real, variance: Real, widened: Real) -> Self {
        let variance = variance * widened * widened;
        let half_width = real(TWO_SIDED_95) * math::sqrt(variance);
        Self {
            variance,
            lower: (value - half_width).max(0.0),
            upper: value + half_width,
        }
    }
}

impl NormalEquations {
    /// The interval of unknown `i` in which the sum of squared residuals exceeds its minimum by no more than
    /// `rise`, with the other unknowns fitted anew, at zero or above. `held` stay at zero. `solution` is the
    /// minimum, where the unknowns of `free` are above zero. `None` if the unknown cannot be told from
    /// others.
    ///
    /// An unknown that is zero at the minimum may grow when this one falls. It makes the interval wider than
    /// the standard error says.
    pub(crate) fn interval(
        &self,
        i: usize,
        solution: &Vector,
        free: &PassiveSet,
        pinned: &PassiveSet,
        rise: Real,
    ) -> Option<Interval> {
        let mut others = *free;
        others.drop(i);
        let mut best = Vector::zeros();
        for j in 0..self.count {
            best.put(j, solution[j] / self.scale[j]);
        }
        let direction = self.direction(i, &others)?;
        let end = |up| self.end(i, &best, &direction, others, pinned, rise, up);
        let scale = self.scale[i];
        Some(Interval {
            variance: direction[i] * scale * scale,
            lower: if best[i] > 0.0 {
                end(false)? * scale
            } else {
                0.0
            },
            upper: end(true)? * scale,
        })
    }

    /// The covariances of unknown `i` with itself and the free others; `None` if it cannot be told from them.
    pub(crate) fn covariances(&self, i: usize, free: &PassiveSet) -> Option<Vector> {
        let mut covariances = self.direction(i, free)?;
        for j in 0..self.count {
            covariances.put(j, covariances[j] * self.scale[i] * self.scale[j]);
        }
        Some(covariances)
    }

    /// The covariances of unknown `i` with itself and the free others, in scaled units.
    fn direction(&self, i: usize, others: &PassiveSet) -> Option<Vector> {
        let mut unit = Vector::zeros();
        unit.put(i, 1.0);
        self.solve_for(&others.with(i), &mut unit).then_some(unit)
    }

    /// One end of an interval, in scaled units.
    #[allow(clippy::too_many_arguments)]
    #[inline(never)]
    fn end(
        &self,
        i: usize,
        best: &Vector,
        direction: &Vector,
        mut others: PassiveSet,
        pinned: &PassiveSet,
        rise: Real,
        up: bool,
    ) -> Option<Real> {
        let mut at = *best;
        let mut direction = *direction;
        let mut risen = 0.0;
        for _ in 0..STEPS {
            let variance = direction[i];
            let slope = self.gradient(&at)[i];
            // As long as no other unknown reaches or leaves zero, a step t changes the sum of squares by
            // t²/variance − 2 t slope.
            let root = math::sqrt((slope * slope + (rise - risen) / variance).max(0.0));
            let step = variance * if up { slope + root } else { slope - root };
            let value = (at[i] + step).max(0.0);
            let step = value - at[i];
            let mut next = at;
            for j in (0..self.count).filter(|&j| others.has(j)) {
                next.put(j, at[j] + direction[j] / variance * step);
            }
            next.put(i, value);
            let solved = self.is_solved(i, &next, &others, pinned);
            if !solved {
                (next, others) = self.solve_beside(i, value, &others, pinned);
                direction = self.direction(i, &others)?;
            }
            at = next;
            risen = self.risen(best, &at);
            let reached = (risen - rise).abs() <= CLOSE * rise;
            if reached || (value == 0.0 && risen <= rise) || (solved && value > 0.0) {
                break;
            }
        }
        Some(at[i])
    }

    /// Whether no unknown but `i` is negative, and none of those at zero wants to grow.
    fn is_solved(&self, i: usize, at: &Vector, others: &PassiveSet, pinned: &PassiveSet) -> bool {
        let gradient = self.gradient(at);
        let mut unknowns = (0..self.count).filter(|&j| j != i);
        unknowns.all(|j| match others.has(j) {
            true => at[j] > 0.0,
            false => pinned.has(j) || gradient[j] <= LEAST_SLOPE,
        })
    }

    /// The solution with unknown `i` at a value, in scaled units, and the choice of others above zero.
    #[inline(never)]
    fn solve_beside(
        &self,
        i: usize,
        value: Real,
        guess: &PassiveSet,
        pinned: &PassiveSet,
    ) -> (Vector, PassiveSet) {
        let mut beside = self.clone();
        for j in 0..self.count {
            beside
                .right
                .put(j, self.right[j] - self.scaled[(i, j)] * value);
        }
        let (solution, free) = beside.solve_non_negative_near(guess, &pinned.with(i));
        let mut scaled = Vector::zeros();
        for j in 0..self.count {
            scaled.put(j, solution[j] / self.scale[j]);
        }
        scaled.put(i, value);
        (scaled, free)
    }

    /// By how much the sum of squared residuals exceeds its minimum, computed from the difference of the
    /// solutions, because that of the sums would be lost in rounding.
    fn risen(&self, best: &Vector, at: &Vector) -> Real {
        let gradient = self.gradient(best);
        let mut change = Vector::zeros();
        for j in 0..self.count {
            change.put(j, at[j] - best[j]);
        }
        let mut risen = 0.0;
        for j in 0..self.count {
            let row = (0..self.count).map(|k| self.scaled[(j, k)] * change[k]);
            // The slope is zero but for rounding where the minimum is not at the limit.
            let slope = if best[j] > 0.0 { 0.0 } else { gradient[j] };
            risen += change[j] * (row.sum::<Real>() - 2.0 * slope);
        }
        risen
    }
}
