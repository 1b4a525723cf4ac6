use super::{
    AngleRandomWalk, Effect, Explain, Parameter, Range, SecondDifferences, Setting, Span, Story,
};
use crate::math;
use crate::real::Real;

/// Angle random walk behind a decimation filter of `stages` boxcars, coefficient N in rate · √s:
/// takes the place of [`AngleRandomWalk`]. One stage is a moving average, two are a Bartlett
/// (triangular) window.
///
/// `width` is that of the one boxcar that spreads a pulse as far: each of the stages is
/// `w = width/√stages` long. Where a filter reaches over few samples, this much can be told, and not
/// the stages.
///
/// The rate's autocovariance is the B-spline of order `2 · stages`, sampled: `r_i ∝ B(iτ₀/w)` with
/// `τ₀ Σ r_i = N²`, and `G(n) = −½ τ₀² [n r₀ + 2 Σ_{i<n} (n−i) r_i]`.
#[derive(Clone, Copy, Debug)]
pub struct DecimationFilter;

/// Widths up to so many samples: the sums over the autocovariance stay short.
const WIDEST: Real = 64.0;

/// The autocovariance at a lag of `x` widths, up to a factor, and the lag from which it is zero.
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

/// The sampled autocovariance, normalised.
struct Filter {
    per_sample: Real,
    stages: Real,
    /// Lags from which on it is zero.
    support: Real,
    /// 1/Σ r_i.
    scale: Real,
    /// 2 Σ_{i>0} i r_i.
    moment: Real,
}

impl Filter {
    fn new(setting: &Setting) -> Self {
        let [width_s, stages] = setting.parameters;
        let width = width_s / (setting.interval_s * math::sqrt(stages.max(1.0)));
        let width = width.clamp(1e-3, WIDEST);
        let mut filter = Self {
            per_sample: 1.0 / width,
            stages,
            support: math::ceil(width * if stages < 1.5 { 1.0 } else { 2.0 }),
            scale: 1.0,
            moment: 0.0,
        };
        let (mut sum, mut moment) = (filter.at(0.0), 0.0);
        let mut i = 1.0;
        while i < filter.support {
            let here = 2.0 * filter.at(i);
            sum += here;
            moment += i * here;
            i += 1.0;
        }
        filter.scale = 1.0 / sum;
        filter.moment = moment * filter.scale;
        filter
    }

    fn at(&self, i: Real) -> Real {
        self.scale * spline(i * self.per_sample, self.stages)
    }

    /// `n r₀ + 2 Σ_{i<n} (n−i) r_i`.
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

    /// A second difference of the sums.
    fn second_difference(&self, x: Real, m: Real) -> Real {
        if x >= m + self.support {
            return 0.0;
        }
        let apart = if x < m { m - x } else { x - m };
        self.sum(x + m) - 2.0 * self.sum(x) + self.sum(apart)
    }
}

impl Effect for DecimationFilter {
    fn name(&self) -> &'static str {
        "decimation_filter"
    }

    fn symbol(&self) -> &'static str {
        "N"
    }

    fn coefficient(&self) -> &'static str {
        "angle_random_walk"
    }

    fn half_seconds(&self) -> i8 {
        1
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[
            Parameter {
                name: "width_s",
                unit: "s",
            },
            Parameter {
                name: "stages",
                unit: "",
            },
        ]
    }

    fn range(&self, parameter: usize, span: &Span) -> Range {
        match parameter {
            0 => Range {
                low: 0.6 * span.interval_s,
                high: (32.0 * span.interval_s).min(0.1 * span.longest_tau_s),
                steps_per_octave: 4.0,
            },
            _ => Range {
                low: 1.0,
                high: 2.0,
                steps_per_octave: 1.0,
            },
        }
    }

    fn is_whole(&self, parameter: usize) -> bool {
        parameter == 1
    }

    fn replaces(&self) -> Option<&'static dyn Effect> {
        Some(&AngleRandomWalk)
    }

    fn kernel(&self, lag: Real, setting: &Setting) -> Real {
        -0.5 * setting.interval_s * Filter::new(setting).sum(lag)
    }

    fn second_difference(&self, x: Real, m: Real, setting: &Setting) -> Real {
        -0.5 * setting.interval_s * Filter::new(setting).second_difference(x, m)
    }

    fn variances(
        &self,
        factors: &mut dyn Iterator<Item = Real>,
        setting: &Setting,
        each: &mut dyn FnMut(Real),
    ) {
        let filter = Filter::new(setting);
        let mut last: Option<(Real, Real)> = None;
        for m in factors {
            let own = match last {
                Some((before, sum)) if before == m => sum,
                _ => filter.sum(m),
            };
            let double = filter.sum(2.0 * m);
            last = Some((2.0 * m, double));
            // 3 G(0) − 4 G(m) + G(2m), over τ².
            each(0.5 * (4.0 * own - double) / (m * m * setting.interval_s));
        }
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        setting: &Setting,
        sum: &mut SecondDifferences,
    ) {
        let filter = Filter::new(setting);
        let weight = -0.5 * setting.interval_s * weight;
        sum.add_below(m, m + filter.support, |x| {
            weight * filter.second_difference(x, m)
        });
    }
}

impl Explain for DecimationFilter {
    fn story(&self) -> Story {
        Story {
            what: "a decimation filter: white noise is averaged over longer than a sample interval",
            origin: "the sensor's own digital filter, a moving average or a Bartlett window, set to fewer hertz than the output rate carries",
            check: "read the sensor's filter register and its group delay; open the filter and see the deficit at short averaging times go",
        }
    }
}
