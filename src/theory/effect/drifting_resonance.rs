use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange,
    drift::{DriftingPole, WIDEST},
    resonance::{self, Resonance},
    stationary::Stationary,
};
use crate::numerics::real::{Real, consts::PI};

/// A [`Resonance`] whose frequency ran evenly over a range during the record. The coefficient is its rms `s` in rate
/// units; the shape parameters are the frequency `f` in Hz in the middle of the range, the quality factor there, and the
/// width of the range in Hz. The time constant `T = quality/(πf)` stays the same over the range. A range that is wider
/// than half of its middle is taken as half of it.
///
/// The autocovariance is the average of that of the resonance over the range,
/// `r(n) = s² e^(−nτ₀/T) cos(2πf nτ₀) sinc(π drift nτ₀)` with `sinc x = sin x / x`.
///
/// To the covariance of a curve the effect is a resonance of one frequency that forgets its phase as fast, with the time
/// constant `1/(1/T + drift)`.
#[derive(Clone, Copy, Debug)]
pub struct DriftingResonance;

/// The width of the range.
pub(super) const DRIFT: Parameter = Parameter {
    name: "drift_hz",
    unit: "Hz",
    is_whole: false,
    search_range: |span| SearchRange {
        low: 0.2 / span.longest_tau_s,
        high: 0.2 / span.interval_s,
        steps_per_octave: 1.0,
    },
    reciprocal: None,
};

/// How far a distinct range lies below the widest one, so that a derivative has room.
const BELOW: Real = 0.98;

/// The width of a range that changes the effect.
pub(super) fn distinct_drift(drift_hz: Real, frequency_hz: Real) -> Real {
    drift_hz.min(BELOW * WIDEST * frequency_hz)
}

pub(super) static DESCRIPTION: Description = Description {
    name: "drifting_resonance",
    symbol: "s",
    coefficient: "rms",
    half_seconds: 0,
    reference_s: None,
    parameters: &[resonance::FREQUENCY, resonance::QUALITY, DRIFT],
    code: 18,
    replaces: None,
    mirror: None,
    special_case: Some(&Resonance),
    distribution: Distribution::Swept,
};

impl Stationary for DriftingResonance {
    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const NEEDS_SPECTRUM: bool = true;

    type Process = DriftingPole;

    fn process(shape: &SampledShape) -> DriftingPole {
        let [frequency_hz, quality, drift_hz] = shape.parameters;
        let cycles = frequency_hz * shape.interval_s;
        let decay = PI * cycles / quality;
        DriftingPole::new(1.0, decay, cycles, drift_hz * shape.interval_s)
    }

    fn canonical(shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        let [frequency_hz, quality, drift_hz] = shape.parameters;
        [
            frequency_hz,
            quality,
            distinct_drift(drift_hz, frequency_hz),
        ]
    }
}

impl Explain for DriftingResonance {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a drifting resonance: an oscillation with a phase that wanders, and a frequency that moved during the record",
            origin: "a mode of the board, the mount or the proof mass that moves with temperature while the gyro warms up, or under a load that changes",
            check: "log temperature beside the rate and draw the spectrum of the first and the last tenth of the record: does the peak move with temperature?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[20.0, 14.0, 1.0], [6.0, 30.0, 2.0]]
    }
}
