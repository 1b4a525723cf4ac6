//! Variances against the kernel, and against sums over single samples.

use super::shapes::{for_every_shape, octaves, rounding};
use allanite::effect::{Effect, GaussMarkov, Resonance, SampledShape};
use nalgebra::SMatrix;
use std::f64::consts::PI;

/// The relation is `σ²(m) = [3 G(0) − 4 G(m) + G(2m)]/τ²`.
#[test]
fn variances_follow_from_the_kernel() {
    for_every_shape(|effect, shape, name| {
        for m in octaves(14) {
            let kernel = |lag: f64| effect.kernel(lag, shape);
            let tau2 = (m * shape.interval_s).powi(2);
            let expected = 3.0 * kernel(0.0) - 4.0 * kernel(m) + kernel(2.0 * m);
            let difference = effect.variance(m, shape) * tau2 - expected;
            let allowed = rounding(effect, 2.0 * m, shape);
            assert!(
                difference.abs() <= allowed,
                "{name}, m = {m}: {difference:e} of {expected:e}, allowed {allowed:e}"
            );
        }
    });
}

/// The autocovariance of the rate, `−G″/τ₀²`, up to a constant, from the kernel at single lags.
fn autocovariance(effect: &dyn Effect, lag: usize, shape: &SampledShape) -> f64 {
    let at = |lag: usize| effect.kernel(lag as f64, shape);
    let second = at(lag + 1) - 2.0 * at(lag) + at(lag.abs_diff(1));
    -second / shape.interval_s.powi(2)
}

/// The Allan variance is half the mean square of the difference of two means, each over `m`
/// samples. This is a double sum over the autocovariance.
#[test]
fn variances_equal_double_sums_over_the_autocovariance() {
    for_every_shape(|effect, shape, name| {
        for m in [1_usize, 2, 3, 5, 8, 17] {
            let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
            let at = |lag: usize| autocovariance(effect, lag, shape);
            let sum: f64 = pairs.map(|(i, j)| at(i.abs_diff(j)) - at(m + i - j)).sum();
            let expected = sum / (m * m) as f64;
            let found = effect.variance(m as f64, shape);
            let allowed = 1e-9 * expected.abs()
                + 16.0 * rounding(effect, 2.0 * m as f64, shape) / shape.interval_s.powi(2);
            assert!(
                (found - expected).abs() <= allowed,
                "{name}, m = {m}: {found:e}, not {expected:e}, allowed {allowed:e}"
            );
        }
    });
}

/// The covariance matrix of the differences of a process has no negative eigenvalue.
#[test]
fn kernels_are_covariances() {
    for_every_shape(|effect, shape, name| {
        let at = |lag: usize| autocovariance(effect, lag, shape);
        let differences: Vec<f64> = (0..24_usize)
            .map(|lag| 2.0 * at(lag) - at(lag + 1) - at(lag.abs_diff(1)))
            .collect();
        let matrix = SMatrix::<f64, 24, 24>::from_fn(|i, j| differences[i.abs_diff(j)]);
        let eigenvalues = matrix.symmetric_eigenvalues();
        let (least, largest) = (eigenvalues.min(), eigenvalues.max());
        let rounding = 1e3 * rounding(effect, 24.0, shape) / shape.interval_s.powi(2);
        assert!(largest > 0.0, "{name}");
        assert!(
            least >= -1e-9 * largest - rounding,
            "{name}: {least:e} beside {largest:e}"
        );
    });
}

#[test]
fn variances_computed_together_equal_those_computed_one_by_one() {
    for_every_shape(|effect, shape, name| {
        let mut found = Vec::new();
        effect.variances(&mut octaves(16), shape, &mut |variance| {
            found.push(variance);
        });
        let expected: Vec<f64> = octaves(16).map(|m| effect.variance(m, shape)).collect();
        assert_eq!(found.len(), expected.len());
        let largest = expected.iter().fold(0.0, |most: f64, x| most.max(*x));
        for (found, expected) in found.iter().zip(&expected) {
            // The recursion for an oscillation loses digits where the variance is close to a zero.
            let allowed = 1e-9 * expected + 1e-13 * largest;
            assert!(
                (found - expected).abs() <= allowed,
                "{name}: {found:e}, not {expected:e}"
            );
        }
    });
}

#[test]
fn variances_of_poles_are_those_of_the_sum_over_pairs() {
    let interval_s = 0.01;
    for exponent in -10..=30 {
        // The decay rates per sample reach from 1e-9 to some hundreds.
        let decay = 10_f64.powf(-0.3 * f64::from(exponent));
        for cycles in [0.0, 1e-4, 0.03, 0.3, 0.49, 0.8] {
            let time_s = interval_s / decay;
            let frequency_hz = cycles / interval_s;
            let (effect, parameters): (&dyn Effect, _) = if cycles == 0.0 {
                (&GaussMarkov, [time_s, 0.0, 0.0])
            } else {
                (&Resonance, [frequency_hz, PI * frequency_hz * time_s, 0.0])
            };
            let shape = SampledShape {
                interval_s,
                parameters,
            };
            // This computes 1 − r_n without cancellation.
            let fallen = |n: usize| {
                let n = n as f64;
                let half_turn = (PI * cycles * n).sin();
                -(-decay * n).exp_m1() + (-decay * n).exp() * 2.0 * half_turn * half_turn
            };
            for m in [1_usize, 2, 4, 32] {
                let pairs = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
                let sum: f64 = pairs
                    .map(|(i, j)| fallen(m + i - j) - fallen(i.abs_diff(j)))
                    .sum();
                let expected = sum / (m * m) as f64;
                let found = effect.variance(m as f64, &shape);
                let what = format!(
                    "{}, decay {decay:e}, cycles {cycles}, m = {m}",
                    effect.name()
                );
                // The terms of a pole may cancel in the sum, as they do where the pole oscillates.
                assert!(
                    (found - expected).abs() < 1e-9 * expected + 1e-13,
                    "{what}: {found:e}, not {expected:e}"
                );
            }
        }
    }
}
