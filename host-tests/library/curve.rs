//! Compares the curve with the published figures of the 1000-point test set, and checks what a
//! curve refuses.

use crate::common::precision::double;
use allanite::{
    Accumulator, Comparison, Curve, Error, Model, Real, Scale,
    fit::{Options, fit},
};

/// Several roundings of a result.
const ROUNDING: f64 = if size_of::<Real>() == 8 { 1e-12 } else { 1e-6 };

/// The modulus of the test set's generator.
const MODULUS: u64 = 2_147_483_647;

/// The 1000-point test set of NIST SP 1065 (Riley 2008, section 12.4): `n_{i+1} = 16807 n_i mod
/// 2147483647`, starting from 1234567890. The fractional frequencies are in counts of 1/2147483647.
fn test_set() -> Vec<i32> {
    std::iter::successors(Some(1_234_567_890_u64), |n| Some(16_807 * n % MODULUS))
        .take(1000)
        .map(|n| i32::try_from(n).expect("below the modulus"))
        .collect()
}

fn scale() -> Scale {
    Scale::new(1.0 / MODULUS as Real, 1.0).expect("both positive")
}

fn test_curve() -> Curve<12> {
    let mut accumulator = Accumulator::new();
    accumulator.push_slice(&test_set());
    accumulator.curve_of(scale(), 1)
}

/// The Allan deviation by its definition, from the means of adjacent clusters whose starts advance
/// by `advance`. The number of differences comes with it.
fn direct_deviation(m: usize, advance: usize) -> (f64, u64) {
    let rates: Vec<f64> = test_set()
        .iter()
        .map(|&n| f64::from(n) / MODULUS as f64)
        .collect();
    let mean = |start: usize| rates[start..start + m].iter().sum::<f64>() / m as f64;
    let starts = (0..rates.len() - 2 * m + 1).step_by(advance);
    let count = starts.len();
    let squares = starts.map(|start| (mean(start + m) - mean(start)).powi(2));
    (
        (squares.sum::<f64>() / (2 * count) as f64).sqrt(),
        count as u64,
    )
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found}, expected {expected}"
    );
}

#[test]
fn the_test_set_is_the_published_one() {
    let counts = test_set();
    let fractions = counts.iter().map(|&n| f64::from(n) / MODULUS as f64);
    // The maximum, minimum, mean and standard deviation are those of NIST SP 1065, section 12.4.
    assert_close(
        fractions.clone().fold(0.0, f64::max),
        9.957_453e-1,
        1e-7,
        "maximum",
    );
    assert_close(
        fractions.clone().fold(1.0, f64::min),
        1.371_760e-3,
        1e-9,
        "minimum",
    );
    let mean = fractions.clone().sum::<f64>() / 1000.0;
    assert_close(mean, 4.897_745e-1, 1e-7, "mean");
    let squares: f64 = fractions.map(|x| (x - mean).powi(2)).sum();
    assert_close(
        (squares / 999.0).sqrt(),
        2.884_664e-1,
        1e-7,
        "standard deviation",
    );
}

/// The published deviations are those of NIST SP 1065, section 12.4, at averaging factors 1, 10 and
/// 100.
#[test]
fn the_direct_computation_gives_the_published_deviations() {
    let overlapping = [(1, 2.922_319e-1), (10, 9.159_953e-2), (100, 3.241_343e-2)];
    for (m, published) in overlapping {
        assert_close(direct_deviation(m, 1).0, published, 1e-7, "overlapping");
    }
    let disjoint = [(1, 2.922_319e-1), (10, 9.965_736e-2), (100, 3.897_804e-2)];
    for (m, published) in disjoint {
        assert_close(direct_deviation(m, m).0, published, 1e-7, "non-overlapping");
    }
}

#[test]
fn neighbouring_samples_agree_with_the_published_deviation() {
    assert_close(
        double(test_curve().points()[0].deviation()),
        0.292_231_9,
        1e-7,
        "m = 1",
    );
}

#[test]
fn every_octave_agrees_with_the_direct_computation() {
    let curve = test_curve();
    assert_eq!(curve.points().len(), 9);
    for (k, point) in curve.points().iter().enumerate() {
        let m = 1 << k;
        let (expected, differences) = direct_deviation(m, (m / 4).max(1));
        assert_eq!((point.m, point.differences), (m as u32, differences));
        assert_close(
            double(point.deviation()) / expected,
            1.0,
            ROUNDING,
            &format!("m = {m}"),
        );
    }
}

