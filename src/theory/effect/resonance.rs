use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange,
    pole::Pole,
    sinusoid::{Sinusoid, frequencies},
    stationary::Stationary,
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

impl Stationary for Resonance {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Pole;

    fn process(shape: &SampledShape) -> Pole {
        let [frequency_hz, quality, ..] = shape.parameters;
        let time_s = quality / (PI * frequency_hz);
        Pole::new(time_s, frequency_hz, shape.interval_s)
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
