//! The small fit beside the general one, on records of white noise, a random walk and rounding.

extern crate std;

use super::*;
use crate::{
    Accumulator, Model, Scale,
    fit::{Options, State},
    numerics::{real::double, test_random::Random},
};
use std::vec::Vec;

fn record(seed: u32, samples: u32, gaps: u32) -> Curve<16> {
    let mut random = Random::new(seed.into());
    let mut accumulator = Accumulator::<16>::new();
    let (mut drift, mut rounded) = (0.0, 0.0);
    for n in 0..samples {
        drift += 0.2 * random.signed();
        let angle = 30.0 * random.signed();
        accumulator.push((40.0 * random.signed() + drift + angle - rounded) as i32);
        rounded = angle;
        if gaps > 0 && n % (samples / gaps) == 0 {
            accumulator.gap();
        }
    }
    accumulator.curve(Scale::new(0.01, 100.0).expect("positive"))
}

#[test]
fn the_small_fit_has_the_numbers_of_the_general_one() {
    let (mut squares, mut chi_squared, mut states) = (Vec::new(), Vec::new(), 0);
    for seed in 0..40 {
        let samples = 3000 << (seed % 4);
        let curve = record(seed, samples, if seed % 3 == 0 { 3 } else { 0 });
        let small = fit(&curve).expect("a fit");
        let general = crate::fit::fit(&curve, &Model::ieee_952(), Options::default());
        let general = general.expect("a fit");
        assert_eq!(small.coefficients[1].state, State::Measured);
        for (one, other) in general.coefficients.iter().zip(&small.coefficients) {
            assert_eq!((one.name, one.symbol), (other.name, other.symbol));
            assert_eq!(one.half_seconds, other.half_seconds);
            assert!(other.lower <= other.value && other.value <= other.upper);
            let same = core::mem::discriminant(&one.state) == core::mem::discriminant(&other.state);
            states += usize::from(same);
            if one.square_error.is_finite() {
                squares.push(double((one.square - other.square) / one.square_error).abs());
            }
        }
        chi_squared.push(double(general.chi_squared - small.chi_squared).abs());
        chi_squared.push(double(general.deviance - small.deviance).abs());
        assert_eq!(general.is_adequate(), small.is_adequate());
        assert_eq!(general.birge_ratio > 1.0, small.birge_ratio > 1.0);
    }
    squares.sort_by(f64::total_cmp);
    chi_squared.sort_by(f64::total_cmp);
    // The study `five-terms` has the distributions.
    assert!(squares[squares.len() * 95 / 100] < 0.05, "{squares:?}");
    assert!(
        chi_squared[chi_squared.len() * 95 / 100] < 0.3,
        "{chi_squared:?}"
    );
    assert!(states >= 196, "{states} of 200");
}

/// A walk that does not go on: the curve of a random walk whose longest octaves are far below it, as a rate that returns makes
/// it. Their standard errors follow the model, so that they add no more than one each to χ².
#[test]
fn terms_that_are_far_above_the_longest_octaves_do_not_explain_the_curve() {
    let squares = [0.0, 1e-2, 0.0, 3e-3, 0.0].map(real);
    for (fall, is_adequate) in [(1.0, true), (0.02, false)] {
        let octaves = (0..14_u32).map(|k| {
            let variance = Model::ieee_952().variance(&squares, 1 << k, 0.01);
            let factor = if k >= 11 { fall } else { 1.0 };
            let stride = u64::from(((1_u32 << k) / 4).max(1));
            (1 << k, 65_536 / stride - 7, variance * real(factor))
        });
        let curve = Curve::<14>::new(100.0, octaves).expect("a curve");
        let small = fit(&curve).expect("a fit");
        let general = crate::fit::fit(&curve, &Model::ieee_952(), Options::default());
        let general = general.expect("a fit");
        assert_eq!(small.is_adequate(), Some(is_adequate), "{small:?}");
        assert_eq!(general.is_adequate(), Some(is_adequate), "{general:?}");
        assert_eq!(small.birge_ratio > 1.0, !is_adequate, "{small:?}");
        assert_eq!(general.birge_ratio > 1.0, !is_adequate, "{general:?}");
    }
}

#[test]
fn a_curve_of_another_unit_has_the_same_fit() {
    let curve = record(7, 20_000, 0);
    let near = fit(&curve).expect("a fit");
    for unit in [1e-8, 1e8] {
        let unit = real(unit);
        let octaves = curve.points().iter().map(|point| {
            let variance = point.variance * unit * unit;
            (point.m, point.differences, variance)
        });
        let far = Curve::<16>::new(curve.rate_hz(), octaves).expect("a curve");
        let far = fit(&far).expect("a fit");
        for (one, other) in near.coefficients.iter().zip(far.coefficients) {
            assert_eq!(one.state, other.state);
            assert!((one.value * unit - other.value).abs() <= 1e-3 * one.value * unit);
        }
    }
}

