//! Tests of the whole way from counts to a diagnosis at the ends of what users may ask for, in both precisions.

extern crate std;

use crate::{
    Accumulator, Curve, Error, Model, Scale,
    diagnosis::{Diagnosis, Options, Step, Verdict},
    fit::{self, Fit, State, fit},
    numerics::{
        real::{double, real},
        test_random::Random,
    },
    record::integrity::{Integrity, Reason},
    theory::effect::CATALOGUE,
};
use core::ops::ControlFlow;
use std::vec::Vec;

const OCTAVES: usize = 12;

/// White noise of some 40 counts, a walk and a line at a tenth of the rate.
fn counts(length: u32) -> Vec<i32> {
    let mut random = Random::new(5);
    let mut walk = 0;
    (0..length)
        .map(|n| {
            walk += (random.bits() >> 29) as i32 - 3;
            let noise = (0..4).map(|_| (random.bits() >> 27) as i32).sum::<i32>();
            let line = [0, 18, 29, 29, 18, 0, -18, -29, -29, -18][n as usize % 10];
            noise + walk / 64 + line
        })
        .collect()
}

fn curve_of(counts: &[i32], scale: Scale) -> Curve<OCTAVES> {
    let mut gyro = Accumulator::<OCTAVES>::new();
    gyro.push_slice(counts);
    gyro.curve(scale)
}

fn fitted(curve: &Curve<OCTAVES>) -> Fit {
    fit(curve, &Model::ieee_952(), fit::Options::default()).unwrap()
}

fn verdict(curve: &Curve<OCTAVES>) -> (Verdict, Vec<&'static str>) {
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut diagnosis = Diagnosis::new(curve, &model, &CATALOGUE, options);
    let mut names = Vec::new();
    let report = |step: &Step<OCTAVES>| {
        let terms = step.model.terms().iter();
        names = terms.map(|term| term.effect.name()).collect();
    };
    let verdict = diagnosis.run(report, &mut || ControlFlow::Continue(()));
    (verdict.unwrap().unwrap(), names)
}

#[test]
fn results_do_not_depend_on_the_units_of_rate_and_time() {
    let counts = counts(20_000);
    let unit = |scale, rate| Scale::new(scale, rate).unwrap();
    let base = curve_of(&counts, unit(1.0, 1.0));
    let expected = fitted(&base);
    let (found, names) = verdict(&base);
    assert_eq!(found, Verdict::Improved);
    assert!(names.contains(&"sinusoid"), "{names:?}");
    for scale in [1e-12, 1e-6, 1.0 / 131.0, 1.0, 1e6] {
        for rate in [1e-3, 1.0, 400.0, 8e3, 1e6] {
            let case = std::format!("scale {scale:e}, rate {rate:e}");
            let curve = curve_of(&counts, unit(real(scale), real(rate)));
            let fit = fitted(&curve);
            let pairs = fit.coefficients.iter().zip(&expected.coefficients);
            for (one, other) in pairs {
                let half_seconds = f64::from(one.half_seconds);
                let factor = scale * libm::pow(rate, -half_seconds / 2.0);
                for (one, other) in [(one.value, other.value), (one.upper, other.upper)] {
                    let (one, other) = (double(one), double(other) * factor);
                    let off = (one / other - 1.0).abs();
                    assert!(one == other || off < 2e-3, "{case}: {one:e}, not {other:e}");
                }
                let kind = |state| core::mem::discriminant(&state);
                assert_eq!(kind(one.state), kind(other.state), "{case}");
            }
            let off = double(fit.chi_squared / expected.chi_squared - 1.0).abs();
            assert!(off < 2e-3, "{case}: {off:e}");
            assert_eq!(verdict(&curve), (found, names.clone()), "{case}");
        }
    }
}

#[test]
fn coefficients_are_right_over_twelve_decades() {
    for exponent in -9..=3 {
        let n = libm::pow(10.0, f64::from(exponent));
        let octaves = (0..OCTAVES).map(|k| {
            let m = 1_u32 << k;
            let tau = f64::from(m) / 100.0;
            (m, (4_000_000 >> k) - 7, real(n * n / tau))
        });
        let curve = Curve::<OCTAVES>::new(100.0, octaves).unwrap();
        let fit = fitted(&curve);
        let white = &fit.coefficients[1];
        assert_eq!(white.state, State::Measured);
        let off = (double(white.value) / n - 1.0).abs();
        assert!(off < 1e-4, "{n:e}: {:e}", white.value);
        assert!(fit.is_adequate() == Some(true), "{n:e}");
    }
}

