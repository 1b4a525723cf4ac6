//! The covariance of octaves and bins, factored. It gives the units in which they are independent.

use super::{factor::Factor, problem::Problem, rows::Rows};
use crate::{
    error::Error,
    limits::MAX_EFFECTS,
    list::numbered,
    numerics::{
        deviance::deviance_residual,
        math,
        nnls::{NormalEquations, Vector},
        real::{Real, real, single},
    },
    spectrum::{BAND, relative_covariance},
    theory::covariance::covariance_row,
};
use heapless::Vec;

/// The shares that the correlations lose. They are tried in turn until the covariance is positive
/// definite. Chosen by hand; no study varies them. The last one takes octaves for independent, which
/// always works.
const SHRINKAGES: [Real; 6] = [0.0, 0.01, 0.03, 0.1, 0.3, 1.0];

/// The covariance of octaves and bins relative to a model, factored.
pub(crate) struct Weights<const K: usize, const B: usize = 0> {
    /// The model's variances and densities.
    pub(crate) model: Rows<K, B>,
    /// The Cholesky factor of the covariance relative to the model.
    factor: Factor<K, B>,
    /// The logarithm of the determinant of the covariance, in rate units.
    pub(crate) log_determinant: Real,
    pub(crate) tolerance: Real,
    pub(crate) shrinkage: Real,
    /// The next row and column of the covariance, and the present attempt at a positive definite one. They are
    /// where [`advance`](Self::advance) goes on.
    row: usize,
    column: usize,
    attempt: usize,
}

