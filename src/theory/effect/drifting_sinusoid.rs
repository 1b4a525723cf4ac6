use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, SampledShape,
    drift::DriftingPole,
    drifting_resonance::{DRIFT, distinct_drift},
    resonance,
    sinusoid::Sinusoid,
    stationary::Stationary,
};
use crate::numerics::real::Real;

/// A [`Sinusoid`] whose frequency ran evenly over a range during the record. The coefficient is its amplitude `Ω₀` in rate
/// units; the shape parameters are the frequency `f` in Hz in the middle of the range, and the width of the range in Hz.
/// A range that is wider than half of its middle is taken as half of it.
///
/// The autocovariance is the average of that of the sinusoid over the range,
/// `r(n) = ½ Ω₀² cos(2πf nτ₀) sinc(π drift nτ₀)` with `sinc x = sin x / x`. Unlike a sinusoid's, the phase is forgotten, so
/// that the effect has no [response](super::Effect::response). To the covariance of a curve it is a resonance of one frequency
/// with the time constant `1/drift`.
#[derive(Clone, Copy, Debug)]
pub struct DriftingSinusoid;

pub(super) static DESCRIPTION: Description = Description {
    name: "drifting_sinusoid",
    symbol: "Ω",
    coefficient: "amplitude",
    half_seconds: 0,
    reference_s: None,
    parameters: &[resonance::FREQUENCY, DRIFT],
    code: 19,
    replaces: None,
    mirror: None,
    special_case: Some(&Sinusoid),
    distribution: Distribution::Swept,
};

impl Stationary for DriftingSinusoid {
    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const NEEDS_SPECTRUM: bool = true;

    type Process = DriftingPole;

    /// The mean square of a sinusoid is half the square of its amplitude.
    fn process(shape: &SampledShape) -> DriftingPole {
        let [frequency_hz, drift_hz, ..] = shape.parameters;
        let (cycles, drift) = (frequency_hz * shape.interval_s, drift_hz * shape.interval_s);
        DriftingPole::new(0.5, 0.0, cycles, drift)
    }

    fn canonical(shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        let [frequency_hz, drift_hz, ..] = shape.parameters;
        [frequency_hz, distinct_drift(drift_hz, frequency_hz), 0.0]
    }
}

impl Explain for DriftingSinusoid {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a drifting sinusoid: an oscillation whose frequency moved during the record",
            origin: "a motor or a fan whose speed changes, an alias of a drive frequency that moves while the gyro warms up",
            check: "log the speed of motors and fans and the temperature beside the rate; switch motors off one by one: does the hump vanish, or move with the speed?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[20.0, 2.0, 0.0], [7.7, 0.5, 0.0]]
    }
}
