use super::{
    Description, Distribution, Explain, Explanation, MAX_PARAMETERS, Parameter, SampledShape,
    SearchRange, SecondDifferences, Tail,
    angle_random_walk::AngleRandomWalk,
    stationary::{Process, Stationary},
};
use crate::{numerics::math, numerics::real::Real};

/// Angle random walk that passed a decimation filter. It takes the place of [`AngleRandomWalk`]. The
/// coefficient is `N` in rate · √s; the shape parameters are the width of the filter in seconds, up to
/// 64 samples, and the number of its stages. One stage is a moving average, two are a Bartlett
/// (triangular) window.
///
/// The width is that of the single boxcar that spreads a pulse as far as all stages together: each stage
/// is a boxcar of length `w = width/√stages`. Therefore the width is known even if the filter spans so few
/// samples that the number of stages is not.
///
/// The autocovariance of the rate is a sampled B-spline of order `2 · stages`, `r_i ∝ B(iτ₀/w)` with
/// `τ₀ Σ r_i = N²`, and `G(n) = −½ τ₀² [n r₀ + 2 Σ_{0<i<n} (n−i) r_i]`.
#[derive(Clone, Copy, Debug)]
pub struct DecimationFilter;

/// The largest width in samples, which bounds the sums over the autocovariance. Chosen by hand: a
/// search goes to half of it.
const WIDEST: Real = 64.0;

/// The autocovariance at a lag of `x` lengths of a stage, up to a constant factor.
fn spline(x: Real, stages: Real) -> Real {
    if stages < 1.5 {
        return (1.0 - x).max(0.0);
    }
    if x < 1.0 {
        2.0 / 3.0 - x * x + 0.5 * x * x * x
    } else if x < 2.0 {
        let rest = 2.0 - x;
        rest * rest * rest / 6.0
    } else {
        0.0
    }
}

/// White noise behind boxcars in series: the sampled autocovariance `r_i`, scaled so that its sum over all lags is 1.
pub(super) struct Boxcars {
    /// The reciprocal of a stage's length in samples.
    per_sample: Real,
    /// The number of stages.
    stages: Real,
    /// The lag in samples from which on the autocovariance is zero.
    support: Real,
    /// The factor that scales the spline.
    scale: Real,
    /// The sum 2 Σ_{i>0} i r_i.
    moment: Real,
}

impl Boxcars {
    /// So many boxcars, each of this width in samples.
    fn new(width: Real, stages: Real) -> Self {
        let width = width.clamp(1e-3, WIDEST);
        let mut boxcars = Self {
            per_sample: 1.0 / width,
            stages,
            support: math::ceil(width * if stages < 1.5 { 1.0 } else { 2.0 }),
            scale: 1.0,
            moment: 0.0,
        };
        let (mut sum, mut moment) = (boxcars.at(0.0), 0.0);
        let mut i = 1.0;
        while i < boxcars.support {
            let here = 2.0 * boxcars.at(i);
            sum += here;
            moment += i * here;
            i += 1.0;
        }
        boxcars.scale = 1.0 / sum;
        boxcars.moment = moment * boxcars.scale;
        boxcars
    }

    /// The autocovariance `r_i`.
    fn at(&self, i: Real) -> Real {
        self.scale * spline(i * self.per_sample, self.stages)
    }

    /// The sum `n r₀ + 2 Σ_{0<i<n} (n−i) r_i`.
    fn sum(&self, n: Real) -> Real {
        if n >= self.support {
            return n - self.moment;
        }
        let mut sum = n * self.at(0.0);
        let mut i = 1.0;
        while i < n {
            sum += 2.0 * (n - i) * self.at(i);
            i += 1.0;
        }
        sum
    }

    /// The autocovariance of the means of blocks of `m` samples, at a distance of `x` samples:
    /// `Σ_i (m − |i − x|) r_i/m²` over all `i` within a block of `x`.
    fn of_means(&self, x: Real, m: Real) -> Real {
        let end = self.support.min(x + m);
        let mut i = (1.0 - self.support).max(x - m + 1.0);
        let mut sum = 0.0;
        while i < end {
            let (lag, apart) = (i.max(-i), (i - x).max(x - i));
            sum += (m - apart) * self.at(lag);
            i += 1.0;
        }
        sum / (m * m)
    }

