//! Compares every method with an independent computation.

use super::{OCTAVES, assert_relative, fitted, noisy, settings};
use allanite::{
    Curve, Model,
    effect::{IEEE_952, SampledShape},
    fit::{Method, Options, chi_squared_tail, curve_covariance},
};

/// The columns `A_k`: the variances of the effects with unit coefficients.
fn columns(curve: &Curve<OCTAVES>) -> Vec<[f64; 5]> {
    let shape = SampledShape::new(curve.interval_s());
    let points = curve.points().iter();
    points
        .map(|p| IEEE_952.map(|effect| effect.variance(f64::from(p.m), &shape)))
        .collect()
}

/// Solves `matrix · x = right` by elimination with pivoting.
fn eliminate(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs()));
        let pivot = pivot.expect("a row");
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        let (pivot, below) = matrix[i..].split_first_mut().expect("a row");
        for (row, offset) in below.iter_mut().zip(i + 1..) {
            let factor = row[i] / pivot[i];
            for (entry, above) in row.iter_mut().zip(pivot.iter()) {
                *entry -= factor * above;
            }
            right[offset] -= factor * right[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n)
            .map(|column| matrix[i][column] * right[column])
            .sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

/// The relative accuracy of an octave by its number of clusters, `N/m` (Lv et al. 2015). `N` is the
/// length of a contiguous record with this number of differences.
fn relative_accuracy(differences: u64, m: u32) -> f64 {
    let samples = (differences - 1) * u64::from((m / 4).max(1)) + 2 * u64::from(m);
    (0.5 / (samples as f64 / f64::from(m) - 1.0)).sqrt()
}

#[test]
fn unconstrained_methods_are_weighted_least_squares() {
    for seed in 0..10 {
        let curve = noisy(1 << 15, seed);
        let columns = columns(&curve);
        for method in [
            Method::Ordinary,
            Method::AccuratePart,
            Method::RelativeAccuracy,
            Method::ClusterCount,
        ] {
            let weights = curve.points().iter().map(|p| {
                let accuracy = relative_accuracy(p.differences, p.m);
                match method {
                    Method::Ordinary => 1.0,
                    Method::AccuratePart if accuracy <= 0.25 => 1.0,
                    Method::AccuratePart => 0.0,
                    Method::ClusterCount => accuracy.powi(-2),
                    _ => (accuracy * p.variance).powi(-2),
                }
            });
            let weights: Vec<f64> = weights.collect();
            // The columns are scaled to length one, because the sum would lose digits otherwise.
            let octaves = 0..columns.len();
            let product = |i: usize, j: usize| -> f64 {
                octaves
                    .clone()
                    .map(|k| weights[k] * columns[k][i] * columns[k][j])
                    .sum()
            };
            let units: Vec<f64> = (0..5).map(|i| product(i, i).sqrt()).collect();
            let matrix = |i: usize| {
                (0..5)
                    .map(|j| product(i, j) / units[i] / units[j])
                    .collect()
            };
            let right = |i: usize| -> f64 {
                let curve = curve.points().iter().zip(&columns).zip(&weights);
                curve
                    .map(|((p, row), w)| w * row[i] * p.variance / units[i])
                    .sum()
            };
            let solution = eliminate((0..5).map(matrix).collect(), (0..5).map(right).collect());
            let fit = fitted(&curve, settings(method));
            for (i, coefficient) in fit.coefficients.iter().enumerate() {
                let expected = solution[i] / units[i];
                let what = format!("{method:?}, {}", coefficient.name);
                assert_relative(coefficient.square, expected, 1e-5, &what);
                assert_eq!(
                    coefficient.value,
                    coefficient.square.max(0.0).sqrt(),
                    "{what}"
                );
            }
            let used = weights.iter().filter(|weight| **weight > 0.0).count();
            let left_out = curve.points().len() - used;
            assert_eq!(left_out > 0, method == Method::AccuratePart);
            assert_eq!(fit.degrees_of_freedom, used - 5);
            if method == Method::RelativeAccuracy {
                let squares = fit.squares();
                let residuals = curve.points().iter().zip(&columns).zip(&weights);
                let chi_squared: f64 = residuals
                    .map(|((p, row), w)| {
                        let model: f64 = row.iter().zip(&squares).map(|(a, b)| a * b).sum();
                        w * (p.variance - model).powi(2)
                    })
                    .sum();
                assert_relative(fit.chi_squared, chi_squared, 1e-5, "χ²");
                assert_eq!(
                    fit.p_value,
                    chi_squared_tail(fit.chi_squared, fit.degrees_of_freedom)
                );
            } else {
                assert!(fit.chi_squared.is_nan() && fit.p_value.is_nan());
            }
            assert!(fit.minus_two_log_likelihood.is_nan());
        }
    }
}

/// The generalised least-squares problem at a solution.
struct Optimum {
    /// The gradient with respect to each coefficient, as the number of standard errors that the
    /// coefficient would move if it were the only one.
    pulls: [f64; 5],
    /// The value of `r'C⁻¹r`.
    squared_residuals: f64,
    /// χ², which is that less twice the sum of the relative residuals (Farrington 1996).
    chi_squared: f64,
    /// The value of `ln det C`.
    log_determinant: f64,
}

impl Optimum {
    fn new(curve: &Curve<OCTAVES>, squares: &[f64]) -> Self {
        let columns = columns(curve);
        let count = columns.len();
        let covariance = curve_covariance(curve, &Model::ieee_952(), squares);
        // The matrix is divided by the model to keep its digits.
        let model = |k: usize| -> f64 { columns[k].iter().zip(squares).map(|(a, b)| a * b).sum() };
        let row = |k: usize| {
            let entry = |j: usize| covariance[(j, k)] / (model(j) * model(k));
            (0..count).map(entry).collect()
        };
        let solve = |right: &[f64]| eliminate((0..count).map(row).collect(), right.to_vec());
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let points = curve.points().iter().enumerate();
        let residual: Vec<f64> = points.map(|(k, p)| p.variance / model(k) - 1.0).collect();
        let weighted = solve(&residual);
        let pulls = std::array::from_fn(|i| {
            let column: Vec<f64> = (0..count).map(|k| columns[k][i] / model(k)).collect();
            dot(&column, &weighted) / dot(&column, &solve(&column)).sqrt()
        });
        let mut filled = covariance;
        (count..OCTAVES).for_each(|k| filled[(k, k)] = 1.0);
        let factor = filled.cholesky().expect("positive definite");
        Self {
            pulls,
            squared_residuals: dot(&residual, &weighted),
            chi_squared: dot(&residual, &weighted) - 2.0 * residual.iter().sum::<f64>(),
            log_determinant: factor.ln_determinant(),
        }
    }
}

/// The conditions of Karush, Kuhn and Tucker hold at the minimum of `r'C⁻¹r` with `β ≥ 0`, where
/// `C` is the covariance at the solution: the gradient is zero along coefficients above zero, and
/// it does not fall along those at zero. The rounds of covariance and solution end when the model
/// changes by a thousandth, or after a fixed number. In a few records the solution is then still a
/// fraction of a standard error away.
#[test]
fn the_covariance_fit_is_the_non_negative_optimum() {
    let (mut at_zero, mut above, mut slow) = (0, 0, 0);
    for (exponent, seed) in (0..12).flat_map(|seed| [10, 13, 16].map(|exponent| (exponent, seed))) {
        let curve = noisy(1 << exponent, seed);
        let no_tolerance = Options {
            tolerance: 0.0,
            ..Options::default()
        };
        let fit = fitted(&curve, no_tolerance);
        assert_eq!((fit.tolerance, fit.shrinkage), (0.0, 0.0));
        let optimum = Optimum::new(&curve, &fit.squares());
        let mut farthest: f64 = 0.0;
        for (coefficient, pull) in fit.coefficients.iter().zip(optimum.pulls) {
            assert!(coefficient.square >= 0.0, "{coefficient:?}");
            if coefficient.square > 0.0 {
                above += 1;
                farthest = farthest.max(pull.abs());
            } else {
                at_zero += 1;
                farthest = farthest.max(pull);
            }
        }
        let what = format!("2^{exponent} samples, seed {seed}");
        assert!(farthest < 0.25, "{what}: {:?}", optimum.pulls);
        let active = fit.coefficients.iter().filter(|c| c.square > 0.0).count();
        assert_eq!(
            fit.degrees_of_freedom,
            curve.points().len() - active,
            "{what}"
        );
        assert_eq!(
            fit.p_value,
            chi_squared_tail(fit.chi_squared, fit.degrees_of_freedom)
        );
        if farthest > 0.03 {
            slow += 1;
            continue;
        }
        assert_relative(fit.chi_squared, optimum.chi_squared, 0.02, &what);
        let likelihood = optimum.squared_residuals + optimum.log_determinant;
        let difference = fit.minus_two_log_likelihood - likelihood;
        assert!(difference.abs() < 0.1, "{what}, −2 ln L: {difference}");
    }
    assert!(slow <= 2, "{slow} of 36 records");
    assert!(
        at_zero > 10 && above > 10,
        "{at_zero} at zero, {above} above"
    );
}
