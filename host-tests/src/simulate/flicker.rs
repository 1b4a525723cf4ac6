//! Flicker noise as a sum of relaxations.

use super::{Random, Source, random::normal};
use std::f64::consts::PI;

/// Ratio of neighbouring relaxation rates. The sum's spectrum ripples around 1/f by
/// `2 sech(π²/ln ratio)`: 5e-4.
const RATIO: f64 = 3.0;
/// Fastest and slowest relaxation, times the sample interval. What is faster is white over a
/// sample and summed as such; what is slower stands still over a billion samples.
const FASTEST: f64 = 30.0;
const SLOWEST: f64 = 1e-9;
/// Below this rate a sample's mean is the mean of its two ends.
const SLOW: f64 = 1e-3;

/// Flicker noise of coefficient B, averaged over each sample interval: the superposition of
/// exponentially correlated noises with rates spaced evenly in their logarithm (van der Ziel 1950;
/// Kasdin 1995, section III), each of them integrated exactly over the interval (Gillespie 1996).
///
/// With rates a factor ρ apart and each of variance `B² ln ρ/π`, the sum of autocovariances is
/// `−(B²/π) ln t` plus a constant: the two-sided density `B²/(2πf)` of IEEE Std 952.
pub(super) struct Flicker {
    relaxations: Vec<Relaxation>,
    /// Of all relaxations faster than the fastest kept.
    white: f64,
}

struct Relaxation {
    state: f64,
    decay: f64,
    /// Standard deviation of what is new in the state.
    step: f64,
    /// The sample's mean: shares of the old state, of the same random number, and of another.
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
        // Σ 2/rate over rates FASTEST · ρ, FASTEST · ρ², …
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
