use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter, Reciprocal,
    SampledShape, SearchRange, SecondDifferences, Tail, angle_random_walk::AngleRandomWalk,
    pole::Pole,
};
use crate::real::{
    Real, by_precision,
    consts::{FRAC_1_SQRT_2, PI},
};
use nalgebra::Complex;

/// The sine of 60 degrees, √3/2.
const SINE_60: Real = by_precision(0.866_025_403_784_438_6, 0.866_025_4);

/// Angle random walk that passed a Butterworth low pass of one to four poles. It takes the place of
/// [`AngleRandomWalk`]. The coefficient is `N` in rate · √s; the shape parameters are the time constant `T` of the
/// filter in seconds, above zero, and the number of its poles. The density has fallen to a half at the cut-off
/// frequency `1/(2πT)`.
///
/// The autocovariance is `r(n) = s² Σ Re −p_k e^(p_k nτ₀/T)` over the poles `p_k` of the filter with a cut-off of
/// one, which lie on the left half of the unit circle: these are the residues of the density
/// `1/(1 + ω^(2·poles))`. The scale `s²` gives the sampled rate the spectral density `N²` at frequency zero.
#[derive(Clone, Copy, Debug)]
pub struct LowPass;

/// The sine and the cosine of 22.5 degrees.
const SINE_22: Real = by_precision(0.382_683_432_365_089_8, 0.382_683_43);
const COSINE_22: Real = by_precision(0.923_879_532_511_286_7, 0.923_879_5);

/// The time after which nothing remains of the autocovariance of three or four poles, in time constants: the slowest
/// pole has fallen to e⁻⁷, a thousandth.
const GONE: [Real; 2] = [14.0, 18.3];

/// The poles of a filter, those above the real axis and on it, each with the weight that its residue has. The pair
/// that is nearest to the imaginary axis comes first.
struct Poles {
    first: Pole,
    second: Option<Pole>,
}

impl Poles {
    fn new(shape: &SampledShape) -> Self {
        let [time_s, poles] = shape.parameters;
        let pole = |weight: Complex<Real>, decay: Real, turn: Real| {
            let frequency_hz = turn / (2.0 * PI * time_s);
            Pole::weighted(weight, time_s / decay, frequency_hz, shape.interval_s)
        };
        // The pole at −1, or a pair at −decay ± i turn, which counts twice.
        let real = Complex::new(1.0, 0.0);
        let pair =
            |decay: Real, turn: Real| pole(Complex::new(2.0 * decay, -2.0 * turn), decay, turn);
        if poles > 3.5 {
            Self {
                first: pair(SINE_22, COSINE_22),
                second: Some(pair(COSINE_22, SINE_22)),
            }
        } else if poles > 2.5 {
            Self {
                first: pair(0.5, SINE_60),
                second: Some(pole(real, 1.0, 0.0)),
            }
        } else if poles > 1.5 {
            Self {
                first: pair(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
                second: None,
            }
        } else {
            Self {
                first: pole(real, 1.0, 0.0),
                second: None,
            }
        }
    }

    /// The sum over the poles.
    fn sum(&self, of: impl Fn(&Pole) -> Real) -> Real {
        of(&self.first) + self.second.as_ref().map_or(0.0, of)
    }

    /// The variance `s²` of the rate for `N = 1`, with which the weights are multiplied.
    fn variance(&self, shape: &SampledShape) -> Real {
        1.0 / (self.sum(Pole::long_mean) * shape.interval_s)
    }

    /// The factor between the poles' kernels and that of the effect.
    fn scale(&self, shape: &SampledShape) -> Real {
        self.variance(shape) * shape.interval_s * shape.interval_s
    }
}

pub(super) const DESCRIPTION: Description = Description {
    name: "low_pass",
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
                low: 0.25 * span.interval_s,
                high: (64.0 * span.interval_s).min(0.1 * span.longest_tau_s),
                steps_per_octave: 3.0,
            },
            reciprocal: Some(Reciprocal {
                name: "cutoff_hz",
                unit: "Hz",
                product: 0.5 / PI,
            }),
        },
        Parameter {
            name: "poles",
            unit: "",
            is_whole: true,
            search_range: |_| SearchRange {
                low: 1.0,
                high: 4.0,
                steps_per_octave: 1.0,
            },
            reciprocal: None,
        },
    ],
    code: 9,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for LowPass {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let poles = Poles::new(shape);
        poles.scale(shape) * poles.sum(|pole| pole.kernel(lag))
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let poles = Poles::new(shape);
        poles.scale(shape) * poles.sum(|pole| pole.second_difference(x, m))
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        let poles = Poles::new(shape);
        poles.variance(shape) * poles.sum(|pole| pole.variance(m))
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        let poles = Poles::new(shape);
        let scale = poles.variance(shape);
        if poles.second.is_none() {
            poles.first.variances(factors, |value| each(scale * value));
            return;
        }
        for m in factors {
            each(scale * poles.sum(|pole| pole.variance(m)));
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let poles = Poles::new(shape);
        let weight = weight * poles.scale(shape);
        poles.first.add_second_differences(m, weight, sum);
        if let Some(second) = &poles.second {
            second.add_second_differences(m, weight, sum);
        }
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        let poles = Poles::new(shape);
        if let Some(second) = &poles.second {
            let [of_three, of_four] = GONE;
            let gone = if shape.parameters[1] > 3.5 {
                of_four
            } else {
                of_three
            };
            let gone = m + gone * shape.parameters[0] / shape.interval_s;
            if gone <= 95.0 * (0.25 * m).max(1.0) {
                return Some(Tail::none(gone));
            }
            let tail = Tail {
                start: m,
                decays: [&poles.first, second].map(|pole| Some(pole.decay_from(m))),
            };
            return Some(tail.scaled(poles.scale(shape)));
        }
        // The autocovariance of one pole has no detail.
        (shape.parameters[1] > 1.5).then(|| poles.first.tail(m).scaled(poles.scale(shape)))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        let poles = Poles::new(shape);
        let scale = poles.variance(shape);
        poles.first.variogram(m, scale, values);
        if let Some(second) = &poles.second {
            second.add_variogram(m, scale, values);
        }
    }
}

impl Explain for LowPass {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a low pass: white noise is cut off before it is sampled",
            origin: "an analogue filter, or a digital smoothing filter of one to four poles, in the sensor's signal path",
            check: "read the sensor's bandwidth setting; does the deficit at short averaging times move with it?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.02, 1.0], [0.008, 2.0], [0.02, 3.0], [0.012, 4.0]]
    }
}
