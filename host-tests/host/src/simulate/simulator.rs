//! A gyro at rest, composed of sources of noise.

use super::{Chain, Coefficients, Hidden, Random, Source, ieee_952, smoothed::Smoothed};
use allanite::effect::BiasInstability;
use rand::SeedableRng;

/// The number of samples in which a frequency that drifts runs up and down, unless it is told.
pub const SWEEP: f64 = 65_536.0;

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
    /// that term. The frequency of an effect that drifts runs up and down once in [`SWEEP`] samples.
    pub fn with_hidden(
        coefficients: Coefficients,
        hidden: &[Hidden],
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        Self::with_sweep(coefficients, hidden, rate_hz, SWEEP / rate_hz, seed)
    }

    /// The same, with frequencies that run up and down once in `sweep_s` seconds. In a record of this duration every
    /// frequency of the range has the same share.
    pub fn with_sweep(
        mut coefficients: Coefficients,
        hidden: &[Hidden],
        rate_hz: f64,
        sweep_s: f64,
        seed: u64,
    ) -> Self {
        let smoothing = hidden.iter().find(|hidden| hidden.effect.passes_all());
        for hidden in hidden {
            if hidden.replaces_white_noise() {
                // The terms pass a filter of all noise together.
                let passes = hidden.effect.passes_all();
                coefficients.angle_random_walk = if passes { hidden.coefficient } else { 0.0 };
            }
            if hidden.replaces(&BiasInstability) {
                coefficients.bias_instability = 0.0;
            }
        }
        let mut simulator = Self::new(coefficients, rate_hz, seed);
        if let Some(smoothing) = smoothing {
            let terms = core::mem::take(&mut simulator.sources);
            let random = &mut simulator.random;
            let smoothed = Smoothed::new(terms, smoothing, 1.0 / rate_hz, random);
            simulator.sources.push(Box::new(smoothed));
        }
        for effect in hidden.iter().filter(|hidden| !hidden.effect.passes_all()) {
            let source = effect.source(1.0 / rate_hz, sweep_s, &mut simulator.random);
            simulator.sources.push(source);
        }
        simulator
    }

    /// A gyro whose white noise goes through the filters of a sensor. The slower noise passes them as it is.
    pub fn behind(
        coefficients: Coefficients,
        chain: &Chain,
        hidden: &[Hidden],
        (rate_hz, sweep_s): (f64, f64),
        seed: u64,
    ) -> Self {
        let white = coefficients.angle_random_walk;
        let slow = Coefficients {
            angle_random_walk: 0.0,
            ..coefficients
        };
        let mut simulator = Self::with_sweep(slow, hidden, rate_hz, sweep_s, seed);
        let source = chain.source(white, rate_hz, &mut simulator.random);
        simulator.sources.push(Box::new(source));
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