#[test]
fn extreme_counts_give_a_result_or_a_reason() {
    // A constant has no noise.
    let constant = curve_of(&[i32::MAX; 5000], Scale::new(1.0, 100.0).unwrap());
    let result = fit(&constant, &Model::ieee_952(), fit::Options::default());
    assert_eq!(result, Err(Error::NoNoise { m: 1 }));
    // Noise of one count.
    let mut random = Random::new(9);
    let one: Vec<i32> = (0..20_000).map(|_| (random.bits() >> 31) as i32).collect();
    let white = fitted(&curve_of(&one, Scale::new(1.0, 100.0).unwrap()));
    let n = double(white.coefficients[1].value);
    assert!((n / 0.05 - 1.0).abs() < 0.1, "{n}");
    // Noise of half a count or less is said to be coarse.
    let mut watch = Integrity::new();
    for n in 0..20_000 {
        watch.push(i32::from(n % 31 == 0));
    }
    let coarse = matches!(
        watch.verdict(),
        Some(Reason::Coarse { .. } | Reason::Stuck { .. })
    );
    assert!(coarse, "{:?}", watch.verdict());
    // Full scale of 24 and of 32 bits.
    for (bits, most) in [(24, (1 << 23) - 1), (32, i32::MAX)] {
        let full: Vec<i32> = (0..20_000)
            .map(|_| {
                if random.bits() >> 31 == 0 {
                    most
                } else {
                    -most
                }
            })
            .collect();
        let fit = fitted(&curve_of(&full, Scale::new(1.0, 1.0).unwrap()));
        let n = double(fit.coefficients[1].value) / f64::from(most);
        assert!((n - 1.0).abs() < 0.05, "{bits} bits: {n}");
    }
}

fn shortest_and_longest<const K: usize>() {
    let octaves = (0..K).map(|k| {
        let m = 1_u32 << k;
        let count = ((1_u64 << 34) >> k).max(8) - 7;
        let off = 1.0 + 0.3 * f64::from(k as i32 % 3 - 1) / libm::sqrt(count as f64);
        (m, count, real(off / f64::from(m)))
    });
    let curve = Curve::<K>::new(1000.0, octaves).unwrap();
    let fit = fit(&curve, &Model::ieee_952(), fit::Options::default()).unwrap();
    let n = double(fit.coefficients[1].value) * libm::sqrt(1000.0);
    // Two octaves cannot tell quantization from white noise.
    let most = if K < 4 { 1.1 } else { 1e-2 };
    assert!((n - 1.0).abs() < most, "{K} octaves: {n}");
}

#[test]
fn two_to_thirty_octaves_are_fitted() {
    shortest_and_longest::<2>();
    shortest_and_longest::<3>();
    shortest_and_longest::<8>();
    shortest_and_longest::<20>();
    shortest_and_longest::<30>();
}

/// A scale this small is positive and finite, and the variances in its unit are subnormal numbers or zero.
#[test]
fn variances_below_the_least_normal_number_end_with_a_result_or_an_error() {
    let counts = counts(20_000);
    let least = crate::numerics::real::Real::MIN_POSITIVE;
    for below in 0..60 {
        // Down to where every variance is rounded to zero.
        let scale = crate::numerics::math::sqrt(least) * real(0.5_f64.powi(below));
        let curve = curve_of(&counts, Scale::new(scale, 100.0).unwrap());
        assert!(curve.variance_unit() >= least);
        let _ = fit(&curve, &Model::ieee_952(), fit::Options::default());
        let smallest = least * crate::numerics::real::Real::EPSILON;
        let octaves = curve.points().iter().map(|point| (point.m, 9, smallest));
        let curve = Curve::<OCTAVES>::new(100.0, octaves).unwrap();
        assert!(curve.variance_unit() >= least);
    }
}
