//! The correlations between the errors of fitted coefficients.

use super::{
    method::Method,
    problem::{Columns, Problem},
    result::Fit,
    shape::{Derivatives, ShapeEquations},
    weights::Weights,
};
use crate::{
    error::Error,
    evidence::record::Record,
    limits::{MAX_EFFECTS, PAIRS},
    numerics::{
        math,
        nnls::{NormalEquations, PassiveSet, Vector},
        real::{Real, real, single},
    },
    theory::model::Model,
};

/// Correlations of the squared coefficients of a fit, in which the fit is linear. The covariance of two
/// squared coefficients is `ρ_ij e_i e_j`, where `e` is
/// [`Coefficient::square_error`](crate::Coefficient::square_error).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Correlations {
    /// Lower triangle, row by row, without the diagonal.
    below: [f32; PAIRS],
}

/// The place in the triangle of column `low` in row `high`.
const fn place(high: usize, low: usize) -> usize {
    let row = high.saturating_mul(high.saturating_sub(1)) / 2;
    row.saturating_add(low)
}

impl Correlations {
    /// Correlations of coefficients of which nothing is known.
    pub(crate) const UNKNOWN: Self = Self {
        below: [f32::NAN; PAIRS],
    };

    /// Correlations from their triangle, row by row.
    #[cfg(feature = "storage")]
    pub(crate) const fn from_triangle(below: [f32; PAIRS]) -> Self {
        Self { below }
    }

    /// The rows of the triangle for the first `count` coefficients.
    #[cfg(feature = "storage")]
    pub(crate) fn triangle(&self, count: usize) -> &[f32] {
        let pairs = count * count.saturating_sub(1) / 2;
        &self.below[..pairs.min(PAIRS)]
    }

    /// The correlation of two squared coefficients, by their places in the model. It is 1 for a
    /// coefficient with itself and 0 with one that is zero. It is NaN beyond the model, or where the
    /// fit does not determine it.
    pub fn get(&self, i: usize, j: usize) -> Real {
        let (low, high) = if i < j { (i, j) } else { (j, i) };
        if low == high {
            return 1.0;
        }
        let known = self.below.get(place(high, low)).copied();
        real(known.unwrap_or(f32::NAN))
    }

    fn set(&mut self, i: usize, j: usize, correlation: Real) {
        if let Some(slot) = self.below.get_mut(place(i, j)) {
            *slot = single(correlation);
        }
    }
}

impl Fit {
    /// Correlations of the squared coefficients that were fitted to this curve with this model. They
    /// are those of the inverse of `A'C⁻¹A`, with the covariance `C` at the fitted model, and they
    /// include fitted shapes. They are NaN for methods other than [`Method::Covariance`].
    ///
    /// # Errors
    /// [`Error::Singular`] if the model or the curve is not that of the fit.
    pub fn correlations<'a, const K: usize, const B: usize>(
        &self,
        record: impl Into<Record<'a, K, B>>,
        model: &Model,
    ) -> Result<Correlations, Error> {
        let mut correlations = Correlations::UNKNOWN;
        if self.method != Method::Covariance {
            return Ok(correlations);
        }
        let count = model.terms().len();
        if count != self.coefficients.len() {
            return Err(Error::Singular);
        }
        let observed = record.into().observed();
        let columns = Columns::new(observed, model);
        let problem = Problem::new(observed, model, &columns);
        let squares = problem.squares_of(self);
        let free = PassiveSet::of(|i| i < MAX_EFFECTS && squares[i] > 0.0);
        let mut weights = Weights::EMPTY;
        weights.set(&problem, &squares, self.tolerance)?;
        let mut shape = ShapeEquations::EMPTY;
        let mut derivatives = Derivatives::NONE;
        derivatives.set(&problem, &squares);
        if shape.set(&problem, &weights, &squares, &derivatives) {
            correlations.take(count, &free, |i| shape.column(i, &free));
        } else {
            let mut equations = NormalEquations::EMPTY;
            weights.equations(&problem, &|_| 1.0, &[], &|_| 0.0, &mut equations)?;
            correlations.take(count, &free, |i| equations.column(i, &free));
        }
        Ok(correlations)
    }
}

impl Correlations {
    /// Computes the correlations from the columns of a covariance matrix.
    fn take(&mut self, count: usize, free: &PassiveSet, column: impl Fn(usize) -> Option<Vector>) {
        let mut variances = Vector::zeros();
        for i in 0..count {
            let own = if free.has(i) { column(i) } else { None };
            if let Some(own) = &own {
                variances.put(i, own[i]);
            }
            for j in 0..i {
                let correlation = match &own {
                    _ if !(free.has(i) && free.has(j)) => 0.0,
                    Some(own) => own[j] / math::sqrt(variances[i] * variances[j]),
                    None => Real::NAN,
                };
                self.set(i, j, correlation);
            }
        }
    }
}
