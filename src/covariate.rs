//! A covariate: anything that is sampled beside the gyro and that the rate may follow, such as a
//! temperature, its rate of change, an acceleration or a supply voltage.
//!
//! It is measured and not modelled: `D_g = D_noise + α D_x`, so that no kernel is needed, and the
//! covariate claims none of the curve's shapes. The slope comes from the octave sums as
//!
//! ```text
//! α̂ = Σ_k (n/m_k) C_gx,k / σ²_k  /  Σ_k (n/m_k) σ²_x,k / σ²_k,      Var α̂ = c / Σ_k (n/m_k) σ²_x,k / σ²_k
//! ```
//!
//! with `C_gx` and `σ²_x` of the [`CrossCurve`], `σ²` of the noise, and `n/m` clusters in an octave. An
//! octave sees the density of the covariate through `|H(f)|² = 2 sin⁴(πfτ)/(πfτ)²`, and all octaves
//! together weight it with `W(f) = Σ_k (n/m_k) |H_k(f)|²/σ²_k`, so that `c` is `W` times the noise's
//! density: 2 for white noise, whose `Σ|H|²` is 2, and `π²/(6 ln² 2) = 3.42` for flicker noise, from
//! `∫ sin⁴u/u⁴ du = π/3` over `(2 ln 2/π) B²`. What a gyro may follow is slow, so the value of flicker
//! noise is taken, which is on the cautious side where the noise is white.

mod cross_sums;

pub(crate) use cross_sums::CrossSums;
#[cfg(feature = "storage")]
pub(crate) use cross_sums::ProductSum;

use crate::{
    curve::{Curve, Point, Scale, clusters},
    effect::Explanation,
    error::Error,
    list::numbered,
    math,
    octave::Accumulator,
    real::{Real, real},
};
use heapless::Vec;

/// Its name in files and on the command line.
pub const NAME: &str = "covariate";

/// What to tell somebody whose gyro follows a covariate.
pub const EXPLANATION: Explanation = Explanation {
    what: "the rate follows something that was recorded alongside, such as the temperature",
    origin: "thermal expansion and the temperature of the drive's electronics; acceleration \
             through the suspension; a supply that feeds the reference",
    check: "hold the covariate steady and see the curve fall to what is left of it; or subtract \
            slope times covariate from the rate",
};

/// One octave of a gyro beside a covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrossPoint {
    /// Averaging factor.
    pub m: u32,
    /// Allan covariance `½ mean (D_g D_x)/m²`, in rate units times the covariate's.
    pub covariance: Real,
    /// The covariate's Allan variance, in its unit squared.
    pub variance: Real,
}

/// What a gyro and a covariate share, octave by octave: all that a diagnosis knows of the covariate.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrossCurve<const K: usize> {
    points: Vec<CrossPoint, K>,
}

impl<const K: usize> CrossCurve<K> {
    /// The cross curve of a gyro and a covariate that took the same samples and gaps, of the octaves
    /// that the gyro's curve has. `per_count` is the covariate's unit per count.
    pub(crate) fn new(
        gyro: &Accumulator<K>,
        covariate: &Accumulator<K>,
        products: &CrossSums<K>,
        scale: Scale,
        per_count: Real,
    ) -> Result<Self, Error> {
        Scale::new(per_count, scale.rate_hz())?;
        let mut points = Vec::new();
        for (k, (gyro_octave, covariate_octave)) in
            numbered(gyro.octaves().zip(covariate.octaves()))
        {
            if gyro_octave.differences < Curve::<K>::MIN_DIFFERENCES {
                continue;
            }
            // ½ mean (D_g/m)(D_x/m).
            let m = real(gyro_octave.m);
            let half_mean = 0.5 / (gyro_octave.differences as Real * m * m);
            let product = products.read(k, gyro, covariate).to_real();
            // There are as many octaves as there is room for.
            let _ = points.push(CrossPoint {
                m: gyro_octave.m,
                covariance: half_mean * product * scale.rate_per_count() * per_count,
                variance: half_mean * covariate_octave.sum.to_real() * per_count * per_count,
            });
        }
        Ok(Self { points })
    }

    /// The octaves, shortest averaging time first: those of the gyro's curve.
    pub fn points(&self) -> &[CrossPoint] {
        &self.points
    }

    /// Takes what follows the covariate off the gyro's curve, `σ²_g − 2α C_gx + α² σ²_x`. The slope's own
    /// error ε takes some of the noise away with it, on average `ε² σ²_x`, which is put back.
    #[inline(never)]
    pub fn correct(&self, curve: &mut Curve<K>, slope: &Slope) {
        let Slope { value, error } = *slope;
        curve.change_variances(|k, variance| match self.points.get(k) {
            Some(cross) => {
                let follows = value * (2.0 * cross.covariance - value * cross.variance);
                // It is a mean square, and falls below zero by rounding only.
                let rest = (variance - follows).max(variance * Real::EPSILON);
                rest + error * error * cross.variance
            }
            None => variance,
        });
    }

    /// The first octave in which the covariate is more than its sensor's noise: the very first, where
    /// the curve rises from the start, and also where it never rises and all of it is noise that the
    /// rate might follow.
    fn first_octave(&self) -> usize {
        let by_variance = |(_, a): &(usize, &CrossPoint), (_, b): &(usize, &CrossPoint)| {
            a.variance.total_cmp(&b.variance)
        };
        let least = numbered(self.points.iter()).min_by(by_variance);
        let Some((at, least)) = least.filter(|&(at, _)| at > 0) else {
            return 0;
        };
        let mut later = numbered(self.points.iter()).skip(at);
        later
            .find(|(_, point)| point.variance > RISEN * least.variance)
            .map_or(0, |(k, _)| k)
    }
}

/// A sensor's own noise, which the rate does not follow, would dilute the slope. Where a covariate's
/// curve falls before it rises, octaves count from where it has risen to this many times its least.
const RISEN: Real = 4.0;

/// Variance of a slope times the information that the octaves sum up.
const CAUTION: Real = 3.42;

/// How a rate follows a covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slope {
    /// Rate units per unit of the covariate, with sign.
    pub value: Real,
    /// Its standard error.
    pub error: Real,
}

impl Slope {
    /// The slope, where noise has the Allan variance `noise(k)` in octave `k`. `None` for a covariate
    /// that does not change.
    pub(crate) fn of<const K: usize>(
        cross: &CrossCurve<K>,
        points: &[Point],
        noise: impl Fn(usize) -> Real,
    ) -> Option<Self> {
        let first = cross.first_octave();
        let (mut product, mut information) = (0.0, 0.0);
        for (k, (point, cross)) in numbered(points.iter().zip(cross.points())).skip(first) {
            let weight = clusters(point) / noise(k);
            product += weight * cross.covariance;
            information += weight * cross.variance;
        }
        (information > 0.0 && information.is_finite()).then(|| Self {
            value: product / information,
            error: math::sqrt(CAUTION / information),
        })
    }

    /// The slope in standard errors.
    pub fn z(&self) -> Real {
        self.value / self.error
    }

    /// The 95 % interval.
    pub fn interval(&self) -> (Real, Real) {
        let half = 1.959_964 * self.error;
        (self.value - half, self.value + half)
    }
}
