use super::{
    Effect, Explain, Parameter, Range, SecondDifferences, Setting, Span, Story, pole::Pole,
};
use crate::real::{Real, consts::PI};

/// A lightly damped mode driven by noise, coefficient its rms in rate: a complex pole of frequency
/// `f` and quality factor `quality`, with time constant `T = quality/(πf)`.
///
/// A frequency above half the sample rate is seen at its alias.
#[derive(Clone, Copy, Debug)]
pub struct Resonance;

fn pole(setting: &Setting) -> Pole {
    let [frequency_hz, quality] = setting.parameters;
    Pole::new(
        quality / (PI * frequency_hz),
        frequency_hz,
        setting.interval_s,
    )
}

impl Effect for Resonance {
    fn name(&self) -> &'static str {
        "resonance"
    }

    fn symbol(&self) -> &'static str {
        "s"
    }

    fn coefficient(&self) -> &'static str {
        "rms"
    }

    fn half_seconds(&self) -> i8 {
        0
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[
            Parameter {
                name: "frequency_hz",
                unit: "Hz",
            },
            Parameter {
                name: "quality",
                unit: "",
            },
        ]
    }

    fn range(&self, parameter: usize, span: &Span) -> Range {
        match parameter {
            // Broader than a line, and its sides are smooth.
            0 => Range {
                steps_per_octave: 3.0,
                ..super::sinusoid::frequencies(span)
            },
            _ => Range {
                low: 1.0,
                high: 32.0,
                steps_per_octave: 0.5,
            },
        }
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        squared(setting.interval_s) * pole(setting).kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        squared(setting.interval_s) * pole(setting).second_difference(x, m)
    }

    fn variance(&self, m: Real, setting: &Setting) -> Real {
        pole(setting).variance(m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        pole(setting).variances(factors, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        let weight = weight * squared(setting.interval_s);
        pole(setting).add_second_differences(m, weight, sum);
    }
}

impl Explain for Resonance {
    fn story(&self) -> Story {
        Story {
            what: "a resonance: an oscillation with a phase that wanders",
            origin: "a mode of the board, the mount or the proof mass excited by vibration; an alias of the drive or of its beat with another gyro's",
            check: "tap the board; change the mount's stiffness; change the sample rate a little: an alias moves, a mechanical mode stays",
        }
    }
}

fn squared(x: Real) -> Real {
    x * x
}
