//! Spectra of simulated records of one effect.

use allanite::{
    Scale,
    effect::{Distribution, Effect, MAX_PARAMETERS},
    spectrum::{Bin, Spectrum, SpectrumAccumulator},
};
use allanite_host::simulate::{Coefficients, Hidden, Simulator};

/// Samples per second.
pub(crate) const RATE_HZ: f64 = 100.0;

/// Rates per count.
pub(crate) const COUNT: f64 = 1e-5;

/// The number of blocks in a segment.
pub(crate) const SEGMENT: usize = 64;

/// Room for two levels.
pub(crate) const BINS: usize = 56;

/// The number of samples in a record, so that both levels have 16 segments.
const SAMPLES: usize = 17 * 8 * SEGMENT / 2 + SEGMENT;

/// Draws records of one effect, one after the other.
pub(crate) struct Records {
    effect: &'static dyn Effect,
    parameters: [f64; MAX_PARAMETERS],
    /// The source of an effect that forgets. Records lie far apart in it, because it is slow to set up.
    endless: Option<Simulator>,
    seed: u64,
}

impl Records {
    pub(crate) fn new(effect: &'static dyn Effect, parameters: [f64; MAX_PARAMETERS]) -> Self {
        let mut records = Self {
            effect,
            parameters,
            endless: None,
            seed: 1,
        };
        let lasting = ["bias_instability", "rate_random_walk"].contains(&effect.name());
        if !lasting && effect.description().distribution != Distribution::Deterministic {
            records.endless = Some(records.simulator());
        }
        records
    }

    fn simulator(&self) -> Simulator {
        let mut coefficients = Coefficients::default();
        match self.effect.name() {
            "bias_instability" => coefficients.bias_instability = 1.0,
            "rate_random_walk" => coefficients.rate_random_walk = 1.0,
            _ => {
                let hidden = Hidden {
                    effect: self.effect,
                    parameters: self.parameters,
                    coefficient: 1.0,
                };
                return Simulator::with_hidden(coefficients, &[hidden], RATE_HZ, self.seed);
            }
        }
        Simulator::new(coefficients, RATE_HZ, self.seed)
    }

    /// The spectrum of the next record.
    pub(crate) fn next(&mut self) -> Spectrum<BINS> {
        self.seed += 1;
        let mut fresh;
        let rates = match &mut self.endless {
            Some(endless) => {
                let _ = endless.nth(SAMPLES);
                endless
            }
            None => {
                fresh = self.simulator();
                &mut fresh
            }
        };
        let mut accumulator = SpectrumAccumulator::<SEGMENT, 2>::new();
        let counts: Vec<i32> = rates
            .take(SAMPLES)
            .map(|rate| (rate / COUNT).round() as i32)
            .collect();
        accumulator.push_slice(&counts);
        let spectrum = accumulator.spectrum(Scale::new(COUNT, RATE_HZ).unwrap());
        assert_eq!(spectrum.bins().len(), BINS);
        spectrum
    }

    /// The densities of many records.
    pub(crate) fn densities(&mut self, records: usize) -> Vec<Vec<f64>> {
        let of = |spectrum: Spectrum<BINS>| -> Vec<f64> {
            spectrum.bins().iter().map(|bin| bin.density).collect()
        };
        (0..records).map(|_| of(self.next())).collect()
    }

    /// The densities that the effect and the rounding to counts are expected to have together, and the bins.
    pub(crate) fn expected(&mut self) -> (Vec<f64>, Vec<Bin>) {
        let spectrum = self.next();
        let rounding = 2.0 / RATE_HZ * COUNT * COUNT / 12.0;
        let expected = spectrum.expected(self.effect, self.parameters);
        let all = expected.iter().map(|density| density + rounding).collect();
        (all, spectrum.bins().to_vec())
    }
}

/// The mean of numbers.
pub(crate) fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let number = values.len() as f64;
    values.sum::<f64>() / number
}
