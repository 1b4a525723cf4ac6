//! The smallest errors that any estimate from a whole record can have.
//!
//! Of a stationary Gaussian record of `n` samples, the periodogram's ordinates at `k/n` are nearly independent and
//! exponential, and their means are the spectral density S. So the Fisher information on parameters θ is
//! `J_ij = Σ_k ∂ ln S/∂θ_i ∂ ln S/∂θ_j` over `0 < k < n/2` (Whittle 1953), and the diagonal of its inverse bounds the
//! variance of every unbiased estimate (Cramér 1946, Rao 1945). Differences of a record have the same
//! ∂ ln S, so that the bound holds for noise without a variance too.
//!
//! The densities are written down here from their definitions, and not taken from the library's kernels. The
//! densities of the other effects come from the kernels, and `host-tests/tests/studies/efficiency.rs` compares those with
//! simulated records.

use allanite::effect::SampledShape;
use allanite_host::simulate::{Coefficients, Hidden};
use nalgebra::SMatrix;
use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::{PI, TAU};

/// The number of parameters that a bound is computed for: four coefficients, and an effect with two shape parameters.
pub const PARAMETERS: usize = 7;

/// The number of lags after which the autocovariance of an effect is taken for zero.
const LAGS: usize = 1 << 12;

/// The step by which a shape parameter is changed for a derivative, relative to it.
const STEP: f64 = 1e-4;

/// The two-sided densities of quantization, angle random walk, bias instability and rate random walk in a sampled
/// record, as variances, at `x` periods per sample. Their sum over a period of `x` is the variance of a sample.
pub fn densities(c: Coefficients, interval_s: f64, x: f64) -> [f64; 4] {
    let sine = (PI * x).sin();
    let quantization = (2.0 * sine * c.quantization / interval_s).powi(2);
    let white = c.angle_random_walk.powi(2) / interval_s;
    // The density B²/(2πf) of the mean over a sample interval, with its aliases.
    let flicker = (c.bias_instability * sine).powi(2) / (2.0 * PI.powi(3)) * aliases_of_cubes(x);
    let walk = c.rate_random_walk.powi(2) * interval_s / (2.0 * sine).powi(2);
    [quantization, white, flicker, walk]
}

/// `Σ_j 1/|x + j|³` over all integers, for 0 < x < 1.
fn aliases_of_cubes(x: f64) -> f64 {
    const TERMS: i32 = 8;
    // The rest is summed by the Euler–Maclaurin formula.
    let rest = |from: f64| 0.5 / from.powi(2) + 0.5 / from.powi(3) + 0.25 / from.powi(4);
    let near: f64 = (0..TERMS)
        .map(f64::from)
        .map(|j| (x + j).powi(-3) + (1.0 - x + j).powi(-3))
        .sum();
    near + rest(x + f64::from(TERMS)) + rest(1.0 - x + f64::from(TERMS))
}

/// The smallest relative standard errors of the coefficients Q, N, B and K, in this order, and then of the coefficient
/// and the shape parameters of a hidden effect; NaN for a parameter that is zero or does not exist. The number of
/// stages of a filter is taken for known.
pub fn bounds(
    coefficients: Coefficients,
    hidden: Option<&Hidden>,
    samples: usize,
    interval_s: f64,
) -> [f64; PARAMETERS] {
    let mut base = coefficients;
    let effect = hidden.map(|hidden| {
        if hidden.replaces_white_noise() {
            base.angle_random_walk = 0.0;
        }
        Grids::new(hidden, interval_s)
    });
    let is_line = hidden.is_some_and(|hidden| is_line(hidden, interval_s));
    let gradients = (1..samples / 2).map(|k| {
        let x = k as f64 / samples as f64;
        let mut gradient = [0.0; PARAMETERS];
        let terms = densities(base, interval_s, x);
        let mut density: f64 = terms.iter().sum();
        for (own, term) in gradient.iter_mut().zip(terms) {
            *own = 2.0 * term;
        }
        if let Some(grids) = effect.as_ref().filter(|_| !is_line) {
            let [own, shapes @ ..] = grids.at(x);
            density += own;
            gradient[4] = 2.0 * own;
            gradient[5..].copy_from_slice(&shapes);
        }
        gradient.map(|one| one / density)
    });
    let mut bounds = inverse(gradients);
    if let (Some(hidden), true) = (hidden, is_line) {
        let [_, amplitude, frequency, ..] = line(hidden, coefficients, samples, interval_s);
        [bounds[4], bounds[5]] = [amplitude, frequency];
    }
    if hidden.is_some_and(Hidden::replaces_white_noise) {
        // The coefficient of a filter is that of the white noise that it filters.
        bounds.swap(1, 4);
    }
    bounds
}