/// Records of many stretches, down to those with room for a difference or two of the longest octave.
#[test]
fn records_of_many_short_stretches_have_numbers() {
    for seed in 0..60 {
        let curve = record(seed, 3000 << (seed % 3), 4 << (seed % 6));
        let Ok(small) = fit(&curve) else { continue };
        for coefficient in &small.coefficients {
            assert!(coefficient.value.is_finite(), "{seed}: {small:?}");
            assert!(coefficient.lower <= coefficient.value, "{seed}: {small:?}");
            assert!(coefficient.value <= coefficient.upper, "{seed}: {small:?}");
        }
        assert!(small.chi_squared.is_finite() && small.birge_ratio.is_finite());
        assert_eq!(small.coefficients[1].state, State::Measured, "{seed}");
    }
}

#[test]
fn what_cannot_be_fitted_is_an_error() {
    let octaves = |octaves: &[(u32, u64, Real)]| {
        fit(&Curve::<16>::new(100.0, octaves.iter().copied()).expect("a curve"))
    };
    assert!(matches!(
        octaves(&[(1, 100, 1.0)]),
        Err(Error::TooFewOctaves { .. })
    ));
    assert!(matches!(
        octaves(&[(1, 100, 1.0), (2, 98, 0.0), (4, 94, 0.3)]),
        Err(Error::NoNoise { .. })
    ));
    // Only octaves that follow each other from the first one on are fitted.
    assert!(matches!(
        octaves(&[(2, 98, 0.5), (4, 94, 0.3), (8, 44, 0.2)]),
        Err(Error::TooFewOctaves { .. })
    ));
}

#[test]
fn limits_pass_fail_or_stay_open_by_the_intervals() {
    let mut found = fit(&record(3, 60_000, 0)).expect("a fit");
    assert_eq!(found.is_adequate(), Some(true));
    let infinite = [Real::INFINITY; TERMS];
    let with = |place: usize, limit: Real| {
        let mut most = infinite;
        most[place] = limit;
        Limits { most }
    };
    assert_eq!(Limits { most: infinite }.check(&found), Checked::Pass);
    let white = found.coefficients[1];
    assert!(white.lower < white.value && white.value < white.upper);
    let place = 1;
    for (limit, expected) in [
        (white.upper, Checked::Pass),
        (0.999 * white.upper, Checked::GuardBand { place }),
        (white.value, Checked::GuardBand { place }),
        (white.lower, Checked::GuardBand { place }),
        (0.999 * white.lower, Checked::Fail { place }),
        (Real::NAN, Checked::GuardBand { place }),
    ] {
        assert_eq!(with(place, limit).check(&found), expected, "{limit}");
    }
    // One coefficient that fails counts more than one that is open.
    let mut both = with(1, 0.5 * white.lower);
    both.most[0] = found.coefficients[0].value;
    assert_eq!(both.check(&found), Checked::Fail { place });
    found.birge_ratio = 1.2;
    assert_eq!(with(1, white.upper).check(&found), Checked::Misfit);
}

#[test]
fn the_papers_fit_has_the_numbers_of_the_general_one() {
    let options = Options {
        method: crate::fit::Method::RelativeAccuracy,
        ..Options::default()
    };
    for seed in 0..40 {
        let curve = record(seed, 3000 << (seed % 4), if seed % 3 == 0 { 3 } else { 0 });
        let small = fit_by_relative_accuracy(&curve).expect("a fit");
        let general = crate::fit::fit(&curve, &Model::ieee_952(), options).expect("a fit");
        for (one, other) in general.coefficients.iter().zip(&small.coefficients) {
            let off = double((one.square - other.square) / one.square_error).abs();
            assert!(off < 0.02, "{seed}: {one:?} {other:?}");
            let ratio = double(one.square_error / other.square_error);
            assert!((ratio - 1.0).abs() < 0.01, "{seed}: {one:?} {other:?}");
            assert_eq!(one.state, other.state, "{seed}");
        }
        let off = double(general.chi_squared - small.chi_squared).abs();
        assert!(off < 0.02, "{seed}: {off}");
        assert_eq!(general.degrees_of_freedom, small.degrees_of_freedom);
    }
}

#[test]
fn a_record_that_would_measure_more_is_as_long_as_the_general_fit_says() {
    let (mut told, mut same) = (0, 0);
    for seed in 0..60 {
        let curve = record(seed, 3000 << (seed % 4), 0);
        let small = fit(&curve).expect("a fit");
        let general = crate::fit::fit(&curve, &Model::ieee_952(), Options::default());
        for (place, one) in general.expect("a fit").coefficients.iter().enumerate() {
            let State::NotObservable { after_s } = one.state else {
                continue;
            };
            told += 1;
            let near = |(one, other): (Real, Real)| double(one / other - 1.0).abs() < 1e-4;
            let found = small.measured_after_s(&curve, place);
            same += usize::from(match after_s.zip(found) {
                Some(both) => near(both),
                None => after_s.is_none() && found.is_none(),
            });
        }
    }
    // Bounds differ by some hundredths of a standard error, so that one doubling more may be needed.
    assert!(told >= 60 && same * 20 >= told * 19, "{same} of {told}");
    let curve = record(1, 3000, 0);
    assert_eq!(
        fit(&curve).expect("a fit").measured_after_s(&curve, 9),
        None
    );
}
