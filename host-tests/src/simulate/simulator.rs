//! A gyro at rest, composed of sources of noise.

use super::{Coefficients, Hidden, Random, Source, ieee_952};
use allanite::effect::BiasInstability;
use rand::SeedableRng;

/// An endless record of a gyro at rest. Each rate is averaged over its sample interval.
pub struct Simulator {
    random: Random,
    sources: Vec<Box<dyn Source>>,
}

impl Simulator {
    /// A gyro with these coefficients, sampled at `rate_hz`. Terms whose coefficient is zero take
    /// no time.
    pub fn new(coefficients: Coefficients, rate_hz: f64, seed: u64) -> Self {
        let mut random = Random::seed_from_u64(seed);
        let interval_s = 1.0 / rate_hz;
        let sources = ieee_952::sources(coefficients, interval_s, &mut random);
        Self { random, sources }
    }

    /// A gyro with hidden effects. An effect that replaces one of the five terms takes the place of
    /// that term.
    pub fn with_hidden(
        mut coefficients: Coefficients,
        hidden: &[Hidden],
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        for hidden in hidden {
            if hidden.replaces_white_noise() {
                coefficients.angle_random_walk = 0.0;
            }
            if hidden.replaces(&BiasInstability) {
                coefficients.bias_instability = 0.0;
            }
        }
        let mut simulator = Self::new(coefficients, rate_hz, seed);
        for effect in hidden {
            let source = effect.source(1.0 / rate_hz, &mut simulator.random);
            simulator.sources.push(source);
        }
        simulator
    }
}

impl Iterator for Simulator {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let random = &mut self.random;
        Some(
            self.sources
                .iter_mut()
                .map(|source| source.next(random))
                .sum(),
        )
    }
}
