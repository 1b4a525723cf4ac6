//! Whether a coefficient that is hardly above zero may be zero.
//!
//! An interval takes the covariance of the curve at the solution. Where a long octave is low by chance, the solution
//! follows it and takes it for exact, and what other octaves have more than that passes for another coefficient: without
//! flicker noise, the interval of `B` or `R` excluded zero in 4 % of records of 11 minutes, where 2.5 % were promised
//! (`cargo xtask study clean`). A coefficient whose interval narrowly excludes zero is therefore tested against zero with
//! the covariance that the curve has if the coefficient is zero.

use super::{likelihood_ratio::LikelihoodRatio, problem::Problem, result::Fit, solver::Solver};
use crate::{
    fit::coefficient::State,
    limits::TWO_SIDED_95,
    numerics::{
        math,
        real::{Real, real},
    },
};

/// A coefficient is tested if the lower end of its interval is below this share of its value. The square then has
/// less than about four standard errors. The others are so far from zero that no covariance changes it.
const NARROW: Real = 0.7;

/// A skewness below this one moves no deviate of interest by more than 0.01. The difference of nearly equal numbers would
/// be lost in single precision.
const LEAST_SKEWNESS: Real = 0.02;

/// The test of the coefficients of a complete fit, one after the other. It works in the memory of the fit.
pub(crate) struct Significance {
    place: usize,
    test: Option<LikelihoodRatio>,
}

impl Significance {
    /// No coefficient tested yet.
    pub(crate) const NEW: Self = Self {
        place: 0,
        test: None,
    };

    /// Does one piece of work, no longer than one of the fit. Returns whether every coefficient is tested. One that may
    /// be zero becomes an upper bound. One without which nothing explains the curve stays as it is.
    #[inline(never)]
    pub(crate) fn advance<const K: usize, const B: usize>(
        &mut self,
        problem: &Problem<'_, K, B>,
        solver: &mut Solver<K, B>,
        fit: &mut Fit,
    ) -> bool {
        if let Some(test) = &mut self.test {
            let z = match test.advance(problem, solver) {
                Ok(None) => return false,
                Ok(Some(z)) => normal(z, skewness(problem, solver, self.place)),
                Err(_) => Real::INFINITY,
            };
            if z < real(TWO_SIDED_95) * fit.birge_ratio
                && let Some(coefficient) = fit.coefficients.get_mut(self.place)
            {
                coefficient.lower = 0.0;
                coefficient.state = State::UpperBound;
            }
            self.test = None;
            self.place = self.place.saturating_add(1);
            return false;
        }
        let needs_test = |place: usize| {
            let coefficient = fit.coefficients.get(place);
            coefficient.is_some_and(|coefficient| {
                let is_measured = coefficient.state == State::Measured;
                is_measured && coefficient.lower < NARROW * coefficient.value
            })
        };
        let mut places = self.place..fit.coefficients.len();
        let Some(place) = places.find(|&place| needs_test(place)) else {
            return true;
        };
        self.place = place;
        match LikelihoodRatio::begin(problem, solver, fit, self.place) {
            Ok(test) => self.test = Some(test),
            Err(_) => self.place = self.place.saturating_add(1),
        }
        false
    }
}

/// The skewness of a square's estimate by the weights and the equations of a solver. It is zero if the square cannot be
/// distinguished from others.
///
/// A variance with ν degrees of freedom has the third cumulant √(8/ν) times its cubed standard error. The octaves are
/// taken for independent in this.
#[inline(never)]
fn skewness<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    solver: &Solver<K, B>,
    place: usize,
) -> Real {
    let (equations, weights) = (&solver.equations, &solver.weights);
    let (_, free) = equations.solve_non_negative(&problem.pinned());
    let Some(covariances) = equations.covariances(place, &free.with(place)) else {
        return 0.0;
    };
    let column = |k: usize| -> Real {
        let terms = 0..problem.count();
        terms.map(|j| covariances[j] * problem.unit(j, k)).sum()
    };
    // The estimate is the sum of the octaves times these factors.
    let factors = weights.solve(problem, &|_| 1.0, &column);
    let error = math::sqrt(covariances[place]);
    let cumulant = |k: usize| {
        // Relative to the estimate's error, which keeps cubes within the range of numbers.
        let factor = factors[k] * weights.model[k] / error;
        let relative = weights.relative_error(k);
        // With ν = 2 / relative², √(8/ν) is twice the relative error.
        2.0 * relative * (factor * relative) * (factor * relative) * (factor * relative)
    };
    problem.rows().map(cumulant).sum()
}

/// The normal deviate that is exceeded as often as `z` standard errors of a variable with this skewness, which is taken
/// for a shifted χ² (Wilson & Hilferty 1931). A negative skewness makes large values rarer, and is not made use of.
fn normal(z: Real, skewness: Real) -> Real {
    // With ν = 8 / skewness² degrees of freedom, this is 2 / (9 ν).
    let share = skewness * skewness / 36.0;
    let ratio = 1.0 + 0.5 * z * skewness;
    if skewness <= LEAST_SKEWNESS || ratio <= 0.0 {
        return z;
    }
    let cube_root = math::exp(math::log(ratio) / 3.0);
    (cube_root - 1.0 + share) / math::sqrt(share)
}

#[cfg(test)]
mod tests;
