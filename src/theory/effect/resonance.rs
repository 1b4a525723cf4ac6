use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter,
    SampledShape, SearchRange, SecondDifferences, Tail,
    pole::Pole,
    sinusoid::{Sinusoid, frequencies},
};
use crate::numerics::real::{Real, consts::PI};

/// Resonance: a lightly damped mode that noise drives. The coefficient is its rms `s` in rate units;
/// the shape parameters are its frequency `f` in Hz and its quality factor, both above zero.
///
/// The autocovariance is `r(n) = s² Re zⁿ` with the complex pole `z = e^(−τ₀/T + 2πi f τ₀)` and the
/// time constant `T = quality/(πf)`: one coordinate of a circular process that decays and turns
/// (Gillespie 1996 for the real pole). A frequency above half the sample rate appears at its alias.
#[derive(Clone, Copy, Debug)]
pub struct Resonance;

fn pole(shape: &SampledShape) -> Pole {
    let [frequency_hz, quality, ..] = shape.parameters;
    Pole::new(
        quality / (PI * frequency_hz),
        frequency_hz,
        shape.interval_s,
    )
}

/// The frequency. A resonance is broader than a line, so that a coarser grid finds it.
pub(super) const FREQUENCY: Parameter = Parameter {
    name: "frequency_hz",
    unit: "Hz",
    is_whole: false,
    search_range: |span| SearchRange {
        steps_per_octave: 3.0,
        ..frequencies(span)
    },
    reciprocal: None,
};

/// The quality factor.
pub(super) const QUALITY: Parameter = Parameter {
    name: "quality",
    unit: "",
    is_whole: false,
    search_range: |_| SearchRange {
        low: 0.5,
        high: 32.0,
        steps_per_octave: 0.5,
    },
    reciprocal: None,
};

pub(super) static DESCRIPTION: Description = Description {
    name: "resonance",
    symbol: "s",
    coefficient: "rms",
    half_seconds: 0,
    reference_s: None,
    parameters: &[FREQUENCY, QUALITY],
    code: 8,
    replaces: None,
    mirror: None,
    special_case: Some(&Sinusoid),
    distribution: Distribution::Gaussian,
};

impl Effect for Resonance {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        squared(shape.interval_s) * pole(shape).kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        squared(shape.interval_s) * pole(shape).second_difference(x, m)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        pole(shape).variance(m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        pole(shape).variances(factors, each);
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let weight = weight * squared(shape.interval_s);
        pole(shape).add_second_differences(m, weight, sum);
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        Some(pole(shape).tail(m).scaled(squared(shape.interval_s)))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        pole(shape).variogram(m, 1.0, values);
    }
}

impl Explain for Resonance {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a resonance: an oscillation with a phase that wanders",
            origin: "a mode of the board, the mount or the proof mass excited by vibration; an alias of the drive frequency, or of its beat with the drive of another gyro",
            check: "tap the board; change the mount's stiffness; change the sample rate a little: an alias moves, a mechanical mode stays",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[3.0, 3.0, 0.0]]
    }
}

fn squared(x: Real) -> Real {
    x * x
}
