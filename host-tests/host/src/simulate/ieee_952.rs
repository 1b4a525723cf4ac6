//! The five terms of IEEE Std 952.

use super::{Coefficients, Random, Source, flicker::Flicker, random::normal};

/// The sources of the terms whose coefficients are not zero.
pub(super) fn sources(
    coefficients: Coefficients,
    interval_s: f64,
    random: &mut Random,
) -> Vec<Box<dyn Source>> {
    let mut sources: Vec<Box<dyn Source>> = Vec::new();
    if coefficients.quantization != 0.0 {
        let deviation = coefficients.quantization / interval_s;
        sources.push(Box::new(Quantization {
            deviation,
            before: normal(random),
        }));
    }
    if coefficients.angle_random_walk != 0.0 {
        let deviation = coefficients.angle_random_walk / interval_s.sqrt();
        sources.push(Box::new(White { deviation }));
    }
    if coefficients.bias_instability != 0.0 {
        sources.push(Box::new(Flicker::new(
            coefficients.bias_instability,
            random,
        )));
    }
    if coefficients.rate_random_walk != 0.0 {
        let step = coefficients.rate_random_walk * interval_s.sqrt();
        sources.push(Box::new(Walk { step, rate: 0.0 }));
    }
    if coefficients.rate_ramp != 0.0 {
        let step = coefficients.rate_ramp * interval_s;
        sources.push(Box::new(Ramp { step, samples: 0 }));
    }
    sources
}

/// Quantization noise: an independent error of the angle at every sample, whose differences are the
/// error of the rate.
struct Quantization {
    deviation: f64,
    before: f64,
}

impl Source for Quantization {
    fn next(&mut self, random: &mut Random) -> f64 {
        let now = normal(random);
        let difference = now - self.before;
        self.before = now;
        self.deviation * difference
    }
}

struct White {
    deviation: f64,
}

impl Source for White {
    fn next(&mut self, random: &mut Random) -> f64 {
        self.deviation * normal(random)
    }
}

struct Walk {
    step: f64,
    rate: f64,
}

impl Source for Walk {
    fn next(&mut self, random: &mut Random) -> f64 {
        self.rate += self.step * normal(random);
        self.rate
    }
}

struct Ramp {
    step: f64,
    samples: u64,
}

impl Source for Ramp {
    fn next(&mut self, _: &mut Random) -> f64 {
        self.samples += 1;
        self.step * self.samples as f64
    }
}