/// The reference is AllanTools 2024.06, `oadev(…, data_type="freq", taus=[1, 2, 4])`. Up to m = 4,
/// a quarter of a cluster is one sample, so the clusters overlap fully.
#[test]
fn short_octaves_agree_with_allan_tools() {
    let figures = [
        0.292_231_878_106_759_16,
        0.201_016_042_170_938_52,
        0.144_791_307_218_437_78,
    ];
    for (point, figure) in test_curve().points().iter().zip(figures) {
        assert_close(
            double(point.deviation()) / figure,
            1.0,
            ROUNDING,
            &format!("m = {}", point.m),
        );
    }
}

#[test]
fn variances_and_times_come_in_the_units_of_the_scale() {
    let mut accumulator = Accumulator::<4>::new();
    // Neighbouring counts differ by ±10 in turn.
    accumulator.push_slice(&[0, 10].repeat(50));
    let curve = accumulator.curve(Scale::new(0.5, 200.0).expect("both positive"));
    let first = curve.points()[0];
    assert_eq!((first.m, first.tau_s, first.differences), (1, 0.005, 99));
    assert_eq!(
        (first.variance, first.deviation()),
        (12.5, Real::sqrt(12.5))
    );
    assert_eq!((curve.rate_hz(), curve.interval_s()), (200.0, 0.005));
    assert_eq!(curve.points()[3].tau_s, 0.04);
}

#[test]
fn curve_contains_the_octaves_with_the_required_number_of_differences() {
    let mut accumulator = Accumulator::<8>::new();
    accumulator.push_slice(&[1, -1, 2, 0, 3, 5, 1, 2, 4, 4, 1, 0, 3]);
    // The octaves have 12, 10, 6 and no differences.
    let lengths = |least| accumulator.curve_of(scale(), least).points().len();
    assert_eq!(
        [0, 1, 6, 7, 10, 11, 12, 13].map(lengths),
        [3, 3, 3, 2, 2, 1, 1, 0]
    );
    assert_eq!(Curve::<8>::MIN_DIFFERENCES, 6);
    assert_eq!(accumulator.curve(scale()), accumulator.curve_of(scale(), 6));
    assert!(
        Accumulator::<8>::new()
            .curve_of(scale(), 0)
            .points()
            .is_empty()
    );
}

#[test]
fn a_stored_curve_equals_the_measured_one() {
    let curve = test_curve();
    let stored = curve
        .points()
        .iter()
        .map(|point| (point.m, point.differences, point.variance));
    assert_eq!(Curve::new(curve.rate_hz(), stored), Ok(curve));
}

#[test]
fn a_stored_curve_may_lack_octaves() {
    let curve = Curve::<3>::new(
        10.0,
        [(2, 9, 1.0), (16, 1, 0.0), (1 << 29, 1, Real::MIN_POSITIVE)],
    );
    let times: Vec<Real> = curve
        .expect("possible")
        .points()
        .iter()
        .map(|p| p.tau_s)
        .collect();
    assert_eq!(times, [0.2, 1.6, 53_687_091.2]);
    assert!(Curve::<3>::new(10.0, []).is_ok_and(|curve| curve.points().is_empty()));
}

#[test]
fn impossible_points_are_refused_by_their_averaging_factor() {
    let fine = (1, 100, 1.0);
    for impossible in [
        (0, 10, 1.0),
        (3, 10, 1.0),
        (u32::MAX, 10, 1.0),
        (1 << 30, 10, 1.0),
        (1, 10, 1.0), // m does not exceed the one before
        (2, 0, 1.0),
        (2, 10, -Real::MIN_POSITIVE),
        (2, 10, Real::NAN),
        (2, 10, Real::INFINITY),
    ] {
        let refused = Err(Error::InvalidPoint { m: impossible.0 });
        assert_eq!(
            Curve::<8>::new(1.0, [fine, impossible]),
            refused,
            "{impossible:?}"
        );
    }
    let descending = [(4, 10, 1.0), (2, 10, 1.0)];
    assert_eq!(
        Curve::<8>::new(1.0, descending),
        Err(Error::InvalidPoint { m: 2 })
    );
}

#[test]
fn more_octaves_than_capacity_are_refused() {
    let octaves = |count| (0..count).map(|k| (1 << k, 10, 1.0));
    assert!(Curve::<4>::new(1.0, octaves(4)).is_ok());
    assert_eq!(
        Curve::<4>::new(1.0, octaves(5)),
        Err(Error::TooManyOctaves { capacity: 4 })
    );
}

