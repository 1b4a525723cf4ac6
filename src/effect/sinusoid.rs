use super::{Effect, Explain, Parameter, Range, Response, Setting, Span, Story};
use crate::math;
use crate::real::{
    Real,
    consts::{PI, SQRT_2},
};

/// A sinusoidal rate, coefficient its amplitude Ω₀ in rate, of frequency `f`.
///
/// `G(n) = −¼ τ₀² sin²(πfτ₀n)/sin²(πfτ₀)`; `σ² = Ω₀² sin⁴(πfτ)/(m sin πfτ₀)²`, the
/// `Ω₀² (sin²(πfτ)/πfτ)²` of IEEE Std 952-1997, eq. C.21, for a sampled rate. A frequency above half
/// the sample rate is seen at its alias.
#[derive(Clone, Copy, Debug)]
pub struct Sinusoid;

/// `sin(π x)` of a number of half turns, however large.
fn sine_of_turns(x: Real) -> Real {
    math::sincos_of_turns(0.5 * x).0
}

/// `sin²(πfτ₀n)/sin(πfτ₀)`.
fn kernel_root(n: Real, setting: &Setting) -> Real {
    let cycles = setting.parameters[0] * setting.interval_s;
    let sine = sine_of_turns(cycles * n);
    sine * sine / sine_of_turns(cycles)
}

impl Effect for Sinusoid {
    fn name(&self) -> &'static str {
        "sinusoid"
    }

    fn symbol(&self) -> &'static str {
        "Ω"
    }

    fn coefficient(&self) -> &'static str {
        "amplitude"
    }

    fn half_seconds(&self) -> i8 {
        0
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "frequency_hz",
            unit: "Hz",
        }]
    }

    fn range(&self, _: usize, span: &Span) -> Range {
        frequencies(span)
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        let cycles = setting.parameters[0] * setting.interval_s;
        -0.25 * squared(setting.interval_s) * kernel_root(lag, setting) / sine_of_turns(cycles)
    }

    fn variance(&self, m: Real, setting: &Setting) -> Real {
        squared(kernel_root(m, setting) / m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        let cycles = setting.parameters[0] * setting.interval_s;
        let per_sample = 1.0 / sine_of_turns(cycles);
        let mut last: Option<(Real, Real)> = None;
        for m in factors {
            // sin²2x = 4 sin²x (1 − sin²x) from octave to octave, each of which doubles an error of 1e-16.
            let square = match last {
                Some((before, square)) if m == 2.0 * before => 4.0 * square * (1.0 - square),
                _ => squared(sine_of_turns(cycles * m)),
            };
            last = Some((m, square));
            each(squared(square * per_sample / m));
        }
    }

    fn response(&self, m: Real, setting: &Setting) -> Option<Response> {
        // The mean product of two sines is half the product of their amplitudes.
        let half = SQRT_2;
        let turns = setting.parameters[0] * setting.interval_s;
        Some(Response {
            amplitude: half * setting.interval_s * kernel_root(m, setting),
            phase: 2.0 * PI * (turns - math::floor(turns)),
        })
    }
}

impl Explain for Sinusoid {
    fn story(&self) -> Story {
        Story {
            what: "a sinusoid: a steady oscillation of one frequency",
            origin: "mains hum, a fan or a turntable's drive, the dither of a laser gyro, an alias of the drive frequency",
            check: "switch off motors and supplies one by one; change the sample rate a little: an alias moves, a true line stays",
        }
    }
}

/// Frequencies that a curve can show: from a period of three of the longest averaging times to half
/// the sample rate.
pub(super) fn frequencies(span: &Span) -> Range {
    Range {
        low: 0.33 / span.longest_tau_s,
        high: 0.495 / span.interval_s,
        steps_per_octave: 6.0,
    }
}

fn squared(x: Real) -> Real {
    x * x
}
