use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange, angle_random_walk::AngleRandomWalk, filter::Output, pole::Pole,
    stationary::Stationary,
};
use crate::numerics::{
    math,
    real::{Real, consts::PI},
};
use nalgebra::Complex;

/// Angle random walk that passed a notch filter. It takes the place of [`AngleRandomWalk`]. The coefficient is `N` in
/// rate · √s; the shape parameters are the frequency of the notch in Hz, below half the sample rate, and its quality,
/// the ratio of the frequency to the width between the points at −3 dB.
///
/// The filter is the one that flight controllers run at the sample rate, a biquad by the bilinear transform (Orfanidis
/// 1996, eq. 11.3.19): with `Ω = 2πfτ₀` and `g = 1/(1 + tan(Ω/2Q))`, its poles `p` have `|p|² = 2g − 1` and
/// `Re p = g cos Ω`. It is half the sum of a direct path and an all-pass `A`, so that `|H|² = ½ (1 + Re A)`, and the
/// autocovariance of its output is
///
/// ```text
/// r(n) = (N²/τ₀) [ d δ(n) + Re w pⁿ ],  w = (1 − |p|²)(1 − p²) / 2p(p − p*),  d = (1 + |p|²)²/4|p|²
/// ```
///
/// which are white noise and a pole of negative weight. The qualities go down to where the poles become real.
#[derive(Clone, Copy, Debug)]
pub struct Notch;

/// The largest `tan(Ω/2Q)` relative to `sin Ω`, at which the poles would become real. Chosen by hand, a little below
/// one, where the weight of the poles would become infinite.
const WIDEST: Real = 0.95;

/// The highest frequency in cycles per sample. Chosen by hand: nearer to half the sample rate, a notch is no other
/// than a low pass.
const HIGHEST: Real = 0.42;

/// The angle in turns whose cosine is given, by Newton's method. It begins at an angle that is nearer to a quarter of a
/// turn, from where no step leads too far.
fn angle(wanted: Real, start: Real) -> Real {
    let mut turns = start;
    for _ in 0..STEPS {
        let (sine, cosine) = math::sincos_of_turns(turns);
        turns += (cosine - wanted) / (2.0 * PI * sine);
    }
    turns
}

/// The angle in turns from which Newton's method reaches any angle below an eighth of a turn.
const BELOW_A_QUARTER: Real = 0.2;

/// How far a distinct quality lies above the lowest one. Chosen by hand: a derivative needs room.
const ABOVE: Real = 1.02;

/// The number of steps of Newton's method. Chosen by hand: the slowest case, the widest notch at the lowest frequency,
/// has the precision of the type after seven.
const STEPS: usize = 7;

pub(super) static DESCRIPTION: Description = Description {
    name: "notch",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[
        Parameter {
            name: "frequency_hz",
            unit: "Hz",
            is_whole: false,
            // A notch that is narrower than the steps is as wide as a few of the spectrum's bins. Below the lowest
            // frequency it takes too little from the noise of all octaves to be seen.
            search_range: |span| SearchRange {
                low: (0.01 / span.interval_s).max(1.0 / span.longest_tau_s),
                high: HIGHEST / span.interval_s,
                steps_per_octave: 3.0,
            },
            reciprocal: None,
        },
        Parameter {
            name: "quality",
            unit: "",
            is_whole: false,
            search_range: |_| SearchRange {
                low: 0.5,
                high: 16.0,
                steps_per_octave: 0.5,
            },
            reciprocal: None,
        },
    ],
    code: 13,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Stationary for Notch {
    const DESCRIPTION: &'static Description = &DESCRIPTION;
    const NEEDS_SPECTRUM: bool = true;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        let [frequency_hz, quality, ..] = shape.parameters;
        let turns = frequency_hz * shape.interval_s;
        let (sine, cosine) = math::sincos_of_turns(turns);
        let (half_sine, half_cosine) = math::sincos_of_turns(0.5 * turns / quality);
        // The tangent is out of its domain where the notch is as wide as all frequencies.
        let widest = WIDEST * sine;
        let tangent = if half_sine < widest * half_cosine {
            half_sine / half_cosine
        } else {
            widest
        };
        let gain = 1.0 / (1.0 + tangent);
        // |p|² = 2g − 1, and 1 − |p|² = 2g tan(Ω/2Q).
        let lost = 2.0 * gain * tangent;
        let square = 1.0 - lost;
        let size = math::sqrt(square);
        let cycles = angle(gain * cosine / size, turns);
        let (sine, cosine) = math::sincos_of_turns(cycles);
        let p = Complex::new(size * cosine, size * sine);
        let one = Complex::new(1.0, 0.0);
        let weight = (one - p * p) * lost / (p * Complex::new(0.0, 4.0 * p.im));
        let decay = -0.5 * math::log(square);
        let sum = 1.0 + square;
        let white = 0.25 * sum * sum / square;
        Output::new(white, Pole::at(weight, decay, cycles), None)
    }

    fn canonical(shape: &SampledShape) -> [Real; MAX_PARAMETERS] {
        let [frequency_hz, quality, ..] = shape.parameters;
        let turns = frequency_hz * shape.interval_s;
        let (sine, _) = math::sincos_of_turns(turns);
        // Below the quality at which tan(Ω/2Q) is as large as it can be, every notch is the same.
        let tangent = WIDEST * sine;
        let half = angle(1.0 / math::sqrt(1.0 + tangent * tangent), BELOW_A_QUARTER);
        let lowest = ABOVE * 0.5 * turns / half;
        [frequency_hz, quality.max(lowest), 0.0]
    }
}

impl Explain for Notch {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a notch filter: a band is missing from the white noise",
            origin: "the notch filter of a flight controller or of the sensor, set to the frequency of motors, of a frame or of the drive",
            check: "look for notch filters in the settings; log the gyro before its filters: does the gap in the spectrum vanish?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[20.0, 2.0, 0.0], [8.0, 4.0, 0.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::effect::Effect;

    /// Below the lowest quality, a search would find no way uphill or downhill.
    #[test]
    fn a_notch_that_is_as_wide_as_can_be_is_told_by_a_quality_at_which_it_changes() {
        let shape = |parameters: [Real; 2]| SampledShape::known(0.01, parameters);
        let of = |frequency_hz, quality| Notch.kernel(1.0, &shape([frequency_hz, quality]));
        for (frequency_hz, quality, is_wide) in [
            (32.0, 1.0, true),
            (32.0, 1.3, true),
            (32.0, 2.0, false),
            (5.0, 1.0, false),
            (41.0, 2.0, true),
        ] {
            let [same_hz, distinct, _] = Effect::canonical(&Notch, &shape([frequency_hz, quality]));
            assert_eq!(same_hz, frequency_hz);
            let found = of(frequency_hz, distinct);
            assert!((found / of(frequency_hz, quality) - 1.0).abs() < 0.05);
            assert_eq!(
                distinct > quality,
                is_wide,
                "{frequency_hz} {quality}: {distinct}"
            );
            // It changes from there on.
            let changed = (of(frequency_hz, 1.01 * distinct) / found - 1.0).abs();
            assert!(changed > 1e-4, "{frequency_hz} {quality}: {changed}");
        }
    }
}
