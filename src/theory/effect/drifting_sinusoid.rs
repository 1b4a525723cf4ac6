use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, SampledShape,
    SecondDifferences, Tail,
    drift::DriftingPole,
    drifting_resonance::{DRIFT, distinct_drift},
    resonance,
    sinusoid::Sinusoid,
};
use crate::numerics::real::Real;

/// A [`Sinusoid`] whose frequency ran evenly over a range during the record. The coefficient is its amplitude `Ω₀` in rate
/// units; the shape parameters are the frequency `f` in Hz in the middle of the range, and the width of the range in Hz.
/// A range that is wider than half of its middle is taken as half of it.
///
/// The autocovariance is the average of that of the sinusoid over the range,
/// `r(n) = ½ Ω₀² cos(2πf nτ₀) sinc(π drift nτ₀)` with `sinc x = sin x / x`. Unlike a sinusoid's, the phase is forgotten, so
/// that the effect has no [response](Effect::response). To the covariance of a curve it is a resonance of one frequency
/// with the time constant `1/drift`.
#[derive(Clone, Copy, Debug)]
pub struct DriftingSinusoid;

fn pole(shape: &SampledShape) -> DriftingPole {
    let [frequency_hz, drift_hz, ..] = shape.parameters;
    DriftingPole::new(
        0.0,
        frequency_hz * shape.interval_s,
        drift_hz * shape.interval_s,
    )
}

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

impl Effect for DriftingSinusoid {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn needs_spectrum(&self) -> bool {
        true
    }

    fn canonical(&self, shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        let [frequency_hz, drift_hz, ..] = shape.parameters;
        [frequency_hz, distinct_drift(drift_hz, frequency_hz), 0.0]
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        square(shape) * pole(shape).kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        square(shape) * pole(shape).second_difference(x, m)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        0.5 * pole(shape).variance(m)
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let (pole, weight) = (pole(shape), weight * square(shape));
        sum.add(m, |x| weight * pole.second_difference(x, m));
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        Some(pole(shape).tail(m).scaled(square(shape)))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        pole(shape).variogram(m, 0.5, values);
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

/// τ₀²/2: the variance of a sinusoid is half the square of its amplitude.
fn square(shape: &SampledShape) -> Real {
    0.5 * shape.interval_s * shape.interval_s
}
