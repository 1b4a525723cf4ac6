//! Compares the tail of the χ² distribution with tables and with two other computations.

use allanite::fit::chi_squared_tail;
use statrs::function::gamma::{gamma_ur, ln_gamma};

/// The quantiles of Abramowitz & Stegun 1964, table 26.8. Each row has the degrees of freedom and
/// then the values of χ² that are exceeded with probability 0.995, 0.95, 0.5, 0.05, 0.01 and 0.001.
#[rustfmt::skip]
const TABLE: [(usize, [f64; 6]); 8] = [
    ( 1, [3.92704e-5,  3.93214e-3, 0.454937, 3.84146, 6.63490, 10.828]),
    ( 2, [1.002_51e-2, 0.102_587,  1.386_29, 5.99147, 9.21034, 13.816]),
    ( 3, [7.172_12e-2, 0.351_846,  2.365_97, 7.81473, 11.3449, 16.266]),
    ( 5, [0.411_740,   1.145_476,  4.351_46, 11.0705, 15.0863, 20.515]),
    (10, [2.155_85,    3.940_30,   9.341_82, 18.3070, 23.2093, 29.588]),
    (11, [2.603_21,    4.574_81,   10.3410,  19.6751, 24.7250, 31.264]),
    (20, [7.433_86,    10.8508,    19.3374,  31.4104, 37.5662, 45.315]),
    (30, [13.7867,     18.4926,    29.3360,  43.7729, 50.8922, 59.703]),
];

#[test]
fn published_quantiles_have_their_probability() {
    for (degrees, quantiles) in TABLE {
        for (x, tail) in quantiles
            .into_iter()
            .zip([0.995, 0.95, 0.5, 0.05, 0.01, 0.001])
        {
            let found = chi_squared_tail(x, degrees);
            assert!(
                (found / tail - 1.0).abs() < 3e-4,
                "χ²({degrees}) > {x}: {found}, not {tail}"
            );
        }
    }
}

#[test]
fn the_regularized_gamma_function_agrees() {
    for degrees in (1..=40).chain([60, 99, 100, 200]) {
        for step in 1..400 {
            // The points go up to six times the degrees of freedom and are densest near zero.
            let x = degrees as f64 * 6.0 * (f64::from(step) / 400.0).powi(2);
            let (found, expected) = (
                chi_squared_tail(x, degrees),
                gamma_ur(0.5 * degrees as f64, 0.5 * x),
            );
            assert!(
                (found - expected).abs() <= 1e-12 * expected.max(1e-3),
                "χ²({degrees}) > {x}: {found}, not {expected}"
            );
        }
    }
}

/// Legendre's continued fraction of the upper incomplete gamma function (Abramowitz & Stegun 1964,
/// eq. 6.5.31). It is used for `x` above the degrees of freedom.
fn continued_fraction(x: f64, degrees: usize) -> f64 {
    let (a, y) = (0.5 * degrees as f64, 0.5 * x);
    let mut fraction = 0.0;
    for i in (1..2000).rev() {
        let i = f64::from(i);
        fraction = i * (i - a) / (y + 2.0 * i + 1.0 - a - fraction);
    }
    (a * y.ln() - y - ln_gamma(a)).exp() / (y + 1.0 - a - fraction)
}

#[test]
fn extreme_tails_keep_their_relative_accuracy() {
    for degrees in [1, 2, 3, 4, 7, 11, 15, 24, 29, 50] {
        for x in [1.5, 2.0, 5.0, 20.0, 30.0] {
            let x = x * degrees as f64 + 3.0;
            let (found, expected) = (chi_squared_tail(x, degrees), continued_fraction(x, degrees));
            assert!(
                (found / expected - 1.0).abs() < 1e-12 * (1.0 + x),
                "χ²({degrees}) > {x}: {found:e}, not {expected:e}"
            );
        }
        for x in [700.0, 1200.0, 1350.0] {
            let (found, expected) = (chi_squared_tail(x, degrees), continued_fraction(x, degrees));
            assert!(
                (found / expected - 1.0).abs() < 1e-11,
                "χ²({degrees}) > {x}: {found:e}, not {expected:e}"
            );
        }
    }
}

#[test]
fn even_degrees_are_the_poisson_sum() {
    // The closed forms are Q(x, 2) = exp(−x/2) and Q(x, 4) = exp(−x/2)(1 + x/2).
    for x in [1e-9, 0.3, 2.0, 45.0, 1000.0] {
        let y = 0.5 * x;
        assert!((chi_squared_tail(x, 2) / f64::exp(-y) - 1.0).abs() < 1e-15);
        assert!((chi_squared_tail(x, 4) / (f64::exp(-y) * (1.0 + y)) - 1.0).abs() < 1e-14);
    }
}

#[test]
fn a_tail_falls_with_its_start_and_rises_with_the_degrees_of_freedom() {
    for degrees in 1..60 {
        let mut before = 1.0;
        for step in 0..600 {
            let x = f64::from(step) * 0.5;
            let tail = chi_squared_tail(x, degrees);
            assert!((0.0..=1.0).contains(&tail));
            // Near 1, rounding may reverse the order.
            assert!(tail <= before + 1e-14, "χ²({degrees}) > {x}");
            assert!(
                chi_squared_tail(x, degrees + 1) >= tail - 1e-14,
                "χ²({degrees}) > {x}"
            );
            before = tail;
        }
    }
}
