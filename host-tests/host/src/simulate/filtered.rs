//! White noise behind a digital filter, sample by sample.

use super::{
    Source,
    random::{Random, normal},
};
use allanite::effect::{Effect, SampledShape};
use std::f64::consts::PI;

/// The number of time constants after which a filter has forgotten how it began: e⁻²⁵ is left of the slowest pole.
pub(super) const FORGOTTEN: f64 = 64.0;

/// White noise behind sections of first and second order.
pub(super) struct Filtered {
    sections: Vec<Section>,
    /// The standard deviation of the white noise.
    deviation: f64,
}

impl Filtered {
    /// The noise of an effect that is a digital filter at the sample rate; `None` for any other effect.
    pub(super) fn new(
        effect: &dyn Effect,
        shape: &SampledShape,
        coefficient: f64,
        random: &mut Random,
    ) -> Option<Self> {
        let mut filtered = Self {
            sections: sections(effect, shape)?,
            deviation: coefficient / shape.interval_s.sqrt(),
        };
        let [time_s, ..] = shape.parameters;
        for _ in 0..(FORGOTTEN * time_s / shape.interval_s).ceil() as u64 {
            let _ = filtered.next(random);
        }
        Some(filtered)
    }
}

impl Source for Filtered {
    fn next(&mut self, random: &mut Random) -> f64 {
        let white = self.deviation * normal(random);
        let sections = self.sections.iter_mut();
        sections.fold(white, |x, section| section.output(x))
    }
}

/// The filter `y_n = Σ b_k x_(n−k) − Σ a_k y_(n−k)`, with `k` from 0 for `b` and from 1 for `a`.
#[derive(Clone, Copy)]
pub(super) struct Section {
    b: [f64; 3],
    a: [f64; 2],
    inputs: [f64; 2],
    outputs: [f64; 2],
}

impl Section {
    pub(super) fn new(b: [f64; 3], a: [f64; 2]) -> Self {
        Self {
            b,
            a,
            inputs: [0.0; 2],
            outputs: [0.0; 2],
        }
    }

    pub(super) fn output(&mut self, x: f64) -> f64 {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let ([x1, x2], [y1, y2]) = (self.inputs, self.outputs);
        let y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
        self.inputs = [x, x1];
        self.outputs = [y, y1];
        y
    }
}

/// The sections of an effect that is a digital filter at the sample rate.
pub(super) fn sections(effect: &dyn Effect, shape: &SampledShape) -> Option<Vec<Section>> {
    let [time_s, number, _] = shape.parameters;
    let decay = (-shape.interval_s / time_s).exp();
    match effect.name() {
        "digital_low_pass" | "output_low_pass" => {
            Some(butterworth(shape.interval_s / time_s, number))
        }
        "cascade" => {
            let stage = Section::new([1.0 - decay, 0.0, 0.0], [-decay, 0.0]);
            Some(vec![stage; number as usize])
        }
        "high_pass" => {
            let gain = decay.sqrt();
            Some(vec![Section::new([gain, -gain, 0.0], [-decay, 0.0])])
        }
        _ => None,
    }
}

/// A Butterworth low pass by the bilinear transform, with a cut-off at this angle from sample to sample.
pub(super) fn butterworth(angle: f64, poles: f64) -> Vec<Section> {
    // The analogue sections are 1/(s² + 2ds + 1) and 1/(s + 1), with s = (1 − B)/(1 + B)/w for a delay B of one sample.
    let w = (0.5 * angle).tan();
    let pair = |k: u32| {
        let d = (PI * (2.0 * f64::from(k) + 1.0) / (2.0 * poles)).sin();
        let unit = 1.0 + 2.0 * d * w + w * w;
        let gain = w * w / unit;
        let back = [2.0 * (w * w - 1.0), 1.0 - 2.0 * d * w + w * w];
        Section::new([gain, 2.0 * gain, gain], back.map(|a| a / unit))
    };
    let mut sections: Vec<Section> = (0..poles as u32 / 2).map(pair).collect();
    if poles as u32 % 2 == 1 {
        let gain = w / (1.0 + w);
        sections.push(Section::new(
            [gain, gain, 0.0],
            [(w - 1.0) / (1.0 + w), 0.0],
        ));
    }
    sections
}

#[cfg(test)]
mod tests {
    use super::{super::kernel::autocovariance, *};
    use allanite::effect::{EXPLAINED, padded};

    /// The recursion and the kernel are two descriptions of one process.
    #[test]
    fn filters_have_the_autocovariance_of_their_effect() {
        let interval_s = 0.01;
        let mut compared = 0;
        for effect in EXPLAINED {
            let more = [[0.004, 3.0], [0.05, 2.0], [0.03, 4.0], [0.02, 1.0]].map(padded);
            let typical = effect.typical_shapes().iter().copied();
            for parameters in typical.chain(more) {
                let shape = SampledShape {
                    interval_s,
                    parameters,
                };
                let Some(mut sections) = sections(effect, &shape) else {
                    continue;
                };
                // One stage is not offered, and has no part in the description of a cascade.
                if effect.description().name == "cascade" && parameters[1] < 2.0 {
                    continue;
                }
                let length = 400 + (60.0 * parameters[0] / interval_s) as usize;
                let response: Vec<f64> = (0..length)
                    .map(|i| {
                        let impulse = if i == 0 { 1.0 } else { 0.0 };
                        let sections = sections.iter_mut();
                        sections.fold(impulse, |x, section| section.output(x))
                    })
                    .collect();
                let at = |lag: usize| -> f64 {
                    let pairs = response.iter().zip(&response[lag..]);
                    pairs.map(|(one, other)| one * other).sum::<f64>() / interval_s
                };
                let tolerance = if effect.description().name == "cascade" {
                    1e-3
                } else {
                    1e-5
                };
                for lag in [0, 1, 2, 3, 7, 20, 100] {
                    let off = at(lag) - autocovariance(effect, &shape, lag);
                    assert!(
                        off.abs() < tolerance * at(0),
                        "{} {parameters:?}, lag {lag}: {off:e} of {:e}",
                        effect.description().name,
                        at(0)
                    );
                    compared += 1;
                }
            }
        }
        assert!(compared > 100, "{compared}");
    }
}
