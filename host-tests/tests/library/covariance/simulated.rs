//! The covariance of every effect of the catalogue against the scatter of simulated records.

use super::{catalogue, every_pair};
use allanite::{
    Accumulator, Scale,
    effect::{CATALOGUE, Distribution, Effect, MAX_PARAMETERS},
    fit::curve_covariance,
};
use allanite_host::simulate::{Coefficients, Hidden, Simulator};
use rayon::prelude::*;

const OCTAVES: usize = 10;
const RATE_HZ: f64 = 100.0;
const SAMPLES: usize = 1 << 10;
const RECORDS: usize = 2000;

/// The number of Monte-Carlo standard errors that an element of the covariance may be off. There are about 2000
/// of them.
const MOST: f64 = 4.5;

/// Rates per count.
const COUNT: f64 = 1e-5;

/// Draws records of one effect, one after the other.
struct Records {
    effect: &'static dyn Effect,
    parameters: [f64; MAX_PARAMETERS],
    /// The source of an effect that forgets. Records lie far apart in it, because it is slow to set up.
    endless: Option<Simulator>,
    seed: u64,
}

impl Records {
    fn new(effect: &'static dyn Effect, parameters: [f64; MAX_PARAMETERS]) -> Self {
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

    /// The Allan variances of the next record.
    fn next(&mut self) -> Vec<f64> {
        self.seed += 1;
        let mut fresh;
        let rates = match &mut self.endless {
            Some(endless) => {
                let _ = endless.nth(8 * SAMPLES);
                endless
            }
            None => {
                fresh = self.simulator();
                &mut fresh
            }
        };
        let mut gyro = Accumulator::<OCTAVES>::new();
        for rate in rates.take(SAMPLES) {
            gyro.push((rate / COUNT).round() as i32);
        }
        let curve = gyro.curve(Scale::new(COUNT, RATE_HZ).expect("positive"));
        curve.points().iter().map(|point| point.variance).collect()
    }
}

/// The elements of the covariance that the scatter of many records contradicts.
fn contradictions(effect: &'static dyn Effect, parameters: [f64; MAX_PARAMETERS]) -> Vec<String> {
    let octaves = every_pair::octaves(SAMPLES);
    let (name, model, squares) = catalogue::alone(effect, parameters);
    let curve = every_pair::curve::<OCTAVES>(&octaves, 1.0 / RATE_HZ, |_| 1.0);
    let covariance = curve_covariance(&curve, &model, &squares);
    let mut records = Records::new(effect, parameters);
    let variances: Vec<_> = (0..RECORDS).map(|_| records.next()).collect();
    let mean = |of: &dyn Fn(&[f64]) -> f64| {
        variances.iter().map(|record| of(record)).sum::<f64>() / RECORDS as f64
    };
    let means: Vec<f64> = (0..octaves.len()).map(|k| mean(&|r| r[k])).collect();
    let mut found = Vec::new();
    for j in 0..octaves.len() {
        for k in 0..=j {
            let product = |r: &[f64]| (r[j] - means[j]) * (r[k] - means[k]);
            let scatter = mean(&product);
            let square = mean(&|r| product(r).powi(2));
            let error = ((square - scatter * scatter) / RECORDS as f64).sqrt();
            let off = scatter - covariance[(j, k)];
            // Counts round a scatter of nothing up, and a variance of nothing: the means of two samples of a line next to
            // half the sample rate.
            let rounding = (means[j] + means[k] + COUNT * COUNT) * COUNT * COUNT;
            if off.abs() > MOST * error + 1e-6 * means[j] * means[k] + rounding {
                let expected = covariance[(j, k)];
                found.push(format!(
                    "{name}, octaves {k} and {j}: {scatter:e} +- {error:e}, expected {expected:e}"
                ));
            }
        }
    }
    found
}

mod thorough {
    use super::*;

    /// The scatter of random telegraph noise depends on more than its autocovariance, because it is not
    /// Gaussian. A short record has only a part of the range of a drifting oscillation. All the others are Gaussian or
    /// deterministic.
    #[test]
    fn simulated_records_of_every_effect_scatter_like_the_covariance() {
        let octaves = every_pair::octaves(SAMPLES);
        let longest_tau_s = octaves[octaves.len() - 1].m as f64 / RATE_HZ;
        let gaussian = CATALOGUE.into_iter().filter(|effect| {
            let distribution = effect.description().distribution;
            ![Distribution::TwoLevels, Distribution::Swept].contains(&distribution)
        });
        let cases: Vec<_> = gaussian
            .flat_map(|effect| {
                let shapes = catalogue::shapes(effect, longest_tau_s);
                let shapes = shapes.into_iter();
                let shapes = shapes.filter(move |&shape| !catalogue::is_cancelled(effect, shape));
                shapes.map(move |shape| (effect, shape))
            })
            .collect();
        assert!(cases.len() >= 30, "{}", cases.len());
        let found = cases.par_iter();
        let found: Vec<_> = found
            .flat_map(|(effect, shape)| contradictions(*effect, *shape))
            .collect();
        assert!(found.is_empty(), "{}\n{}", found.len(), found.join("\n"));
    }
}