#[test]
fn scales_and_rates_must_be_positive_and_finite() {
    for impossible in [0.0, -1.0, Real::INFINITY, Real::NEG_INFINITY, Real::NAN] {
        let same = |found: Real| found.to_bits() == impossible.to_bits();
        assert!(
            matches!(Scale::new(impossible, 1.0), Err(Error::InvalidScale(x)) if same(x)),
            "{impossible}"
        );
        assert!(
            matches!(Scale::new(1.0, impossible), Err(Error::InvalidRate(x)) if same(x)),
            "{impossible}"
        );
        assert!(
            matches!(Curve::<4>::new(impossible, []), Err(Error::InvalidRate(x)) if same(x)),
            "{impossible}"
        );
    }
    let scale = Scale::new(0.25, 50.0).expect("both positive");
    assert_eq!((scale.rate_per_count(), scale.rate_hz()), (0.25, 50.0));
}

#[test]
fn a_curve_prints_one_line_per_octave() {
    let curve = Curve::<4>::new(100.0, [(1, 999, 4e-6), (2, 997, 1e-6)]).expect("possible");
    let printed = curve.to_string();
    let words: Vec<Vec<&str>> = printed
        .lines()
        .map(|l| l.split_whitespace().collect())
        .collect();
    assert_eq!(
        words,
        [
            ["m", "tau_s", "deviation", "differences"],
            ["1", "0.01000", "2.000000e-3", "999"],
            ["2", "0.02000", "1.000000e-3", "997"],
        ]
    );
}

#[test]
fn errors_name_the_fault_and_the_remedy() {
    for (error, words) in [
        (Error::InvalidRate(-1.0), ["-1 Hz", "positive"]),
        (Error::InvalidScale(0.0), ["0", "positive"]),
        (Error::InvalidPoint { m: 3 }, ["m = 3", "powers of two"]),
        (
            Error::TooManyOctaves { capacity: 4 },
            ["4 octaves", "larger"],
        ),
        (
            Error::TooFewOctaves {
                found: 1,
                needed: 2,
            },
            ["1 of the 2 octaves", "longer"],
        ),
        (Error::NoNoise { m: 8 }, ["m = 8", "sensor"]),
        (
            Error::TooManyEffects { capacity: 8 },
            ["8 effects", "remove"],
        ),
        (Error::Singular, ["told apart", "remove"]),
    ] {
        let text = error.to_string();
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    }
}

/// The numbers of stretches that the curve tells, with the lengths of the stretches.
fn stretches(lengths: &[usize]) -> Vec<(u32, u32)> {
    let mut accumulator = Accumulator::<16>::new();
    for (i, &length) in lengths.iter().enumerate() {
        (0..length).for_each(|n| accumulator.push((n * n % 7) as i32));
        if i + 1 < lengths.len() {
            accumulator.gap();
        }
    }
    let curve = accumulator.curve(scale());
    let points = curve.points().iter();
    points.map(|point| (point.m, point.stretches)).collect()
}

#[test]
fn a_record_without_gaps_is_one_stretch() {
    for length in (20..3000).chain([70_001, 100_000]) {
        for (m, stretches) in stretches(&[length]) {
            assert_eq!(stretches, 1, "m = {m} of {length} samples");
        }
    }
}

#[test]
fn the_stretches_that_are_long_enough_for_an_octave_follow_from_the_numbers_of_differences() {
    let mut random = 1_u32;
    let lengths: Vec<usize> = (0..200)
        .map(|_| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            50 + (random >> 16) as usize % 4000
        })
        .collect();
    let mut compared = 0;
    for (m, found) in stretches(&lengths) {
        let long = lengths.iter().filter(|&&n| n >= 2 * m as usize).count();
        if long >= 20 {
            compared += 1;
            let off = f64::from(found) / long as f64 - 1.0;
            assert!(off.abs() < 0.1, "m = {m}: {found} of {long}");
        }
    }
    assert!(compared >= 10, "{compared} octaves");
}

#[test]
fn a_fit_of_another_model_is_refused() {
    let curve = test_curve();
    let model = Model::ieee_952();
    let fit = fit(&curve, &model, Options::default()).expect("five terms");
    assert!(Comparison::<12>::new(&curve, &model, &fit).is_ok());
    let other = Model::ieee_952().without("angle_random_walk");
    let refused = Comparison::<12>::new(&curve, &other, &fit);
    assert_eq!(refused, Err(Error::OtherModel));
}
