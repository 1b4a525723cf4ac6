use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, Reciprocal,
    SampledShape, SearchRange, angle_random_walk::AngleRandomWalk, filter::Output, pole::Pole,
    stationary::Stationary,
};
use crate::numerics::real::{
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

/// A pole of an analogue filter with a cut-off of one: its decay, and its turn, which is zero on the real axis. One
/// above the axis stands for itself and its conjugate.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) decay: Real,
    pub(super) turn: Real,
}

/// The poles of a Butterworth filter, those above the real axis and on it. The pair that is nearest to the imaginary axis
/// comes first.
pub(super) fn butterworth(poles: Real) -> (Place, Option<Place>) {
    let place = |decay, turn| Place { decay, turn };
    if poles > 3.5 {
        (place(SINE_22, COSINE_22), Some(place(COSINE_22, SINE_22)))
    } else if poles > 2.5 {
        (place(0.5, SINE_60), Some(place(1.0, 0.0)))
    } else if poles > 1.5 {
        (place(FRAC_1_SQRT_2, FRAC_1_SQRT_2), None)
    } else {
        (place(1.0, 0.0), None)
    }
}

/// The cut-off frequency, which is known as well as a time constant.
pub(super) const CUTOFF: Reciprocal = Reciprocal {
    name: "cutoff_hz",
    unit: "Hz",
    product: 0.5 / PI,
};

/// The number of poles.
pub(super) const POLES: Parameter = Parameter {
    name: "poles",
    unit: "",
    is_whole: true,
    search_range: |_| SearchRange {
        low: 1.0,
        high: 4.0,
        steps_per_octave: 1.0,
    },
    reciprocal: None,
};

pub(super) static DESCRIPTION: Description = Description {
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
            reciprocal: Some(CUTOFF),
        },
        POLES,
    ],
    code: 9,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Stationary for LowPass {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        let [time_s, poles, ..] = shape.parameters;
        let samples = shape.interval_s / time_s;
        let pole = |Place { decay, turn }: Place| {
            let weight = if turn > 0.0 {
                Complex::new(2.0 * decay, -2.0 * turn)
            } else {
                Complex::new(decay, 0.0)
            };
            Pole::at(weight, decay * samples, turn * samples / (2.0 * PI))
        };
        let (first, second) = butterworth(poles);
        Output::of_poles(pole(first), second.map(pole))
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
        &[
            [0.02, 1.0, 0.0],
            [0.008, 2.0, 0.0],
            [0.02, 3.0, 0.0],
            [0.012, 4.0, 0.0],
        ]
    }
}
