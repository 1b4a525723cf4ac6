//! The fit on exact curves, under changes of unit, at its optimum, and where it must refuse.

use allanite::{
    Coefficient, Curve, Error, Fit, Method, Model, Settings, State, chi_squared_tail,
    curve_covariance,
    effect::{AngleRandomWalk, Effect, IEEE_952, RateRamp, Setting},
    fit,
};
use host_tests::{simulate::Preset, study};
use rayon::prelude::*;

const OCTAVES: usize = study::OCTAVES;
const RATE_HZ: f64 = 100.0;
const METHODS: [Method; 4] = [
    Method::Ordinary,
    Method::RelativeAccuracy,
    Method::ClusterCount,
    Method::Covariance,
];

/// Coefficients Q, N, B, K, R, all of which show in some octave of a three-hour record.
const ALL: [f64; 5] = [2e-4, 5e-3, 4e-3, 3e-4, 3e-6];

fn settings(method: Method) -> Settings {
    Settings {
        method,
        ..Settings::default()
    }
}

/// The curve that a gyro would have on average, for a record of so many samples.
fn exact(coefficients: [f64; 5], samples: u64, rate_hz: f64) -> Curve<OCTAVES> {
    let model = Model::ieee_952();
    let squares = coefficients.map(|x| x * x);
    let octave = |k: u32| {
        let m = 1_u64 << k;
        let differences = (samples.checked_sub(2 * m)?) / (m / 4).max(1) + 1;
        let variance = model.variance(&squares, m as u32, 1.0 / rate_hz);
        (differences >= 6).then_some((m as u32, differences, variance))
    };
    Curve::new(rate_hz, (0..OCTAVES as u32).map_while(octave)).expect("possible")
}

/// The same curve with every variance changed by its octave's factor.
fn changed(curve: &Curve<OCTAVES>, factor: impl Fn(usize) -> f64) -> Curve<OCTAVES> {
    let points = curve.points().iter().enumerate();
    let octaves = points.map(|(k, p)| (p.m, p.differences, p.variance * factor(k)));
    Curve::new(curve.rate_hz(), octaves).expect("possible")
}

/// The curve of a simulated record.
fn noisy(samples: usize, seed: u64) -> Curve<OCTAVES> {
    study::curve(Preset::Mems.coefficients(), samples, seed)
}

fn fitted(curve: &Curve<OCTAVES>, settings: Settings) -> Fit {
    fit(curve, &Model::ieee_952(), settings).expect("a curve to fit")
}

fn assert_relative(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}

#[test]
fn coefficients_of_an_exact_curve_come_back_by_every_method() {
    for method in METHODS {
        let fit = fitted(&exact(ALL, 1 << 20, RATE_HZ), settings(method));
        assert_eq!(fit.method, method);
        for (coefficient, truth) in fit.coefficients.iter().zip(ALL) {
            assert_relative(coefficient.value, truth, 1e-6, coefficient.name);
            assert_relative(coefficient.square, truth * truth, 1e-6, "square");
        }
    }
}

#[test]
fn every_term_of_a_long_record_is_measured_within_its_interval() {
    let fit = fitted(&exact(ALL, 1 << 20, RATE_HZ), Settings::default());
    for (coefficient, effect) in fit.coefficients.iter().zip(IEEE_952) {
        assert_eq!(coefficient.name, effect.name());
        assert_eq!(coefficient.symbol, effect.symbol());
        assert_eq!(coefficient.half_seconds, effect.half_seconds());
        let Coefficient {
            value,
            lower,
            upper,
            square,
            square_error,
            ..
        } = *coefficient;
        if coefficient.state == State::Measured {
            assert!(
                0.0 < lower && lower < value && value < upper,
                "{coefficient:?}"
            );
            assert_relative(
                lower * lower,
                square - 1.959_964 * square_error,
                1e-9,
                "lower",
            );
            assert_relative(
                upper * upper,
                square + 1.959_964 * square_error,
                1e-9,
                "upper",
            );
        }
    }
    // The ramp of 3e-6 stays below the scatter of the longest octaves.
    let measured = fit.coefficients.iter().map(|c| c.state == State::Measured);
    assert_eq!(
        measured.collect::<Vec<_>>(),
        [true, true, true, true, false]
    );
    assert!(fit.chi_squared < 1e-6 && fit.p_value > 0.999_999);
    assert_eq!((fit.tolerance, fit.shrinkage), (0.0, 0.0));
    assert_eq!(
        fit.squares()[..5],
        fit.coefficients
            .iter()
            .map(|c| c.square)
            .collect::<Vec<_>>()
    );
}

