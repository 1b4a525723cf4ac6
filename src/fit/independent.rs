//! Fits that take octaves for independent: the paper's, and the start of ours.

use super::{Fit, Method, Problem, relative_accuracy, squared};
use crate::{
    chi_squared::chi_squared_tail,
    coefficient::Coefficient,
    curve::Point,
    error::Error,
    nnls::{Matrix, NormalEquations, Vector},
};

/// The normal equations of weighted, independent octaves.
pub(super) fn equations<const K: usize>(
    problem: &Problem<'_, K>,
    weight: impl Fn(&Point) -> f64,
) -> Result<NormalEquations, Error> {
    let (mut matrix, mut right): (Matrix, Vector) = (Matrix::zeros(), Vector::zeros());
    let count = problem.count();
    for (k, point) in problem.points.iter().enumerate() {
        let w = weight(point);
        for i in 0..count {
            let weighted = w * problem.columns[i][k];
            for j in 0..=i {
                matrix[(i, j)] += weighted * problem.columns[j][k];
                matrix[(j, i)] = matrix[(i, j)];
            }
            right[i] += weighted * point.variance;
        }
    }
    NormalEquations::new(&matrix, &right, problem.count())
}

/// The inverse square of an octave's standard error, `δσ̂²`.
pub(super) fn by_relative_accuracy(point: &Point) -> f64 {
    1.0 / squared(relative_accuracy(point) * point.variance)
}

/// An unconstrained fit.
pub(super) fn fit<const K: usize>(problem: &Problem<'_, K>, method: Method) -> Result<Fit, Error> {
    let weight = |point: &Point| match method {
        Method::Ordinary => 1.0,
        Method::ClusterCount => 1.0 / squared(relative_accuracy(point)),
        _ => by_relative_accuracy(point),
    };
    let equations = equations(problem, weight)?;
    let squares = equations.solve()?;
    let free = core::array::from_fn(|i| i < problem.count());
    let mut covariance = equations.covariance(&free).ok_or(Error::Singular)?;
    let residuals =
        problem.points.iter().enumerate().map(|(k, point)| {
            weight(point) * squared(point.variance - problem.variance(k, &squares))
        });
    let mut chi_squared: f64 = residuals.sum();
    let degrees_of_freedom = problem.points.len() - problem.count();
    if method != Method::RelativeAccuracy {
        // No error model: the residuals themselves give the scale.
        covariance *= chi_squared / degrees_of_freedom.max(1) as f64;
        chi_squared = f64::NAN;
    }
    let terms = problem.model.terms().iter().enumerate();
    let coefficients = terms
        .map(|(i, term)| Coefficient::new(term.effect, squares[i], Some(covariance[(i, i)])))
        .collect();
    Ok(Fit {
        method,
        coefficients,
        shape: heapless::Vec::new(),
        chi_squared,
        degrees_of_freedom,
        p_value: chi_squared_tail(chi_squared, degrees_of_freedom),
        minus_two_log_likelihood: f64::NAN,
        tolerance: 0.0,
        shrinkage: 0.0,
    })
}
