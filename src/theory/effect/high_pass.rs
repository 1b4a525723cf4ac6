use super::{
    Description, Distribution, Effect, Explain, Explanation, MAX_PARAMETERS, Parameter,
    SampledShape, SearchRange, SecondDifferences,
    angle_random_walk::AngleRandomWalk,
    low_pass::CUTOFF,
    pole::{power, rest},
};
use crate::{
    numerics::real::{Real, real},
    theory::lattice,
};

/// Angle random walk that passed a high pass of first order. It takes the place of [`AngleRandomWalk`]. The coefficient
/// is `N` in rate · √s, that of the noise in front of the filter; the shape parameter is the time constant `T` of the
/// filter in seconds. The density is `N² f²/(f² + f_c²)` with the cut-off frequency `f_c = 1/(2πT)`, for frequencies
/// far below the sample rate.
///
/// With `z = e^(−τ₀/T)`, the sampled noise is white less a pole, `r(n) = (N²/τ₀) [δ(n) − zⁿ (1−z)/(1+z)]`, whose density
/// vanishes at frequency zero: it is that of `y_n = z y_(n−1) + √z (x_n − x_(n−1))` for white noise `x`. The angle
/// is therefore bounded: it is Gauss–Markov noise with
///
/// ```text
/// G(n) = τ₀ N² zⁿ z/(1−z²)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct HighPass;

/// The kernel without its constant: `−c (1 − zⁿ)`.
struct Angle {
    /// The decay per sample.
    decay: Real,
    /// `c = τ₀ z/(1−z²)`.
    size: Real,
}

impl Angle {
    fn new(shape: &SampledShape) -> Self {
        let [time_s, ..] = shape.parameters;
        let decay = shape.interval_s / time_s;
        Self {
            decay,
            size: shape.interval_s * power(decay, 0.0, 1.0).re / rest((2.0 * decay).into()).re,
        }
    }

    /// `1 − zⁿ`.
    fn gone(&self, n: Real) -> Real {
        rest((self.decay * n).into()).re
    }

    /// The second difference at `x ≥ m`, in which nothing cancels.
    fn beyond(&self, x: Real, m: Real) -> Real {
        let gone = self.gone(m);
        self.size * power(self.decay, 0.0, x - m).re * gone * gone
    }

    /// The second difference below `m`.
    fn within(&self, x: Real, m: Real) -> Real {
        self.size * (2.0 * self.gone(x) - self.gone(m + x) - self.gone(m - x))
    }
}

pub(super) static DESCRIPTION: Description = Description {
    name: "high_pass",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[Parameter {
        name: "time_constant_s",
        unit: "s",
        is_whole: false,
        search_range: |span| SearchRange {
            low: 2.0 * span.interval_s,
            high: 0.2 * span.longest_tau_s,
            steps_per_octave: 2.0,
        },
        reciprocal: Some(CUTOFF),
    }],
    code: 17,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Effect for HighPass {
    fn description(&self) -> &'static Description {
        &DESCRIPTION
    }

    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        let angle = Angle::new(shape);
        -angle.size * angle.gone(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        let angle = Angle::new(shape);
        if x < m {
            angle.within(x, m)
        } else {
            angle.beyond(x, m)
        }
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        // σ² = c (1−W) (3−W)/τ² with W = z^m.
        let angle = Angle::new(shape);
        let gone = angle.gone(m);
        let tau_s = m * shape.interval_s;
        angle.size * gone * (2.0 + gone) / (tau_s * tau_s)
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let angle = Angle::new(shape);
        let gone = angle.gone(m);
        let at_m = weight * angle.size * gone * gone;
        let mut powers = lattice::Powers::new(power(angle.decay, 0.0, 0.25 * m));
        let cluster = powers.near(4).re;
        sum.add_slots(|slot| {
            let (own, position) = (powers.next(slot).re, lattice::position(slot));
            if position < 4 {
                weight * angle.within(0.25 * m * real(position), m)
            } else if position == 4 {
                at_m
            } else if cluster > 0.0 {
                at_m * own / cluster
            } else {
                0.0
            }
        });
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        // γ(l) = c (1−W) [2 + (1−W) W^(l−1)]/τ².
        let angle = Angle::new(shape);
        let gone = angle.gone(m);
        let tau_s = m * shape.interval_s;
        let unit = angle.size * gone / (tau_s * tau_s);
        let block = power(angle.decay, 0.0, m).re;
        let mut left = gone;
        for value in values {
            *value = unit * (2.0 + left);
            left *= block;
        }
    }
}

impl Explain for HighPass {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a high pass: white noise is missing at low frequency, so that the angle does not walk away",
            origin: "a bias that is removed while logging: the sensor's high-pass filter, an output coupled by a capacitor, a running mean that is subtracted",
            check: "turn the gyro at a steady rate: does its output fall back to zero? switch the sensor's high-pass filter off",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.1, 0.0, 0.0], [2.0, 0.0, 0.0]]
    }
}
