use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange,
    angle_random_walk::AngleRandomWalk,
    filter::Output,
    low_pass::{CUTOFF, LowPass},
    pole::{Pole, rest},
    stationary::Stationary,
};
use crate::numerics::real::{
    Real, by_precision,
    consts::{FRAC_1_SQRT_2, PI},
};
use nalgebra::Complex;

/// Angle random walk that passed two to four equal digital filters of first order in series, `y += α (x − y)`. It takes
/// the place of [`AngleRandomWalk`]. The coefficient is `N` in rate · √s; the shape parameters are the time constant `T`
/// of one stage in seconds and the number of stages. Each stage has the pole `z = e^(−τ₀/T) = 1 − α`, and its density has
/// fallen to a half at the frequency `1/(2πT)`, as long as that is far below half the sample rate. One stage alone is a
/// [`LowPass`](super::LowPass) of one pole.
///
/// The density is `N² [(1−z)²/|1 − z e^(iω)|²]^p` for `p` stages. Its pole of order `p` is replaced by `p` simple ones
/// on a small circle, at the exponents `(τ₀/T) (1 + ρ e^(iθ_k))` with angles that divide the circle into equal parts. The
/// mean of any power below the `p`-th over such a circle is the power of the middle, so that the density is wrong by
/// about `2ρ^p`: by at most 1e-3. The weights of the poles grow with `1/ρ^(p−1)`, so that a smaller circle would
/// cost as much by rounding: of single precision, in which the covariance of a curve is always summed.
#[derive(Clone, Copy, Debug)]
pub struct Cascade;

/// The radius `ρ` for two, three and four stages.
const RADII: [Real; 3] = [0.016, 0.07, 0.13];

/// The sine of 60 degrees, √3/2.
const SINE_60: Real = by_precision(0.866_025_403_784_438_6, 0.866_025_4);

/// The largest exponent of a stage per sample: nothing is left of a filter that is faster.
const FASTEST: Real = 30.0;

/// The exponent at which the autocovariance is as good as gone. A pole of fourth order leaves
/// (1 + x + 2x²/5 + x³/15) e^(−x), which is 5e-4 here.
const GONE: Real = 13.0;

/// The filter with simple poles.
struct Stages {
    /// The exponents above the real axis, and one on it if their number is odd.
    first: Complex<Real>,
    second: Option<Complex<Real>>,
}

impl Stages {
    /// `e^(iθ_k)` times the radius and the exponent, below the real axis: the pole of an exponent is above it.
    fn new(exponent: Real, stages: Real) -> Self {
        let [two, three, four] = RADII;
        let at = |radius: Real, cosine: Real, sine: Real| {
            Complex::new(1.0 + radius * cosine, -radius * sine) * exponent
        };
        let half = FRAC_1_SQRT_2;
        if stages > 3.5 {
            Self {
                first: at(four, half, half),
                second: Some(at(four, -half, half)),
            }
        } else if stages > 2.5 {
            Self {
                first: at(three, -0.5, SINE_60),
                second: Some(at(three, 1.0, 0.0)),
            }
        } else {
            Self {
                first: at(two, 0.0, 1.0),
                second: None,
            }
        }
    }

    /// All exponents, the conjugate ones too.
    fn all(&self) -> impl Iterator<Item = Complex<Real>> {
        let both = [Some(self.first), self.second];
        both.into_iter().flatten().flat_map(|one| {
            let other = (one.im != 0.0).then(|| one.conj());
            [Some(one), other].into_iter().flatten()
        })
    }

    /// The pole of an exponent `s`, with the residue of the density
    /// `Π (1−e^(−s_j))² / [Π_(j≠i) (1−e^(s_i−s_j)) Π_j (1−e^(−s_i−s_j))]`.
    fn pole(&self, s: Complex<Real>) -> Pole {
        let mut weight = Complex::new(if s.im == 0.0 { 1.0 } else { 2.0 }, 0.0);
        for other in self.all() {
            let passed = rest(other);
            weight *= passed * passed / rest(s + other);
            if other != s {
                weight /= rest(other - s);
            }
        }
        Pole::at(weight, s.re, -s.im / (2.0 * PI))
    }
}

pub(super) static DESCRIPTION: Description = Description {
    name: "cascade",
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
                high: (32.0 * span.interval_s).min(0.1 * span.longest_tau_s),
                steps_per_octave: 3.0,
            },
            reciprocal: Some(CUTOFF),
        },
        Parameter {
            name: "stages",
            unit: "",
            is_whole: true,
            search_range: |_| SearchRange {
                low: 2.0,
                high: 4.0,
                steps_per_octave: 1.0,
            },
            reciprocal: None,
        },
    ],
    code: 15,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: Some(&LowPass),
    distribution: Distribution::Gaussian,
};

impl Stationary for Cascade {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Output;

    fn process(shape: &SampledShape) -> Output {
        let [time_s, stages, ..] = shape.parameters;
        let stages = Stages::new((shape.interval_s / time_s).min(FASTEST), stages);
        let second = stages.second.map(|second| stages.pole(second));
        let mut output = Output::new(0.0, stages.pole(stages.first), second);
        output.gone = GONE;
        output
    }
}

impl Explain for Cascade {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a cascade: white noise passed several equal smoothing filters, one behind the other",
            origin: "the PT2, PT3 or PT4 filter of a flight controller, or an exponential mean that is taken twice",
            check: "read the filter settings of the logging firmware; switch its filters off one by one: does the noise at high frequency come back?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.01, 2.0, 0.0], [0.02, 3.0, 0.0], [0.015, 4.0, 0.0]]
    }
}
