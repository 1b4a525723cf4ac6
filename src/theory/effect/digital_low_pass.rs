use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange,
    angle_random_walk::AngleRandomWalk,
    filter::Output,
    low_pass::{CUTOFF, LowPass, POLES, Place, butterworth},
    pole::Pole,
    stationary::Stationary,
};
use crate::numerics::{
    math,
    real::{Real, by_precision, consts::PI},
};
use nalgebra::Complex;

/// Angle random walk that passed a digital Butterworth low pass of one to four poles, which runs at the sample rate. It
/// takes the place of [`AngleRandomWalk`]. The coefficient is `N` in rate · √s; the shape parameters are the time
/// constant `T` of the filter in seconds and the number of its poles. The density has fallen to a half at the cut-off
/// frequency `1/(2πT)`, which lies below half the sample rate: one above 0.49 of the sample rate is taken as that.
///
/// The filter is the bilinear transform of the analogue one (Oppenheim & Schafer 2010, section 7.2.2), so that its
/// density vanishes at half the sample rate, and nothing is aliased. With the poles `e_k` of the analogue filter with a
/// cut-off of one, `w = tan(τ₀/2T)` and `q_k = w e_k`, the poles are `z_k = (1+q_k)/(1−q_k)`. For the Butterworth
/// filter of `p` poles, whose `e_k` are the roots of `e^(2p) = −(−1)^p`, the residues of the density become
///
/// ```text
/// r(n) = (N²/τ₀) [ d δ(n) + Re Σ −q_k/(p(1−q_k²)) z_kⁿ ],   d = (−1)^p w^(2p)/(1 + (−1)^p w^(2p))
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DigitalLowPass;

/// The highest cut-off frequency, in cycles per sample.
const HIGHEST: Real = 0.49;

/// The lowest cut-off frequency of the search is 0.003 of the sample rate, and the highest one 0.45.
const LONGEST_SAMPLES: Real = 53.0;
const SHORTEST_SAMPLES: Real = 0.354;

/// The least magnitude of the real pole. Near a cut-off of a quarter of the sample rate the pole is nearly zero, and its
/// weight nearly infinite. A pole of this magnitude instead, whose weight is right at a lag of one sample, is wrong by
/// a quarter of this number, relative to the variance, at a lag of two. Single precision keeps four digits.
const LEAST: Real = by_precision(1e-6, 2e-4);

/// The number of steps of Newton's method from the angle of the cut-off to that of a pole. They begin less than 27
/// degrees off, and each of them leaves a sixth of the cube of what was left before.
const STEPS: usize = 3;

/// What all poles of a filter share.
struct Cutoff {
    /// The number of poles.
    poles: Real,
    /// The cycles per sample of the cut-off.
    cycles: Real,
    /// `w = tan(τ₀/2T)`.
    tangent: Real,
}

impl Cutoff {
    /// A pair of conjugate poles, from the one of the analogue filter above the real axis.
    fn pair(&self, place: Place) -> Pole {
        let (sine, cosine) = math::sincos_of_turns(self.cycles);
        let q = Complex::new(-place.decay, place.turn) * self.tangent;
        let one = Complex::new(1.0, 0.0);
        let weight = -q * 2.0 / ((one - q * q) * self.poles);
        // With e = −a + ib, ln |z| = −artanh(a sin τ₀/T) and tan arg z = b tan τ₀/T.
        let fallen = place.decay * sine;
        let decay = 0.5 * math::log((1.0 + fallen) / (1.0 - fallen));
        let direction = Complex::new(cosine, place.turn * sine);
        Pole::at(weight, decay, turns(direction, self.cycles))
    }

    /// The pole on the real axis, and the share of the noise that is white.
    fn real(&self) -> (Pole, Real) {
        let w = self.tangent;
        let z = (1.0 - w) / (1.0 + w);
        let z = if z.abs() < LEAST { LEAST } else { z };
        // Nothing cancels in the covariance at a lag of one, −q/p(1−q²) z with q = −w, and in the sum of the weight and
        // the white share.
        let weight = w / (self.poles * (1.0 + w) * (1.0 + w) * z);
        let together = if self.poles < 2.0 {
            w / (1.0 + w)
        } else {
            let square = w * w;
            let upper = 1.0 + w * (1.0 + w * (2.0 + w * (2.0 + 3.0 * w)));
            w * upper / (3.0 * (1.0 + w) * (1.0 + square + square * square))
        };
        let cycles = if z < 0.0 { 0.5 } else { 0.0 };
        let pole = Pole::at(Complex::new(weight, 0.0), -math::log(z.abs()), cycles);
        (pole, together - weight)
    }

    /// The share of the noise that is white, for an even number of poles.
    fn white(&self) -> Real {
        let square = self.tangent * self.tangent;
        let fourth = square * square;
        let power = if self.poles > 3.0 {
            fourth * fourth
        } else {
            fourth
        };
        power / (1.0 + power)
    }
}

/// The angle of a vector, in turns, by Newton's method from an angle near it.
fn turns(direction: Complex<Real>, near: Real) -> Real {
    let size = math::sqrt(direction.norm_sqr());
    let mut turns = near;
    for _ in 0..STEPS {
        let (sine, cosine) = math::sincos_of_turns(turns);
        let ahead = direction.im * cosine - direction.re * sine;
        turns += ahead / (2.0 * PI * size);
    }
    turns
}

pub(super) static DESCRIPTION: Description = Description {
    name: "digital_low_pass",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[
        Parameter {
            name: "time_constant_s",
            unit: "s",
            is_whole: false,
            search_range: |span| SearchRange {
                low: SHORTEST_SAMPLES * span.interval_s,
                high: (LONGEST_SAMPLES * span.interval_s).min(0.1 * span.longest_tau_s),
                steps_per_octave: 3.0,
            },
            reciprocal: Some(CUTOFF),
        },
        POLES,
    ],
    code: 14,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: Some(&LowPass),
    distribution: Distribution::Gaussian,
};

impl Stationary for DigitalLowPass {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        let [time_s, poles, ..] = shape.parameters;
        let cycles = (shape.interval_s / (2.0 * PI * time_s)).min(HIGHEST);
        let (sine, cosine) = math::sincos_of_turns(0.5 * cycles);
        let cutoff = Cutoff {
            poles,
            cycles,
            tangent: sine / cosine,
        };
        let (first, second) = butterworth(poles);
        let ((first, white), second) = match second {
            None if first.turn == 0.0 => (cutoff.real(), None),
            Some(second) if second.turn == 0.0 => {
                let (real, white) = cutoff.real();
                ((cutoff.pair(first), white), Some(real))
            }
            _ => (
                (cutoff.pair(first), cutoff.white()),
                second.map(|second| cutoff.pair(second)),
            ),
        };
        Output::new(white, first, second)
    }
}

impl Explain for DigitalLowPass {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a digital low pass: white noise is filtered at the sample rate, and nothing is left of it at half that rate",
            origin: "the sensor's own digital low pass, or a flight controller's software filter, a Butterworth of one to four poles",
            check: "read the filter settings of the sensor and of the logging firmware; log the gyro before its filters: does the noise at high frequency come back?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[
            [0.02, 1.0, 0.0],
            [0.008, 2.0, 0.0],
            [0.006, 3.0, 0.0],
            [0.012, 4.0, 0.0],
        ]
    }
}