    /// The second difference of [`sum`](Self::sum).
    fn second_difference(&self, x: Real, m: Real) -> Real {
        if x >= m + self.support {
            return 0.0;
        }
        if m == 1.0 {
            // Nothing cancels in the autocovariance itself.
            return 2.0 * self.at(x);
        }
        let apart = if x < m { m - x } else { x - m };
        self.sum(x + m) - 2.0 * self.sum(x) + self.sum(apart)
    }
}

pub(super) static DESCRIPTION: Description = Description {
    name: "decimation_filter",
    symbol: "N",
    coefficient: "angle_random_walk",
    half_seconds: 1,
    reference_s: None,
    parameters: &[
        Parameter {
            name: "width_s",
            unit: "s",
            is_whole: false,
            search_range: |span| SearchRange {
                low: 0.6 * span.interval_s,
                high: (32.0 * span.interval_s).min(0.1 * span.longest_tau_s),
                steps_per_octave: 4.0,
            },
            reciprocal: None,
        },
        Parameter {
            name: "stages",
            unit: "",
            is_whole: true,
            search_range: |_| SearchRange {
                low: 1.0,
                high: 2.0,
                steps_per_octave: 1.0,
            },
            reciprocal: None,
        },
    ],
    code: 10,
    replaces: Some(&AngleRandomWalk),
    mirror: None,
    special_case: None,
    distribution: Distribution::Gaussian,
};

impl Process for Boxcars {
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        -0.5 * shape.interval_s * self.sum(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        -0.5 * shape.interval_s * self.second_difference(x, m)
    }

    fn variance(&self, m: Real, shape: &SampledShape) -> Real {
        let tau_s = m * shape.interval_s;
        let difference = |x| Process::second_difference(self, x, m, shape);
        (difference(m) - difference(0.0)) / (tau_s * tau_s)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        shape: &SampledShape,
        each: &mut dyn FnMut(Real),
    ) {
        let mut last: Option<(Real, Real)> = None;
        for m in factors {
            let own = match last {
                Some((before, sum)) if before == m => sum,
                _ => self.sum(m),
            };
            let double = self.sum(2.0 * m);
            last = Some((2.0 * m, double));
            // σ² = [3 G(0) − 4 G(m) + G(2m)]/τ².
            each(0.5 * (4.0 * own - double) / (m * m * shape.interval_s));
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let weight = -0.5 * shape.interval_s * weight;
        sum.add_below(m, m + self.support, |x| {
            weight * self.second_difference(x, m)
        });
    }

    /// The autocovariance may end within the part of the lattice that is coarse.
    fn tail(&self, m: Real, _: &SampledShape) -> Option<Tail> {
        (self.support > 2.0 * m).then(|| Tail::none(m + self.support))
    }

    fn variogram(&self, m: Real, shape: &SampledShape, values: &mut [Real]) {
        let at_zero = self.of_means(0.0, m);
        let mut distance = m;
        for value in values {
            *value = (at_zero - self.of_means(distance, m)) / shape.interval_s;
            distance += m;
        }
    }
}

impl Stationary for DecimationFilter {
    const DESCRIPTION: &'static Description = &DESCRIPTION;

    type Process = Boxcars;

    fn process(shape: &SampledShape) -> Boxcars {
        let [width_s, stages, ..] = shape.parameters;
        let width = width_s / (shape.interval_s * math::sqrt(stages.max(1.0)));
        Boxcars::new(width, stages)
    }
}

impl Explain for DecimationFilter {
    fn explanation(&self) -> Explanation {
        Explanation {
            what: "a decimation filter: white noise is averaged over longer than a sample interval",
            origin: "the sensor's own digital filter, a moving average or a Bartlett window, set to a bandwidth below half the output rate",
            check: "read the sensor's filter register and its group delay; widen the filter: does the deficit at short averaging times vanish?",
        }
    }

    fn typical_shapes(&self) -> &'static [[Real; MAX_PARAMETERS]] {
        &[[0.03, 1.0, 0.0], [0.03, 2.0, 0.0]]
    }
}