/// The roots of the diagonal of the inverse of the sum of the products of gradients.
fn inverse(gradients: impl Iterator<Item = [f64; PARAMETERS]>) -> [f64; PARAMETERS] {
    let mut information = SMatrix::<f64, PARAMETERS, PARAMETERS>::zeros();
    for gradient in gradients {
        for (i, own) in gradient.iter().enumerate() {
            for (j, other) in gradient.iter().enumerate() {
                information[(i, j)] += own * other;
            }
        }
    }
    let known: [bool; PARAMETERS] = std::array::from_fn(|i| information[(i, i)] > 0.0);
    for (i, known) in known.into_iter().enumerate() {
        if !known {
            information[(i, i)] = 1.0;
        }
    }
    let inverse = information.try_inverse();
    std::array::from_fn(|i| match &inverse {
        Some(inverse) if known[i] => inverse[(i, i)].sqrt(),
        _ => f64::NAN,
    })
}

fn shape(hidden: &Hidden, interval_s: f64) -> SampledShape {
    SampledShape {
        interval_s,
        parameters: hidden.parameters,
    }
}

/// Whether the effect is a sinusoid.
pub(super) fn is_line(hidden: &Hidden, interval_s: f64) -> bool {
    let shape = shape(hidden, interval_s);
    hidden.effect.response(1.0, &shape).is_some()
}

/// The density of the noise at a line, as a variance, and the bounds of its amplitude and its frequency, relative to
/// them (Kay 1993, example 3.14: `2σ²/n` and `24σ²/(A² n³)`, of the frequency in radians per sample).
fn line(hidden: &Hidden, c: Coefficients, samples: usize, interval_s: f64) -> [f64; 3] {
    let x = hidden.parameters[0] * interval_s;
    let density: f64 = densities(c, interval_s, x).iter().sum();
    let n = samples as f64;
    let ratio = density / hidden.coefficient.powi(2);
    let frequency = (24.0 * ratio / n.powi(3)).sqrt() / (TAU * x);
    [density, (2.0 * ratio / n).sqrt(), frequency]
}

/// The density of an effect, as a variance.
pub(super) struct Density(Vec<f64>);

impl Density {
    /// That of an effect in a record with this sample interval.
    pub(super) fn new(hidden: &Hidden, interval_s: f64) -> Self {
        Self(density(hidden, interval_s))
    }

    /// The density at a frequency in periods per sample.
    pub(super) fn at(&self, x: f64) -> f64 {
        between(&self.0, x)
    }
}

/// The value of a grid at a frequency in periods per sample.
fn between(grid: &[f64], x: f64) -> f64 {
    let place = x * (2 * LAGS) as f64;
    let (i, share) = (place as usize, place.fract());
    (1.0 - share) * grid[i] + share * grid[i + 1]
}

/// The density of an effect and its derivatives by the logarithms of its shape parameters, at evenly spaced
/// frequencies.
struct Grids([Vec<f64>; 3]);

impl Grids {
    fn new(hidden: &Hidden, interval_s: f64) -> Self {
        let own = density(hidden, interval_s);
        let derivative = |i: usize| {
            let changed = |factor: f64| {
                let mut hidden = *hidden;
                hidden.parameters[i] *= factor;
                density(&hidden, interval_s)
            };
            let exists = i < hidden.effect.parameters().len();
            // A number of stages is known or wrong; nothing is estimated.
            if !exists || hidden.effect.is_whole(i) {
                return vec![0.0; own.len()];
            }
            let (above, below) = (changed(1.0 + STEP), changed(1.0 - STEP));
            let pairs = above.iter().zip(&below);
            pairs.map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
        };
        let derivatives = [derivative(0), derivative(1)];
        let [first, second] = derivatives;
        Self([own, first, second])
    }

    /// The three at a frequency in periods per sample.
    fn at(&self, x: f64) -> [f64; 3] {
        self.0.each_ref().map(|grid| between(grid, x))
    }
}

/// The density of an effect at `k/(2 LAGS)` periods per sample, as a variance, from its autocovariance.
fn density(hidden: &Hidden, interval_s: f64) -> Vec<f64> {
    let shape = shape(hidden, interval_s);
    let square = (hidden.coefficient / interval_s).powi(2);
    let covariance = |lag: usize| {
        let lag = lag.min(2 * LAGS - lag);
        -square * hidden.effect.second_difference(lag as f64, 1.0, &shape)
    };
    let covariances = (0..2 * LAGS).map(|lag| Complex::new(covariance(lag), 0.0));
    let mut buffer: Vec<_> = covariances.collect();
    let transform = FftPlanner::new().plan_fft_forward(buffer.len());
    transform.process(&mut buffer);
    buffer[..=LAGS].iter().map(|bin| bin.re.max(0.0)).collect()
}