#[test]
fn a_term_that_is_absent_is_never_measured() {
    for absent in 0..5 {
        for exponent in [10, 14, 18, 22] {
            let mut coefficients = ALL;
            coefficients[absent] = 0.0;
            let fit = fitted(
                &exact(coefficients, 1 << exponent, RATE_HZ),
                Settings::default(),
            );
            let found = fit.coefficients[absent];
            let what = format!("2^{exponent} samples: {found:?}");
            // Rounding, far below what the record tells.
            assert!(found.square <= 1e-6 * found.square_error, "{what}");
            assert_eq!(found.lower, 0.0, "{what}");
            match found.state {
                State::Measured => panic!("{what}"),
                State::UpperBound => {
                    assert!(found.upper > 0.0 && found.upper.is_finite(), "{what}");
                }
                State::NotObservable { after_s } => {
                    let length_s = f64::from(1 << exponent) / RATE_HZ;
                    assert!(after_s.is_none_or(|after_s| after_s > length_s), "{what}");
                }
            }
        }
    }
}

/// A term that is not observable would be after the length that is told, if it were at its bound.
#[test]
fn a_record_of_the_length_that_is_told_measures_the_term() {
    let mut told = 0;
    for absent in 0..5 {
        for exponent in [10, 12, 14, 16] {
            let mut coefficients = ALL;
            coefficients[absent] = 0.0;
            let fit = fitted(
                &exact(coefficients, 1 << exponent, RATE_HZ),
                Settings::default(),
            );
            let found = fit.coefficients[absent];
            let State::NotObservable {
                after_s: Some(after_s),
            } = found.state
            else {
                continue;
            };
            told += 1;
            // The other terms as they were found, this one at its bound.
            let mut assumed = [0.0; 5];
            for (assumed, coefficient) in assumed.iter_mut().zip(&fit.coefficients) {
                *assumed = coefficient.value;
            }
            assumed[absent] = found.upper;
            let samples = (after_s * RATE_HZ).round() as u64;
            let later = fitted(&exact(assumed, samples, RATE_HZ), Settings::default());
            let state = later.coefficients[absent].state;
            assert_eq!(state, State::Measured, "2^{exponent} samples, {found:?}");
        }
    }
    assert!(told > 0);
}

#[test]
fn coefficients_scale_with_the_unit_of_the_rate() {
    // From degrees to radians, and to something absurd.
    for factor in [std::f64::consts::PI / 180.0, 1e9] {
        for method in METHODS {
            let curve = noisy(1 << 14, 3);
            let scaled = changed(&curve, |_| factor * factor);
            let (one, other) = (
                fitted(&curve, settings(method)),
                fitted(&scaled, settings(method)),
            );
            for (one, other) in one.coefficients.iter().zip(&other.coefficients) {
                let what = format!("{method:?}, {}", one.name);
                for (one, other) in [
                    (one.value, other.value),
                    (one.lower, other.lower),
                    (one.upper, other.upper),
                    (one.square_error.sqrt(), other.square_error.sqrt()),
                ] {
                    assert!(
                        (other - factor * one).abs() <= 1e-6 * (factor * one).abs(),
                        "{what}: {one:e}, {other:e}"
                    );
                }
                assert_eq!(
                    std::mem::discriminant(&one.state),
                    std::mem::discriminant(&other.state),
                    "{what}"
                );
            }
            if !one.chi_squared.is_nan() {
                assert_relative(other.chi_squared, one.chi_squared, 1e-6, "χ²");
                assert_relative(other.p_value, one.p_value, 1e-6, "p-value");
            }
        }
    }
}

#[test]
fn coefficients_scale_with_the_unit_of_time() {
    for method in METHODS {
        let curve = noisy(1 << 14, 4);
        let slower = 16.0;
        let octaves = curve
            .points()
            .iter()
            .map(|p| (p.m, p.differences, p.variance));
        let later = Curve::new(curve.rate_hz() / slower, octaves).expect("possible");
        let (one, other) = (
            fitted(&curve, settings(method)),
            fitted(&later, settings(method)),
        );
        for (one, other) in one.coefficients.iter().zip(&other.coefficients) {
            let unit = slower.sqrt().powi(i32::from(one.half_seconds));
            let what = format!("{method:?}, {}", one.name);
            assert!(
                (other.value - unit * one.value).abs() <= 1e-6 * unit * one.value,
                "{what}"
            );
            assert!(
                (other.upper - unit * one.upper).abs() <= 1e-6 * unit * one.upper,
                "{what}"
            );
        }
        if !one.chi_squared.is_nan() {
            assert_relative(other.chi_squared, one.chi_squared, 1e-6, "χ²");
        }
    }
}

