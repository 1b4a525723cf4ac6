//! Fits that take octaves for independent. They are the methods of Lv, Liu, Lai & Huang 2015, and the
//! start of the fit by the covariance.

use super::{
    method::Method,
    problem::{Problem, relative_accuracy},
    result::Fit,
};
use crate::{
    curve::Point,
    error::Error,
    fit::coefficient::Coefficient,
    list::{self, numbered},
    numerics::{
        chi_squared::chi_squared_tail,
        nnls::{Interval, NormalEquations, PassiveSet},
        real::Real,
    },
};

/// Sets the normal equations of weighted octaves and bins that are taken for independent.
pub(super) fn equations<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    weight: impl Fn(usize) -> Real,
    equations: &mut NormalEquations,
) -> Result<(), Error> {
    let sum = |i: usize, other: &dyn Fn(usize) -> Real| -> Real {
        let rows = problem.rows();
        rows.map(|row| weight(row) * problem.unit(i, row) * other(row))
            .sum()
    };
    equations.set(problem.count(), &|i, row| {
        for j in 0..=i {
            row.put(j, sum(i, &|k| problem.unit(j, k)));
        }
        sum(i, &|k| problem.measured(k))
    })
}

/// The inverse square of a row's standard error, which is `δσ̂²` for the measured variance.
pub(super) fn by_relative_accuracy<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    row: usize,
) -> Real {
    let error = problem.relative_accuracy(row) * problem.measured(row);
    1.0 / (error * error)
}

/// The largest relative accuracy of an octave that `Method::AccuratePart` uses.
const ACCURATE: Real = 0.25;

/// An unconstrained fit.
///
/// # Errors
/// [`Error::TooFewOctaves`] if the method leaves out so many octaves that fewer than there are effects
/// remain. [`Error::Singular`] if the equations have no solution.
pub(super) fn fit<const K: usize, const B: usize>(
    problem: &Problem<'_, K, B>,
    method: Method,
) -> Result<Fit, Error> {
    let is_used =
        |point: &&Point| method != Method::AccuratePart || relative_accuracy(point) <= ACCURATE;
    let octaves = list::count(problem.points.iter().filter(is_used));
    let needed = problem.count();
    if octaves < needed {
        return Err(Error::TooFewOctaves {
            found: octaves,
            needed,
        });
    }
    let weight = |row: usize| match method {
        _ if !problem.points.get(row).is_some_and(|point| is_used(&point)) => 0.0,
        Method::Ordinary | Method::AccuratePart => 1.0,
        Method::ClusterCount => {
            let error = problem.relative_accuracy(row);
            1.0 / (error * error)
        }
        _ => by_relative_accuracy(problem, row),
    };
    let mut equations = NormalEquations::EMPTY;
    self::equations(problem, weight, &mut equations)?;
    let squares = equations.solve()?;
    let free = PassiveSet::of(|i| i < problem.count());
    let residuals = problem.rows().map(|row| {
        let residual = problem.measured(row) - problem.variance(row, &squares);
        weight(row) * residual * residual
    });
    let mut chi_squared: Real = residuals.sum();
    let degrees_of_freedom = octaves.saturating_sub(needed);
    let mut scale = 1.0;
    if method != Method::RelativeAccuracy {
        // These methods have no error model: the residuals themselves give the scale.
        scale = chi_squared / degrees_of_freedom.max(1) as Real;
        chi_squared = Real::NAN;
    }
    let mut coefficients = heapless::Vec::new();
    for (i, term) in numbered(problem.model.terms().iter()) {
        let variance = equations.variance(i, &free).ok_or(Error::Singular)?;
        // There is a place for every effect of a model.
        let interval = Interval::normal(squares[i], scale * variance, 1.0);
        let coefficient = Coefficient::new(term.effect, squares[i], Some(interval));
        let _ = coefficients.push(coefficient.in_unit(problem.variance_unit));
    }
    Ok(Fit {
        method,
        coefficients,
        shape: heapless::Vec::new(),
        chi_squared,
        degrees_of_freedom,
        deviance: Real::NAN,
        p_value: chi_squared_tail(chi_squared, degrees_of_freedom),
        peak: None,
        minus_two_log_likelihood: Real::NAN,
        tolerance: 0.0,
        shrinkage: 0.0,
        birge_ratio: 1.0,
    })
}
