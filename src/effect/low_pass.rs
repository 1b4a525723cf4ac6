use super::{
    AngleRandomWalk, Effect, Explain, Parameter, Range, SecondDifferences, Setting, Span, Story,
    pole::Pole,
};
use crate::real::Real;

/// Angle random walk behind a first-order low pass, coefficient N in rate · √s, of time constant T:
/// takes the place of [`AngleRandomWalk`].
///
/// The pole `z = e^(−τ₀/T)` with the variance that makes the density at frequency zero N²:
/// `s² = N²(1−z)/((1+z)τ₀)`.
#[derive(Clone, Copy, Debug)]
pub struct LowPass;

fn pole(setting: &Setting) -> Pole {
    Pole::new(setting.parameters[0], 0.0, setting.interval_s)
}

/// `s²` for N = 1.
fn variance(setting: &Setting) -> Real {
    1.0 / (pole(setting).long_mean() * setting.interval_s)
}

impl Effect for LowPass {
    fn name(&self) -> &'static str {
        "low_pass"
    }

    fn symbol(&self) -> &'static str {
        "N"
    }

    fn coefficient(&self) -> &'static str {
        "angle_random_walk"
    }

    fn half_seconds(&self) -> i8 {
        1
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "time_constant_s",
            unit: "s",
        }]
    }

    fn range(&self, _: usize, span: &Span) -> Range {
        Range {
            low: 0.25 * span.interval_s,
            high: (64.0 * span.interval_s).min(0.1 * span.longest_tau_s),
            steps_per_octave: 2.0,
        }
    }

    fn replaces(&self) -> Option<&'static dyn Effect> {
        Some(&AngleRandomWalk)
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        scale(setting) * pole(setting).kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        scale(setting) * pole(setting).second_difference(x, m)
    }

    fn variance(&self, m: Real, setting: &Setting) -> Real {
        variance(setting) * pole(setting).variance(m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        let scale = variance(setting);
        pole(setting).variances(factors, |value| each(scale * value));
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        pole(setting).add_second_differences(m, weight * scale(setting), sum);
    }
}

impl Explain for LowPass {
    fn story(&self) -> Story {
        Story {
            what: "a first-order low pass: white noise is cut off before it is sampled",
            origin: "an analogue RC filter, or a digital smoothing filter of one pole, in the sensor's signal path",
            check: "read the sensor's bandwidth setting; does the deficit at short averaging times move with it?",
        }
    }
}

fn scale(setting: &Setting) -> Real {
    variance(setting) * setting.interval_s * setting.interval_s
}