/// `A_k`, the variances of unit coefficients.
fn columns(curve: &Curve<OCTAVES>) -> Vec<[f64; 5]> {
    let setting = Setting::new(curve.interval_s());
    let points = curve.points().iter();
    points
        .map(|p| IEEE_952.map(|effect| effect.variance(f64::from(p.m), &setting)))
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

/// Relative accuracy of an octave with clusters `N/m` as of a contiguous record: Lv et al. 2015.
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
            Method::RelativeAccuracy,
            Method::ClusterCount,
        ] {
            let weights = curve.points().iter().map(|p| {
                let accuracy = relative_accuracy(p.differences, p.m);
                match method {
                    Method::Ordinary => 1.0,
                    Method::ClusterCount => accuracy.powi(-2),
                    _ => (accuracy * p.variance).powi(-2),
                }
            });
            let weights: Vec<f64> = weights.collect();
            // In columns of length one, as the sum would lose digits otherwise.
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
            assert_eq!(fit.degrees_of_freedom, curve.points().len() - 5);
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
    /// Standard errors that each coefficient would move by if it were alone.
    pulls: [f64; 5],
    /// `r'C⁻¹r`.
    chi_squared: f64,
    /// `ln det C`.
    log_determinant: f64,
}

impl Optimum {
    fn new(curve: &Curve<OCTAVES>, squares: &[f64]) -> Self {
        let columns = columns(curve);
        let count = columns.len();
        let covariance = curve_covariance(curve, &Model::ieee_952(), squares);
        // Relative to the model, for the digits' sake.
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
            chi_squared: dot(&residual, &weighted),
            log_determinant: factor.ln_determinant(),
        }
    }
}

