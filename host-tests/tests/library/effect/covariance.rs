//! What the covariance of a curve reads from an effect, against its kernel.

use super::shapes::{assert_relative, for_every_shape, octaves, rounding};
use allanite::{
    Curve, Model, Term,
    effect::{Description, Distribution, Effect, Response, SampledShape, Tail},
    fit::curve_covariance,
};

/// An effect of which only the kernel is known, so that the trait's defaults compute the rest.
struct KernelOnly(&'static dyn Effect);

impl Effect for KernelOnly {
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn kernel(&self, lag: f64, shape: &SampledShape) -> f64 {
        self.0.kernel(lag, shape)
    }

    fn response(&self, m: f64, shape: &SampledShape) -> Option<Response> {
        self.0.response(m, shape)
    }

    fn tail(&self, m: f64, shape: &SampledShape) -> Option<Tail> {
        self.0.tail(m, shape)
    }
}

/// The lags on both sides of every kink, in samples.
fn lags(m: f64) -> Vec<f64> {
    let quarters = (0..40).map(|i| 0.25 * m * f64::from(i));
    let far = (0..12).map(|k| m * (11.0 + 1.4 * f64::from(1_u32 << k)));
    let around = [m - 1.0, m + 1.0, 1.0, 2.0 * m - 1.0, 3.0 * m + 1.0];
    quarters
        .chain(far)
        .chain(around)
        .filter(|lag| lag.fract() == 0.0)
        .collect()
}

/// The constant is arbitrary, because the next difference removes it.
#[test]
fn second_differences_are_those_of_the_kernel_up_to_a_constant() {
    for_every_shape(|effect, shape, name| {
        let kernel = KernelOnly(effect);
        for m in octaves(12) {
            let excess = |x: f64| {
                effect.second_difference(x, m, shape) - kernel.second_difference(x, m, shape)
            };
            let constant = excess(0.0);
            for x in lags(m) {
                let left = excess(x) - constant;
                let allowed = rounding(effect, x + m, shape);
                assert!(
                    left.abs() <= allowed,
                    "{name}, m = {m}, x = {x}: {left:e}, allowed {allowed:e}"
                );
            }
        }
    });
}

/// The covariance of two differences of adjacent cluster sums whose middles lie `offset` apart.
fn cross_difference(
    effect: &dyn Effect,
    short: f64,
    long: f64,
    offset: f64,
    shape: &SampledShape,
) -> f64 {
    let at = |x: f64| effect.second_difference(x, short, shape);
    at((offset - long).abs()) - 2.0 * at(offset) + at(offset + long)
}

#[test]
fn cross_differences_are_those_of_the_kernel() {
    for_every_shape(|effect, shape, name| {
        for short in octaves(6) {
            for long in octaves(6).filter(|&long| long >= short) {
                for offset in lags(short).into_iter().chain(lags(long)) {
                    // The definition has nine terms, because G is even.
                    let weights = [1.0, -2.0, 1.0];
                    let mut expected = 0.0;
                    for (u, w_u) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                        for (v, w_v) in [-1.0, 0.0, 1.0].into_iter().zip(weights) {
                            let lag: f64 = offset + v * long - u * short;
                            expected += w_u * w_v * effect.kernel(lag.abs(), shape);
                        }
                    }
                    let allowed = rounding(effect, offset + 2.0 * long, shape);
                    let found = cross_difference(effect, short, long, offset, shape);
                    assert!(
                        (found - expected).abs() <= allowed,
                        "{name}, m = {short}, {long}, {offset}: {found:e}, not {expected:e}"
                    );
                }
            }
        }
    });
}

/// A response describes a signal whose differences have the Allan variance and the autocovariance
/// of the effect.
#[test]
fn responses_are_those_of_the_kernel() {
    for_every_shape(|effect, shape, name| {
        let is_deterministic = effect.description().distribution == Distribution::Deterministic;
        assert_eq!(effect.response(4.0, shape).is_some(), is_deterministic);
        if !is_deterministic {
            return;
        }
        for m in octaves(14) {
            let response = effect.response(m, shape).expect("deterministic");
            // The relation is σ² = ½ mean D², and the amplitude divided by τ is the root of that
            // mean.
            let mean_square = (response.amplitude / (m * shape.interval_s)).powi(2);
            assert_relative(0.5 * mean_square, effect.variance(m, shape), 1e-9, name);
            for offset in lags(m).into_iter().filter(|&offset| offset < 1e4) {
                let expected = response.amplitude.powi(2) * (response.phase * offset).cos();
                let found = cross_difference(effect, m, m, offset, shape);
                let allowed = rounding(effect, offset + 2.0 * m, shape);
                assert!(
                    (found - expected).abs() <= allowed,
                    "{name}, m = {m}, {offset}: {found:e}, not {expected:e}"
                );
            }
        }
    });
}

/// Each effect fills the lattice of sums that the covariance reads in its own way.
#[test]
fn lattice_sums_are_those_of_the_kernel() {
    const OCTAVES: usize = 12;
    let samples: u64 = 1 << 15;
    for_every_shape(|effect, shape, name| {
        if effect.response(1.0, shape).is_some() {
            return;
        }
        let octaves = (0..OCTAVES as u32).map(|k| {
            let m = 1_u64 << k;
            (m as u32, (samples - 2 * m) / (m / 4).max(1) + 1, 1.0)
        });
        let curve = Curve::<OCTAVES>::new(1.0 / shape.interval_s, octaves).expect("possible");
        let covariance = |effect: &'static dyn Effect| {
            let mut model = Model::default();
            let term = Term {
                parameters: shape.parameters,
                ..Term::new(effect)
            };
            model.add(term).expect("one effect");
            curve_covariance(&curve, &model, &[1.0])
        };
        let kernel = Box::leak(Box::new(KernelOnly(effect)));
        let (found, expected) = (covariance(effect), covariance(kernel));
        // Where the kernels of four slow stages cancel, nothing is left to compare with.
        let is_cancelled = |k: usize| {
            let m = f64::from(1_u32 << k);
            let square = effect.variance(m, shape) * (m * shape.interval_s).powi(2);
            effect.name() == "cascade" && rounding(effect, 4.0 * m, shape) > 1e-9 * square
        };
        for j in (0..OCTAVES).filter(|&j| !is_cancelled(j)) {
            for k in (0..OCTAVES).filter(|&k| !is_cancelled(k)) {
                let unit = (expected[(j, j)] * expected[(k, k)]).sqrt();
                let difference = (found[(j, k)] - expected[(j, k)]) / unit;
                assert!(difference.abs() < 1e-6, "{name}, {j}, {k}: {difference:e}");
            }
        }
    });
}
