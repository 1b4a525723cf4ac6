//! Simulated gyros: rates with noise of known coefficients.

mod deterministic;
mod flicker;
mod gaussian;
mod hidden;
mod ieee_952;
mod preset;
mod thermal;
mod two_levels;

pub use hidden::Hidden;
pub use preset::Preset;
pub use thermal::{Course, Thermal};

use hidden::autocovariance;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// The generator behind every simulation: a seed names a record for good.
pub type Random = Xoshiro256PlusPlus;

/// Coefficients of the five IEEE-952 terms, in a rate unit of choice and seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// Quantization Q, rate · s.
    pub quantization: f64,
    /// Angle random walk N, rate · √s.
    pub angle_random_walk: f64,
    /// Bias instability B, rate.
    pub bias_instability: f64,
    /// Rate random walk K, rate / √s.
    pub rate_random_walk: f64,
    /// Rate ramp R, rate / s.
    pub rate_ramp: f64,
}

/// Something that adds to the rate, sample by sample.
pub trait Source: Send {
    /// The rate that it adds to the next sample.
    fn next(&mut self, random: &mut Random) -> f64;
}

/// An endless record of a gyro at rest: rates, averaged over each sample interval.
pub struct Simulator {
    random: Random,
    sources: Vec<Box<dyn Source>>,
}

impl Simulator {
    /// A gyro with these coefficients, sampled at `rate_hz`. Terms of coefficient zero cost nothing.
    pub fn new(coefficients: Coefficients, rate_hz: f64, seed: u64) -> Self {
        let mut random = Random::seed_from_u64(seed);
        let interval_s = 1.0 / rate_hz;
        let sources = ieee_952::sources(coefficients, interval_s, &mut random);
        Self { random, sources }
    }

    /// The same with hidden effects; one that replaces white noise takes the term's place.
    pub fn with_hidden(
        mut coefficients: Coefficients,
        hidden: &[Hidden],
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        if hidden.iter().any(Hidden::replaces_white_noise) {
            coefficients.angle_random_walk = 0.0;
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