/// The optimality conditions of Karush, Kuhn and Tucker for `min r'C⁻¹r` with `β ≥ 0`, `C` being the
/// covariance at the solution: the gradient is zero along coefficients above zero and does not
/// fall along those at zero. The rounds of covariance and solution end when the model changes by a
/// thousandth, or after some: a few records are then still a part of a standard error away.
#[test]
fn the_covariance_fit_is_the_non_negative_optimum() {
    let (mut at_zero, mut above, mut slow) = (0, 0, 0);
    for (exponent, seed) in (0..12).flat_map(|seed| [10, 13, 16].map(|exponent| (exponent, seed))) {
        let curve = noisy(1 << exponent, seed);
        let no_tolerance = Settings {
            tolerance: 0.0,
            ..Settings::default()
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
        let likelihood = optimum.chi_squared + optimum.log_determinant;
        let difference = fit.minus_two_log_likelihood - likelihood;
        assert!(difference.abs() < 0.1, "{what}, −2 ln L: {difference}");
    }
    assert!(slow <= 2, "{slow} of 36 records");
    assert!(
        at_zero > 10 && above > 10,
        "{at_zero} at zero, {above} above"
    );
}

#[test]
fn chi_squared_matches_its_degrees_of_freedom_over_many_records() {
    let ratios: Vec<f64> = (0..40)
        .into_par_iter()
        .map(|seed| {
            let fit = fitted(&noisy(1 << 15, seed), Settings::default());
            fit.chi_squared / fit.degrees_of_freedom as f64
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    // The mean of 40 has a standard error of 0.07.
    assert!(
        (0.7..1.3).contains(&mean),
        "χ² is {mean} of its degrees of freedom"
    );
    assert!(ratios.iter().all(|ratio| *ratio < 4.0), "{ratios:?}");
}

#[test]
fn longer_records_narrow_every_interval() {
    let mut coefficients = ALL;
    coefficients[4] = 0.0;
    let widths = |exponent: u32| -> Vec<f64> {
        let fit = fitted(
            &exact(coefficients, 1 << exponent, RATE_HZ),
            Settings::default(),
        );
        fit.coefficients.iter().map(|c| c.upper - c.lower).collect()
    };
    let mut before = widths(12);
    for exponent in 13..=26 {
        let now = widths(exponent);
        for (i, (now, before)) in now.iter().zip(&before).enumerate() {
            let name = IEEE_952[i].name();
            // Bounds hold to a per cent, as do the rounds that find them.
            assert!(
                *now < 1.01 * before,
                "{name} at 2^{exponent} samples: {now:e} after {before:e}"
            );
        }
        before = now;
    }
    // Where a term is measured well, four times the record is half the interval.
    let (short, long) = (widths(20), widths(22));
    for i in 0..4 {
        assert_relative(long[i] / short[i], 0.5, 0.1, IEEE_952[i].name());
    }
}

#[test]
fn the_tolerance_is_granted_only_where_scatter_does_not_explain_the_curve() {
    let curve = exact(ALL, 1 << 26, RATE_HZ);
    let dented = changed(&curve, |k| if k == 4 { 1.01 } else { 1.0 });
    let tolerance = |tolerance| Settings {
        tolerance,
        ..Settings::default()
    };
    let strict = fitted(&dented, tolerance(0.0));
    assert!(
        strict.p_value < 1e-6 && strict.tolerance == 0.0,
        "{strict:?}"
    );
    let lenient = fitted(&dented, tolerance(0.01));
    assert!(
        lenient.p_value > 0.05 && lenient.tolerance == 0.01,
        "{lenient:?}"
    );
    assert!(lenient.coefficients[1].square_error > strict.coefficients[1].square_error);
    assert_eq!(fitted(&curve, tolerance(0.01)).tolerance, 0.0);
}

#[test]
fn too_few_octaves_are_refused_by_number() {
    let curve = exact(ALL, 40, RATE_HZ);
    let found = curve.points().len();
    assert_eq!(found, 4);
    for method in METHODS {
        let found = fit(&curve, &Model::ieee_952(), settings(method)).map(|fit| fit.method);
        let refused = Err(Error::TooFewOctaves {
            found: 4,
            needed: 5,
        });
        assert_eq!(
            found,
            if method == Method::Covariance {
                Ok(method)
            } else {
                refused
            }
        );
    }
    let octave = Curve::<OCTAVES>::new(1.0, [(1, 100, 1.0)]).expect("possible");
    let found = fit(&octave, &Model::ieee_952(), Settings::default());
    assert_eq!(
        found,
        Err(Error::TooFewOctaves {
            found: 1,
            needed: 2
        })
    );
    let empty = Curve::<OCTAVES>::new(1.0, []).expect("possible");
    for method in METHODS {
        let found = fit(&empty, &Model::ieee_952(), settings(method));
        assert!(
            matches!(found, Err(Error::TooFewOctaves { found: 0, .. })),
            "{found:?}"
        );
    }
}

#[test]
fn a_curve_without_noise_is_refused_by_its_octave() {
    let flat = changed(&exact(ALL, 1 << 12, RATE_HZ), |k| {
        if k >= 3 { 0.0 } else { 1.0 }
    });
    for method in METHODS {
        let found = fit(&flat, &Model::ieee_952(), settings(method));
        assert_eq!(found, Err(Error::NoNoise { m: 8 }));
    }
}

#[test]
fn effects_that_cannot_be_told_apart_are_refused_or_not_observable() {
    let curve = exact(ALL, 1 << 14, RATE_HZ);
    let twice: [&'static dyn Effect; 3] = [&AngleRandomWalk, &RateRamp, &AngleRandomWalk];
    let model = Model::new(&twice).expect("three effects");
    for method in [
        Method::Ordinary,
        Method::RelativeAccuracy,
        Method::ClusterCount,
    ] {
        assert_eq!(fit(&curve, &model, settings(method)), Err(Error::Singular));
    }
    let found = fit(&curve, &model, Settings::default()).expect("one of the two");
    let states: Vec<State> = [0, 2].map(|i| found.coefficients[i].state).to_vec();
    let not_observable = |state: &State| matches!(state, State::NotObservable { .. });
    assert!(states.iter().any(not_observable), "{states:?}");
    // Nothing to fit is nothing to tell.
    assert_eq!(
        fit(&curve, &Model::default(), Settings::default()),
        Err(Error::Singular)
    );
}

#[test]
fn variances_of_any_size_fit_or_are_refused() {
    let curve = exact(ALL, 1 << 14, RATE_HZ);
    for exponent in (-150..=150).step_by(10) {
        let scaled = changed(&curve, |_| 10_f64.powi(exponent));
        for method in METHODS {
            match fit(&scaled, &Model::ieee_952(), settings(method)) {
                Ok(fit) => {
                    let expected = ALL[1] * 10_f64.powi(exponent).sqrt();
                    let what = format!("{method:?} at 10^{exponent}");
                    assert_relative(fit.coefficients[1].value, expected, 1e-3, &what);
                }
                Err(error) => {
                    assert_eq!(error, Error::Singular);
                    assert!(exponent.abs() >= 130, "{method:?} at 10^{exponent}");
                }
            }
        }
    }
}

#[test]
fn a_model_has_room_for_eight_effects() {
    let nine: [&'static dyn Effect; 9] = [&AngleRandomWalk; 9];
    assert!(Model::new(&nine[..8]).is_ok_and(|model| model.terms().len() == 8));
    let refused = Model::new(&nine).map(|model| model.terms().len());
    assert_eq!(refused, Err(Error::TooManyEffects { capacity: 8 }));
}
