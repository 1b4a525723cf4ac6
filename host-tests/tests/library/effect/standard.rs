//! The five terms of IEEE 952: their variances, names and units.

use super::shapes::{assert_relative, octaves};
use allanite::effect::{
    AngleRandomWalk, BiasInstability, Effect, IEEE_952, Quantization, RateRamp, RateRandomWalk,
    SampledShape,
};
use std::f64::consts::{LN_2, PI};

/// The sample intervals, in seconds: of a fast gyro, of the one that the design assumes, of one
/// second, and of a slow gyro.
const INTERVALS_S: [f64; 4] = [1e-4, 0.01, 1.0, 37.5];

fn assert_variances(effect: &dyn Effect, expected: impl Fn(f64, f64) -> f64) {
    for interval_s in INTERVALS_S {
        for m in octaves(29) {
            let found = effect.variance(m, &SampledShape::new(interval_s));
            let what = format!("{}, m = {m}, {interval_s} s", effect.name());
            assert_relative(found, expected(m, interval_s), 1e-12, &what);
        }
    }
}

#[test]
fn quantization_falls_with_the_square_of_the_averaging_time() {
    assert_variances(&Quantization, |m, interval_s| {
        3.0 / (m * interval_s).powi(2)
    });
}

#[test]
fn angle_random_walk_falls_with_the_averaging_time() {
    assert_variances(&AngleRandomWalk, |m, interval_s| 1.0 / (m * interval_s));
}

#[test]
fn bias_instability_is_flat() {
    assert_variances(&BiasInstability, |_, _| 2.0 * LN_2 / PI);
    let factor = BiasInstability
        .variance(8.0, &SampledShape::new(1.0))
        .sqrt();
    assert_relative(factor, 0.664, 1e-3, "the factor of IEEE Std 952");
}

#[test]
fn rate_random_walk_rises_with_the_averaging_time() {
    assert_variances(&RateRandomWalk, |m, interval_s| {
        interval_s * (2.0 * m * m + 1.0) / (6.0 * m)
    });
    // The random walk of the standard is continuous, whereas ours takes one step per sample.
    for m in octaves(29).skip(6) {
        let found = RateRandomWalk.variance(m, &SampledShape::new(0.01));
        assert_relative(found, 0.01 * m / 3.0, 0.51 / (m * m) + 1e-13, "K²τ/3");
    }
}

#[test]
fn rate_ramp_rises_with_the_square_of_the_averaging_time() {
    assert_variances(&RateRamp, |m, interval_s| 0.5 * (m * interval_s).powi(2));
}

#[test]
fn terms_have_the_names_symbols_and_units_of_the_standard() {
    let known = IEEE_952.map(|effect| (effect.name(), effect.symbol(), effect.half_seconds()));
    let expected = [
        ("quantization", "Q", 2),
        ("angle_random_walk", "N", 1),
        ("bias_instability", "B", 0),
        ("rate_random_walk", "K", -1),
        ("rate_ramp", "R", -2),
    ];
    assert_eq!(known, expected);
}