impl<const K: usize, const B: usize> Weights<K, B> {
    /// The weights of no model yet.
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        model: Rows::ZEROS,
        factor: Factor::ZEROS,
        log_determinant: 0.0,
        tolerance: 0.0,
        shrinkage: 0.0,
        row: 0,
        column: 0,
        attempt: 0,
    };

    /// Computes the weights of a model with these squared coefficients, in one go.
    pub(crate) fn set(
        &mut self,
        problem: &Problem<'_, K, B>,
        squares: &Vector,
        tolerance: Real,
    ) -> Result<(), Error> {
        self.begin(problem, squares, tolerance)?;
        while !self.advance(problem, squares)? {}
        Ok(())
    }

    /// Begins to compute the weights of a model with these squared coefficients.
    ///
    /// # Errors
    /// [`Error::Singular`] if the model has no variance in an octave.
    pub(crate) fn begin(
        &mut self,
        problem: &Problem<'_, K, B>,
        squares: &Vector,
        tolerance: Real,
    ) -> Result<(), Error> {
        for row in problem.rows() {
            let variance = problem.variance(row, squares);
            if !(variance.is_finite() && variance > 0.0) {
                return Err(Error::Singular);
            }
            self.model.put(row, variance);
        }
        self.tolerance = tolerance;
        (self.row, self.column) = (0, 0);
        self.attempt = 0;
        Ok(())
    }

    /// Computes one more row of the covariance or a part of it, or factors the covariance when all rows are there.
    /// Returns `true` when the weights are complete.
    ///
    /// # Errors
    /// [`Error::Singular`] if no shrinkage makes the covariance positive definite.
    #[inline(never)]
    pub(crate) fn advance(
        &mut self,
        problem: &Problem<'_, K, B>,
        squares: &Vector,
    ) -> Result<bool, Error> {
        let n = problem.points.len().min(K);
        let shrinkage = SHRINKAGES.get(self.attempt).copied();
        self.shrinkage = shrinkage.ok_or(Error::Singular)?;
        if self.row < n {
            self.column = self.set_row(problem, squares, 1.0 - self.shrinkage);
            if self.column >= n {
                self.row = self.row.saturating_add(1);
                self.column = self.row;
            }
            return Ok(false);
        }
        self.set_bins(problem, squares, 1.0 - self.shrinkage);
        if !self.factor.factor(n, problem.bins.len()) {
            self.attempt = self.attempt.saturating_add(1);
            (self.row, self.column) = (0, 0);
            return Ok(false);
        }
        let diagonal =
            |row| self.model[row] * problem.variance_unit / real(self.factor.diagonal(row));
        self.log_determinant = problem
            .rows()
            .map(|row| 2.0 * math::log(diagonal(row)))
            .sum();
        Ok(true)
    }

    /// Sets the covariance of the bins relative to the model. Bins of different block lengths are independent.
    /// The correlations are multiplied by `keep`.
    fn set_bins(&mut self, problem: &Problem<'_, K, B>, squares: &Vector, keep: Real) {
        let deterministic = problem.deterministic();
        // The shares of deterministic effects in this bin and in the ones before it.
        let mut shares = [0.0; BAND];
        for (b, bin) in numbered(problem.bins.iter()).take(B) {
            shares.rotate_right(1);
            let own = problem.share_of(&deterministic, K.saturating_add(b), squares);
            if let Some(first) = shares.first_mut() {
                *first = own;
            }
            for (d, share) in numbered(shares.iter()) {
                let other = b.checked_sub(d).and_then(|at| problem.bins.get(at));
                let relative = match other.filter(|other| other.block == bin.block) {
                    None => 0.0,
                    Some(_) => {
                        relative_covariance(d, problem.effective_segments(bin), [own, *share])
                    }
                };
                let kept = if d == 0 {
                    relative + self.tolerance * self.tolerance
                } else {
                    relative * keep
                };
                self.factor.put_bins(b, d, single(kept));
            }
        }
    }

    /// Computes a part of one row of the covariance relative to the model, and returns the column that comes next.
    /// The correlations are multiplied by `keep`.
    fn set_row(&mut self, problem: &Problem<'_, K, B>, squares: &Vector, keep: Real) -> usize {
        let (row, model, tolerance) = (self.row, &self.model, self.tolerance);
        let factor = &mut self.factor;
        let own = 1.0 / model[row];
        let m = problem.points.get(row).map_or(1.0, |point| real(point.m));
        let squares = problem.squares_at(m, squares);
        covariance_row(
            problem.points,
            problem.model,
            squares.as_slice(),
            problem.interval_s,
            (row, self.column),
            &mut |k, covariance| {
                let relative = covariance * own / model[k];
                let kept = if k == row {
                    relative + tolerance * tolerance
                } else {
                    relative * keep
                };
                factor.put_octaves((k, row), single(kept));
            },
        )
    }

    /// The standard error of a row, relative to the model.
    pub(crate) fn relative_error(&self, row: usize) -> Real {
        self.factor.standard_error(row)
    }

    /// `r'C⁻¹r` of octaves and bins for the model with these squared coefficients. It is what a fit makes smallest, and
    /// its differences between fits with the same weights are likelihood ratios.
    pub(crate) fn squared_residuals(&self, problem: &Problem<'_, K, B>, squares: &Vector) -> Real {
        let residual = |k: usize| problem.measured(k) - problem.variance(k, squares);
        self.whiten(problem, &|_| 1.0, &residual).norm_squared()
    }

    /// χ², from the squared residuals of [`squared_residuals`](Self::squared_residuals).
    ///
    /// The covariance is that of the fitted model, which follows the measurement, so that `r'C⁻¹r` is 3 to 7 % smaller
    /// than with the covariance of the true model. To first order, the term `−Σ r ∂(ln σ²)/∂s` takes this back, with the
    /// variance `σ²` that a row has at the model's value `s` (Farrington 1996, J. R. Stat. Soc. B 58, 349). Here
    /// `σ` is proportional to `s`, except for the tolerance. The sum is the same for correlated rows, and it is zero in
    /// the mean for the true model.
    pub(crate) fn chi_squared(
        &self,
        problem: &Problem<'_, K, B>,
        squares: &Vector,
        squared_residuals: Real,
    ) -> Real {
        let tolerance = self.tolerance * self.tolerance;
        let corrections = problem.rows().map(|row| {
            let error = self.relative_error(row);
            // Relative to the model of the weights, which is above zero in every row. That of the squares need not be.
            let excess = (problem.measured(row) - problem.variance(row, squares)) / self.model[row];
            2.0 * excess * (1.0 - tolerance / (error * error))
        });
        (squared_residuals - corrections.sum::<Real>()).max(0.0)
    }

    /// The sum of squares of the deviance residuals, in units of their correlation: nearly a χ² if the model is true, whatever
    /// the numbers of differences are, and large for a model that is too high.
    #[inline(never)]
    pub(crate) fn deviance(&self, problem: &Problem<'_, K, B>, squares: &Vector) -> Real {
        let deterministic = problem.deterministic();
        let residual = |row: usize| {
            let (error, model) = (self.relative_error(row), problem.variance(row, squares));
            // A ramp or a line is no variance with degrees of freedom.
            if problem.share_of(&deterministic, row, squares) > 0.5 {
                return problem.measured(row) - model;
            }
            let ratio = single(problem.measured(row) / model);
            // Residuals are in standard errors, which are relative to the model of the weights.
            real(deviance_residual(ratio, single(error))) * error * self.model[row]
        };
        self.whiten(problem, &|_| 1.0, &residual).norm_squared()
    }

    /// Sets the normal equations `A'C⁻¹A β = A'C⁻¹y`, one column at a time. The standard error of
    /// a row is enlarged by the factor `scatter(row)`. `more` holds further columns behind those of
    /// the model.
    #[inline(never)]
    pub(crate) fn equations(
        &self,
        problem: &Problem<'_, K, B>,
        scatter: &dyn Fn(usize) -> Real,
        more: &[Rows<K, B, f32>],
        right: &dyn Fn(usize) -> Real,
        equations: &mut NormalEquations,
    ) -> Result<(), Error> {
        let count = problem.count();
        let unit = |i: usize, k: usize| match i.checked_sub(count) {
            None => problem.unit(i, k),
            Some(at) => more.get(at).map_or(0.0, |column| real(column[k])),
        };
        equations.set(count.saturating_add(more.len()), &|i, row| {
            let column = self.solve(problem, scatter, &|k| unit(i, k));
            for j in 0..=i {
                row.put(j, problem.rows().map(|k| column[k] * unit(j, k)).sum());
            }
            problem.rows().map(|k| column[k] * right(k)).sum()
        })
    }

    /// The inverse of the covariance times a column of variances. The standard error of a row is enlarged by the
    /// factor `scatter(row)`.
    #[inline(never)]
    pub(crate) fn solve(
        &self,
        problem: &Problem<'_, K, B>,
        scatter: &dyn Fn(usize) -> Real,
        variance: &dyn Fn(usize) -> Real,
    ) -> Rows<K, B> {
        // This is in units of the squared errors first.
        let mut column = self.whiten(problem, scatter, variance);
        let (octaves, bins) = (problem.points.len(), problem.bins.len());
        self.factor.backward(octaves, bins, &mut column);
        for k in problem.rows() {
            let per_error = 1.0 / (self.model[k] * scatter(k));
            column.put(k, column[k] * per_error);
        }
        column
    }

    /// Expresses the measurement and the columns in units in which all rows are independent and have a
    /// variance of one.
    #[inline(never)]
    pub(crate) fn whiten_into(&self, problem: &Problem<'_, K, B>, whitened: &mut Whitened<K, B>) {
        whitened.columns.clear();
        for column in problem.columns() {
            // There is a place for the column of every effect.
            let _ = whitened
                .columns
                .push(self.whiten(problem, &|_| 1.0, &|k| real(column[k])));
        }
        whitened.curve = self.whiten(problem, &|_| 1.0, &|k| problem.measured(k));
    }

    /// One more column of variances in the same units.
    #[inline(never)]
    pub(crate) fn whiten(
        &self,
        problem: &Problem<'_, K, B>,
        scatter: &dyn Fn(usize) -> Real,
        variance: &dyn Fn(usize) -> Real,
    ) -> Rows<K, B> {
        let mut column = Rows::ZEROS;
        for k in problem.rows() {
            column.put(k, variance(k) / (self.model[k] * scatter(k)));
        }
        let (octaves, bins) = (problem.points.len(), problem.bins.len());
        self.factor.forward(octaves, bins, &mut column);
        column
    }

    /// Does the same in single precision, for a shape on trial. A core that has single precision in
    /// hardware takes a tenth of the time. With a tolerance granted, the numbers stay below some
    /// hundred standard errors. The column is in units of its largest number, which is returned too.
    pub(crate) fn whiten_trial(
        &self,
        problem: &Problem<'_, K, B>,
        variance: &dyn Fn(usize) -> Real,
    ) -> (Rows<K, B, f32>, Real) {
        let relative = |k: usize| variance(k) / self.model[k];
        let unit = problem.rows().map(relative).fold(0.0, Real::max);
        let mut column = Rows::ZEROS;
        for k in problem.rows() {
            column.put(k, single(relative(k) / unit));
        }
        let (octaves, bins) = (problem.points.len(), problem.bins.len());
        self.factor.forward(octaves, bins, &mut column);
        (column, unit)
    }
}

/// The measurement and the columns in units in which all rows are independent. Rows that there are not are zero.
pub(crate) struct Whitened<const K: usize, const B: usize> {
    pub(crate) columns: Vec<Rows<K, B>, MAX_EFFECTS>,
    pub(crate) curve: Rows<K, B>,
}

impl<const K: usize, const B: usize> Whitened<K, B> {
    // All zero, so that it is set where it stays and not moved there.
    pub(crate) const EMPTY: Self = Self {
        columns: Vec::new(),
        curve: Rows::ZEROS,
    };
}
