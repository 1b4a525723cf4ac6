//! Flicker noise as a sum of relaxations.

use super::{Random, Source, random::normal};
use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::PI;

/// The ratio of neighbouring relaxation rates. With it, the spectrum of the sum deviates from 1/f
/// by a ripple of `2 sech(π²/ln ratio)`, which is 5e-4.
const RATIO: f64 = 3.0;
/// The rates of the fastest and the slowest relaxation, times the sample interval. Faster
/// relaxations are white over a sample, and their sum is added as white noise. Slower relaxations
/// do not change over a billion samples.
const FASTEST: f64 = 30.0;
const SLOWEST: f64 = 1e-9;
/// Below this rate, the mean over a sample is taken as the mean of its two ends. Chosen by hand;
/// `host-tests/tests/cli/simulate.rs` compares the sum with its Allan variance.
const SLOW: f64 = 1e-3;

/// Flicker noise of coefficient B, averaged over each sample interval. It is the superposition of
/// exponentially correlated noises whose rates are spaced evenly in their logarithm (van der Ziel
/// 1950; Kasdin 1995, section III). Each of them is integrated exactly over the interval (Gillespie
/// 1996).
///
/// If the rates are a factor ρ apart and each noise has the variance `B² ln ρ/π`, the sum of
/// autocovariances is `−(B²/π) ln t` plus a constant. This corresponds to the two-sided density
/// `B²/(2πf)` of IEEE Std 952.
pub(super) struct Flicker {
    relaxations: Vec<Relaxation>,
    /// The standard deviation of the sum of all relaxations that are faster than the fastest one
    /// kept.
    white: f64,
}

struct Relaxation {
    state: f64,
    decay: f64,
    /// The standard deviation of the state's random increment.
    step: f64,
    /// The weights of the sample's mean: of the old state, of the random number of the increment,
    /// and of an independent random number.
    mean_of_state: f64,
    mean_of_step: f64,
    mean_alone: f64,
}

impl Relaxation {
    fn new(rate: f64, deviation: f64, random: &mut Random) -> Self {
        let decay = (-rate).exp();
        let step = (-(-2.0 * rate).exp_m1()).sqrt();
        let (mean_of_state, mean_of_step, mean_alone) = if rate < SLOW {
            (0.5 * (1.0 + decay), 0.5 * step, 0.0)
        } else {
            let gone = -(-rate).exp_m1();
            let covariance = gone * gone / rate;
            let variance = (2.0 * rate - 3.0 + 4.0 * decay - decay * decay) / (rate * rate);
            let shared = covariance / step;
            let alone = (variance - shared * shared).max(0.0).sqrt();
            (gone / rate, shared, alone)
        };
        Self {
            state: deviation * normal(random),
            decay,
            step: deviation * step,
            mean_of_state,
            mean_of_step: deviation * mean_of_step,
            mean_alone: deviation * mean_alone,
        }
    }

    fn next(&mut self, random: &mut Random) -> f64 {
        let new = normal(random);
        let mut mean = self.mean_of_state * self.state + self.mean_of_step * new;
        if self.mean_alone > 0.0 {
            mean += self.mean_alone * normal(random);
        }
        self.state = self.decay * self.state + self.step * new;
        mean
    }
}

impl Flicker {
    pub(super) fn new(bias_instability: f64, random: &mut Random) -> Self {
        let deviation = bias_instability * (RATIO.ln() / PI).sqrt();
        let rates = std::iter::successors(Some(FASTEST), |rate| Some(rate / RATIO));
        let relaxations = rates
            .take_while(|&rate| rate > SLOWEST)
            .map(|rate| Relaxation::new(rate, deviation, random))
            .collect();
        // This is Σ 2/rate over the rates FASTEST · ρ, FASTEST · ρ², …
        let faster = 2.0 / FASTEST / (RATIO - 1.0);
        Self {
            relaxations,
            white: deviation * faster.sqrt(),
        }
    }
}

impl Source for Flicker {
    fn next(&mut self, random: &mut Random) -> f64 {
        let slow: f64 = self.relaxations.iter_mut().map(|r| r.next(random)).sum();
        slow + self.white * normal(random)
    }
}

/// So many samples of flicker noise of coefficient B that ends at half the sample rate, as behind an ideal filter. Its
/// two-sided density is `B²/(2πf)` up to there, and none of it is folded back. It is a sum of waves on a circle of at
/// least four times the samples.
pub fn band_limited_flicker(
    bias_instability: f64,
    samples: usize,
    random: &mut Random,
) -> Vec<f64> {
    let length = (4 * samples).next_power_of_two();
    let mut waves = vec![Complex::default(); length];
    for (wave, k) in waves[1..=length / 2].iter_mut().zip(1_u32..) {
        let deviation = bias_instability / (PI * f64::from(k)).sqrt();
        *wave = Complex::new(normal(random), normal(random)) * deviation;
    }
    FftPlanner::new()
        .plan_fft_inverse(length)
        .process(&mut waves);
    waves.iter().take(samples).map(|wave| wave.re).collect()
}
