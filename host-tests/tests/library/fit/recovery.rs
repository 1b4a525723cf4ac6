//! A fit recovers the coefficients of a curve and their intervals.

use super::{ALL, METHODS, RATE_HZ, assert_relative, changed, exact, fitted, noisy, settings};
use allanite::{
    Coefficient, Curve,
    effect::IEEE_952,
    fit::{Fit, Options, State},
};
use rayon::prelude::*;

#[test]
fn every_method_recovers_the_coefficients_of_an_exact_curve() {
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
    let fit = fitted(&exact(ALL, 1 << 20, RATE_HZ), Options::default());
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
            // The other terms are not free to be negative, which changes the ends a little.
            assert_relative(
                lower * lower,
                square - 1.959_964 * square_error,
                0.02,
                "lower",
            );
            assert_relative(
                upper * upper,
                square + 1.959_964 * square_error,
                0.02,
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

/// A fit of all five terms to the exact curve of 2^exponent samples that lacks one of them.
fn fitted_without(absent: usize, exponent: u32) -> Fit {
    let mut coefficients = ALL;
    coefficients[absent] = 0.0;
    let curve = exact(coefficients, 1 << exponent, RATE_HZ);
    fitted(&curve, Options::default())
}

#[test]
fn a_term_that_is_absent_is_never_measured() {
    for absent in 0..5 {
        for exponent in [10, 14, 18, 22] {
            let found = fitted_without(absent, exponent).coefficients[absent];
            let what = format!("2^{exponent} samples: {found:?}");
            // The remainder is rounding, far below the noise of the record.
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

/// A term is called not observable together with the length of record that would show it. If the
/// term is at its bound, it must be observable in a record of that length.
#[test]
fn a_record_of_the_stated_length_measures_the_term() {
    let mut told = 0;
    for absent in 0..5 {
        for exponent in [10, 12, 14, 16] {
            let fit = fitted_without(absent, exponent);
            let found = fit.coefficients[absent];
            let State::NotObservable {
                after_s: Some(after_s),
            } = found.state
            else {
                continue;
            };
            told += 1;
            // The other terms keep their values, and this one is at its bound.
            let mut assumed = [0.0; 5];
            for (assumed, coefficient) in assumed.iter_mut().zip(&fit.coefficients) {
                *assumed = coefficient.value;
            }
            assumed[absent] = found.upper;
            let samples = (after_s * RATE_HZ).round() as u64;
            let later = fitted(&exact(assumed, samples, RATE_HZ), Options::default());
            let state = later.coefficients[absent].state;
            assert_eq!(state, State::Measured, "2^{exponent} samples, {found:?}");
        }
    }
    assert!(told > 0);
}

#[test]
fn coefficients_scale_with_the_unit_of_the_rate() {
    // The factors go from degrees to radians, and to an absurd unit.
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

#[test]
fn chi_squared_matches_its_degrees_of_freedom_over_many_records() {
    let ratios: Vec<f64> = (0..40)
        .into_par_iter()
        .map(|seed| {
            let fit = fitted(&noisy(1 << 15, seed), Options::default());
            fit.chi_squared / fit.degrees_of_freedom as f64
        })
        .collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    // The mean of 40 values has a standard error of 0.07.
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
            Options::default(),
        );
        fit.coefficients.iter().map(|c| c.upper - c.lower).collect()
    };
    let mut before = widths(12);
    for exponent in 13..=26 {
        let now = widths(exponent);
        for (i, (now, before)) in now.iter().zip(&before).enumerate() {
            let name = IEEE_952[i].name();
            // Bounds are accurate to one per cent, like the rounds that find them.
            assert!(
                *now < 1.01 * before,
                "{name} at 2^{exponent} samples: {now:e} after {before:e}"
            );
        }
        before = now;
    }
    // If a term is measured well, a record of four times the length halves its interval.
    let (short, long) = (widths(22), widths(24));
    for i in 0..4 {
        assert_relative(long[i] / short[i], 0.5, 0.1, IEEE_952[i].name());
    }
}

#[test]
fn the_tolerance_is_used_only_if_scatter_does_not_explain_the_curve() {
    let curve = exact(ALL, 1 << 26, RATE_HZ);
    let dented = changed(&curve, |k| if k == 4 { 1.01 } else { 1.0 });
    let tolerance = |tolerance| Options {
        tolerance,
        ..Options::default()
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
