use super::{
    Effect, Explain, Parameter, Range, SecondDifferences, Setting, Span, Story, pole::Pole,
};
use crate::real::Real;

/// Exponentially correlated noise, coefficient its rms in rate, correlation time T_c: one real pole.
///
/// `σ²(τ) ≈ (2 s² T_c/τ) [1 − (T_c/2τ)(3 − 4e^(−τ/T_c) + e^(−2τ/T_c))]`, which peaks at 0.617 s at
/// 1.89 T_c (IEEE Std 952-1997, eq. C.20, for a sampled rate).
#[derive(Clone, Copy, Debug)]
pub struct GaussMarkov;

/// The parameter of both kinds of exponentially correlated noise.
pub(super) const PARAMETERS: &[Parameter] = &[Parameter {
    name: "correlation_time_s",
    unit: "s",
}];

fn pole(setting: &Setting) -> Pole {
    Pole::new(setting.parameters[0], 0.0, setting.interval_s)
}

impl Effect for GaussMarkov {
    fn name(&self) -> &'static str {
        "gauss_markov"
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
        PARAMETERS
    }

    fn range(&self, _: usize, span: &Span) -> Range {
        correlation_times(span)
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

impl Explain for GaussMarkov {
    fn story(&self) -> Story {
        Story {
            what: "exponentially correlated noise: a disturbance that forgets itself after its correlation time",
            origin: "temperature control loops, charge trapping in the sense electronics, slow mechanical relaxation of the package",
            check: "log temperature and supply beside the rate; does the correlation time change with either?",
        }
    }
}

/// Correlation times that a curve can show: their peaks, at 1.89 T_c, within it.
pub(super) fn correlation_times(span: &Span) -> Range {
    Range {
        low: span.interval_s,
        high: 0.5 * span.longest_tau_s,
        steps_per_octave: 2.0,
    }
}

fn squared(x: Real) -> Real {
    x * x
}
