//! A least-squares problem in double precision, and all of its solutions by elimination.

use super::{MOST, ROWS};
use crate::numerics::{
    nnls::{NormalEquations, Vector},
    real::{double, real},
    test_random::Random,
};

/// A least-squares problem in double precision: `H = A'A`, `b = A'y` and `|y|²`.
pub(super) struct Problem {
    pub(super) count: usize,
    pub(super) h: [[f64; MOST]; MOST],
    pub(super) b: [f64; MOST],
    pub(super) size: f64,
}

impl Problem {
    /// A problem of random columns and random data. `shape(columns, random)` changes the columns first.
    pub(super) fn random(
        count: usize,
        random: &mut Random,
        shape: impl Fn(&mut [[f64; ROWS]], &mut Random),
    ) -> Self {
        let mut columns = [[0.0; ROWS]; MOST];
        for column in &mut columns[..count] {
            // The elements are positive on average, as variances are, so that the columns resemble one
            // another.
            *column = core::array::from_fn(|_| random.signed() + 0.3);
        }
        shape(&mut columns[..count], random);
        // Half of the true unknowns are negative, so that the constraint matters.
        let mut data = [0.0; ROWS];
        for column in &columns[..count] {
            let size = libm::sqrt(column.iter().map(|x| x * x).sum());
            let unknown = random.signed() / size.max(1e-300);
            for (data, element) in data.iter_mut().zip(column) {
                *data += unknown * element + 0.1 * random.signed();
            }
        }
        Self::of(&columns[..count], &data)
    }

    pub(super) fn of(columns: &[[f64; ROWS]], data: &[f64; ROWS]) -> Self {
        let dot = |x: &[f64; ROWS], y: &[f64; ROWS]| x.iter().zip(y).map(|(x, y)| x * y).sum();
        let mut problem = Self {
            count: columns.len(),
            h: [[0.0; MOST]; MOST],
            b: [0.0; MOST],
            size: dot(data, data),
        };
        for (i, one) in columns.iter().enumerate() {
            problem.b[i] = dot(one, data);
            for (j, other) in columns.iter().enumerate() {
                problem.h[i][j] = dot(one, other);
            }
        }
        problem
    }

    pub(super) fn equations(&self) -> NormalEquations {
        let mut equations = NormalEquations::EMPTY;
        let set = equations.set(self.count, &|i, row| {
            for j in 0..=i {
                row.put(j, real(self.h[i][j]));
            }
            real(self.b[i])
        });
        assert!(set.is_ok());
        equations
    }

    /// The length of a column.
    pub(super) fn length(&self, i: usize) -> f64 {
        libm::sqrt(self.h[i][i])
    }

    /// The unknowns of a choice, in units of one over the length of their columns, by Gaussian
    /// elimination with pivots. `None` if a pivot is no more than rounding.
    pub(super) fn eliminated(
        &self,
        chosen: u32,
        right: impl Fn(usize) -> f64,
    ) -> Option<[f64; MOST]> {
        let places = || (0..self.count).filter(|i| chosen >> i & 1 == 1);
        // The rows of unknowns that are not chosen are those of the identity.
        let mut rows: [[f64; MOST + 1]; MOST] =
            core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
        for i in places() {
            for j in places() {
                rows[i][j] = self.h[i][j] / (self.length(i) * self.length(j));
            }
            rows[i][MOST] = right(i);
        }
        for i in 0..self.count {
            let size = |k: &usize| rows[*k][i].abs();
            let pivot = (i..self.count).max_by(|a, b| size(a).total_cmp(&size(b)))?;
            rows.swap(i, pivot);
            if rows[i][i].abs() < 1e-13 {
                return None;
            }
            for k in 0..self.count {
                if k != i {
                    let factor = rows[k][i] / rows[i][i];
                    let own = rows[i];
                    for (element, own) in rows[k].iter_mut().zip(own) {
                        *element -= factor * own;
                    }
                }
            }
        }
        Some(core::array::from_fn(|i| {
            if i < self.count {
                rows[i][MOST] / rows[i][i]
            } else {
                0.0
            }
        }))
    }

    /// The unknowns of a choice for the problem's data.
    pub(super) fn unknowns(&self, chosen: u32) -> Option<[f64; MOST]> {
        self.eliminated(chosen, |i| self.b[i] / self.length(i))
    }

    /// The slope `b − H x` at scaled unknowns, in scaled units.
    pub(super) fn slope(&self, x: &[f64; MOST], i: usize) -> f64 {
        let products = (0..self.count).map(|j| self.h[i][j] / self.length(j) * x[j]);
        (self.b[i] - products.sum::<f64>()) / self.length(i)
    }

    /// By how much scaled unknowns lower the sum of squared residuals.
    pub(super) fn explained(&self, x: &[f64; MOST]) -> f64 {
        let part = |i: usize| x[i] * (self.b[i] / self.length(i) + self.slope(x, i));
        (0..self.count).map(part).sum()
    }

    /// The best solution without a negative unknown, of all choices that leave the unknowns of `held`
    /// at zero.
    pub(super) fn best(&self, pinned: u32) -> ([f64; MOST], f64) {
        let choices = (0..1_u32 << self.count).filter(|chosen| chosen & pinned == 0);
        let solutions = choices.filter_map(|chosen| self.unknowns(chosen));
        let allowed = solutions.filter(|x| x.iter().all(|&x| x >= 0.0));
        let judged = allowed.map(|x| (x, self.explained(&x)));
        judged
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or(([0.0; MOST], 0.0))
    }

    /// The largest sum of squares that the unknowns explain with unknown `i` at a value and none negative.
    pub(super) fn explained_beside(&self, i: usize, value: f64) -> f64 {
        let choices = (0..1_u32 << self.count).filter(|chosen| chosen >> i & 1 == 0);
        let right = |j: usize| {
            let shared = self.h[j][i] / (self.length(j) * self.length(i));
            self.b[j] / self.length(j) - shared * value
        };
        let solutions = choices.filter_map(|chosen| {
            let mut x = self.eliminated(chosen, right)?;
            x = core::array::from_fn(|j| if chosen >> j & 1 == 1 { x[j] } else { 0.0 });
            x[i] = value;
            x.iter().all(|&x| x >= 0.0).then_some(x)
        });
        let explained = solutions.map(|x| self.explained(&x));
        explained.fold(f64::NEG_INFINITY, f64::max)
    }

    /// A solution in scaled units.
    pub(super) fn scaled(&self, solution: &Vector) -> [f64; MOST] {
        core::array::from_fn(|i| {
            if i < self.count {
                double(solution[i]) * self.length(i)
            } else {
                0.0
            }
        })
    }
}
