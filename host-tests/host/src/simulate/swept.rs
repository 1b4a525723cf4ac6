//! Oscillations whose frequency runs over a range.

use super::{
    Source,
    random::{Random, normal},
};
use allanite::effect::{Effect, SampledShape};
use rand::RngExt;
use std::f64::consts::PI;

/// The widest range relative to the frequency in its middle. The library takes a wider one as this one.
const WIDEST: f64 = 0.5;

/// A sinusoid of random phase, or a resonance, whose frequency runs from the lower end of its range to the upper one and
/// back at a steady pace.
pub(super) struct Swept {
    /// The cycles per sample in the middle of the range, and the width of the range.
    cycles: f64,
    drift: f64,
    /// The number of samples from the lower end of the range to the upper one and back.
    period: f64,
    samples: u64,
    oscillation: Oscillation,
}

enum Oscillation {
    Sinusoid {
        amplitude: f64,
        /// In turns.
        phase: f64,
    },
    /// A circular process that decays and turns, of which one coordinate is the rate.
    Resonance {
        place: [f64; 2],
        /// What is left of the place after a sample, and the standard deviation of what is added to each coordinate.
        decay: f64,
        step: f64,
    },
}

impl Swept {
    /// The oscillation of an effect, with a sweep of so many samples. It is a resonance if the effect has a quality.
    /// `None` for an effect without a frequency and the width of its range.
    pub(super) fn new(
        effect: &dyn Effect,
        shape: &SampledShape,
        coefficient: f64,
        period: f64,
        random: &mut Random,
    ) -> Option<Self> {
        let parameter = |name: &str| {
            let mut named = effect.parameters().iter().zip(shape.parameters);
            named.find_map(|(one, value)| (one.name == name).then_some(value))
        };
        let cycles = parameter("frequency_hz")? * shape.interval_s;
        let drift = parameter("drift_hz")? * shape.interval_s;
        let oscillation = match parameter("quality") {
            Some(quality) => {
                let decay = (-PI * cycles / quality).exp();
                Oscillation::Resonance {
                    place: [0; 2].map(|_| coefficient * normal(random)),
                    decay,
                    step: coefficient * (1.0 - decay * decay).sqrt(),
                }
            }
            None => Oscillation::Sinusoid {
                amplitude: coefficient,
                phase: random.random(),
            },
        };
        Some(Self {
            cycles,
            drift: drift.min(WIDEST * cycles),
            period,
            samples: 0,
            oscillation,
        })
    }

    /// The cycles of the next sample.
    fn advance(&mut self) -> f64 {
        let share = (self.samples as f64 / self.period).fract();
        self.samples += 1;
        // From −½ up to ½ and back.
        let place = 0.5 - (2.0 * share - 1.0).abs();
        self.cycles + self.drift * place
    }
}

impl Source for Swept {
    fn next(&mut self, random: &mut Random) -> f64 {
        let cycles = self.advance();
        match &mut self.oscillation {
            Oscillation::Sinusoid { amplitude, phase } => {
                *phase = (*phase + cycles).fract();
                *amplitude * (2.0 * PI * *phase).sin()
            }
            Oscillation::Resonance { place, decay, step } => {
                let (sine, cosine) = (2.0 * PI * cycles).sin_cos();
                let [x, y] = *place;
                *place = [
                    *decay * (cosine * x - sine * y) + *step * normal(random),
                    *decay * (sine * x + cosine * y) + *step * normal(random),
                ];
                place[0]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::{
        Scale,
        effect::{DriftingResonance, DriftingSinusoid, SampledShape},
        spectrum::{SpectrumAccumulator, expected_densities},
    };
    use rand::SeedableRng;

    const INTERVAL_S: f64 = 0.01;
    const SAMPLES: u32 = 1 << 19;
    const COUNT: f64 = 1e-6;

    /// A record of one sweep.
    fn record(effect: &dyn Effect, shape: &SampledShape) -> Vec<f64> {
        let mut random = Random::seed_from_u64(11);
        let period = f64::from(SAMPLES);
        let mut swept = Swept::new(effect, shape, 1.0, period, &mut random).expect("it drifts");
        (0..SAMPLES).map(|_| swept.next(&mut random)).collect()
    }

    #[test]
    fn records_have_the_allan_variance_and_the_density_of_the_kernel() {
        let cases: [(&dyn Effect, SampledShape); 4] = [
            (
                &DriftingSinusoid,
                SampledShape::known(INTERVAL_S, [20.0, 5.0]),
            ),
            (
                &DriftingSinusoid,
                SampledShape::known(INTERVAL_S, [3.0, 1.5]),
            ),
            (
                &DriftingResonance,
                SampledShape::known(INTERVAL_S, [20.0, 14.0, 3.0]),
            ),
            (
                &DriftingResonance,
                SampledShape::known(INTERVAL_S, [8.0, 30.0, 4.0]),
            ),
        ];
        for (effect, shape) in cases {
            let name = format!("{} {:?}", effect.name(), shape.parameters);
            let record = record(effect, &shape);
            for m in [1_usize, 2, 5, 16, 50] {
                let means: Vec<f64> = record
                    .chunks_exact(m)
                    .map(|cluster| cluster.iter().sum::<f64>() / m as f64)
                    .collect();
                let differences = means.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
                let found = 0.5 * differences.sum::<f64>() / (means.len() - 1) as f64;
                let expected = effect.variance(m as f64, &shape);
                assert!(
                    (found / expected - 1.0).abs() < 0.03,
                    "{name}, m = {m}: {found:e}, not {expected:e}"
                );
            }
            let mut accumulator = SpectrumAccumulator::<64, 2>::new();
            let counts: Vec<i32> = record
                .iter()
                .map(|rate| (rate / COUNT).round() as i32)
                .collect();
            accumulator.push_slice(&counts);
            let scale = Scale::new(COUNT, 1.0 / INTERVAL_S).expect("positive");
            let spectrum = accumulator.spectrum::<56>(scale);
            let mut compared = 0;
            for block in [1, 8] {
                let mut expected = [0.0; 28];
                expected_densities(effect, &shape, 64, block, &mut expected);
                let largest = expected.iter().copied().fold(0.0, f64::max);
                let bins = spectrum.bins().iter().filter(|bin| bin.block == block);
                for (bin, expected) in bins.zip(expected) {
                    // A bin of the resonance scatters by 1 % at block 1, and by 3 % at block 8.
                    let off = bin.density - expected;
                    let most = if block == 1 { 0.05 } else { 0.12 };
                    assert!(
                        off.abs() < most * expected + 0.02 * largest,
                        "{name}, {block}, {}: {:e}, not {expected:e}",
                        bin.index,
                        bin.density
                    );
                    compared += 1;
                }
            }
            assert_eq!(compared, 56);
        }
    }
}
