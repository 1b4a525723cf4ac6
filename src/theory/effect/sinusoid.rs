use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter, Response,
    SampledShape, SearchRange, Span,
};
use crate::numerics::math;
use crate::numerics::real::{
    Real,
    consts::{PI, SQRT_2},
};

/// A sinusoidal rate. The coefficient is its amplitude `Ω₀` in rate units, the shape parameter its
/// frequency `f` in Hz, above zero and not a multiple of the sample rate.
///
/// `G(n) = −¼ τ₀² sin²(πfτ₀n)/sin²(πfτ₀)` and `σ² = Ω₀² sin⁴(πfτ)/(m sin πfτ₀)²`, which for `fτ₀ ≪ 1`
/// is the `Ω₀² (sin²(πfτ)/πfτ)²` of IEEE Std 952-1997, eq. C.21. A frequency above half the sample
/// rate appears at its alias.
#[derive(Clone, Copy, Debug)]
pub struct Sinusoid;

/// `sin(π x)`, also for large `x`.
fn sine_of_turns(x: Real) -> Real {
    math::sincos_of_turns(0.5 * x).0
}

/// `sin²(πfτ₀n)/sin(πfτ₀)`.
fn kernel_root(n: Real, shape: &SampledShape) -> Real {
    let cycles = shape.parameters[0] * shape.interval_s;
    let sine = sine_of_turns(cycles * n);
    sine * sine / sine_of_turns(cycles)
}

pub(super) static DESCRIPTION: Description = Description {
    name: "sinusoid",
    symbol: "Ω",
    coefficient: "amplitude",
    half_seconds: 0,
    reference_s: None,
    parameters: &[Parameter {
        name: "frequency_hz",
        unit: "Hz",
        is_whole: false,
        search_range: frequencies,
        reciprocal: None,
    }],
    code: 7,
    replaces: None,
    mirror: None,
    special_case: None,
    distribution: Distribution::Deterministic,
};

impl Effect for Sinusoid {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let cycles = shape.parameters[0] * shape.interval_s;
        -0.25 * squared(shape.interval_s) * kernel_root(lag, shape) / sine_of_turns(cycles)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        squared(kernel_root(m, shape) / m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        let cycles = shape.parameters[0] * shape.interval_s;
        let per_sample = 1.0 / sine_of_turns(cycles);
        let mut last: Option<(Real, Real)> = None;
        for m in factors {
            // From one octave to the next, sin²2x = 4 sin²x (1 − sin²x). Each step doubles the
            // relative error, which begins at that of rounding.
            let square = match last {
                Some((before, square)) if m == 2.0 * before => 4.0 * square * (1.0 - square),
                _ => squared(sine_of_turns(cycles * m)),
            };
            last = Some((m, square));
            each(squared(square * per_sample / m));
        }
    }

    fn response(&self, m: Real, shape: &SampledShape) -> Option<Response> {
        // The mean product of two sines in phase is half the product of their amplitudes, and
        // the amplitude of a difference, times τ, is twice that of the kernel's root.
        let half = SQRT_2;
        let turns = shape.parameters[0] * shape.interval_s;
        Some(Response {
            amplitude: half * shape.interval_s * kernel_root(m, shape),
            phase: 2.0 * PI * (turns - math::floor(turns)),
        })
    }
}

impl Explain for Sinusoid {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a sinusoid: a steady oscillation of one frequency",
            origin: "a supply or wires nearby, a fan or a turntable's drive, the dither of a laser gyro, an alias of the drive frequency",
            check: "switch off motors and supplies one by one; change the sample rate a little: an alias moves, a true oscillation stays",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.3, 0.0, 0.0], [7.7, 0.0, 0.0]]
    }
}

/// The frequencies that a curve can show: from a period of three of the longest averaging times to
/// half the sample rate. Of 600 strong lines of random frequency, 498 were found alone with 6 steps an
/// octave, 522 with 12 and 550 with 24.
pub(super) fn frequencies(span: &Span) -> SearchRange {
    SearchRange {
        low: 0.33 / span.longest_tau_s,
        high: span.highest_hz(),
        steps_per_octave: 24.0,
    }
}

fn squared(x: Real) -> Real {
    x * x
}
