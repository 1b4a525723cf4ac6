//! A covariate: any quantity that is sampled with the gyro and that the rate may follow, such as a
//! temperature, its rate of change, an acceleration or a supply voltage.
//!
//! A covariate is measured and not modelled: `D_g = D_noise + α D_x`. So it needs no kernel, and it
//! claims none of the curve's shapes. The slope `α` follows from the octave sums:
//!
//! ```text
//! α̂ = Σ_k (n/m_k) C_gx,k / σ²_k  /  Σ_k (n/m_k) σ²_x,k / σ²_k,      Var α̂ = c / Σ_k (n/m_k) σ²_x,k / σ²_k
//! ```
//!
//! Here `C_gx` and `σ²_x` are the numbers of the [`CrossCurve`], `σ²` is the Allan variance of the
//! noise, and `n/m` is the number of clusters in an octave. An octave sees the spectral density of the
//! covariate through `|H(f)|² = 2 sin⁴u/u²` with `u = πfτ`, and all octaves together weight it with
//! `W(f) = Σ_k (n/m_k) |H_k(f)|²/σ²_k`. The variance of the slope follows from `W²` times the densities of
//! the noise and of the covariate. So `c` is the mean of `W(f) S(f)` over the frequencies that inform about the
//! slope, where `S` is the density of the noise:
//!
//! | noise | `W S` |
//! |---|---|
//! | white | `2 Σ_k sin⁴u_k/u_k² = 2` |
//! | flicker | `π²/(6 ln² 2) = 3.42` on average, from `∫ sin⁴u/u⁴ du = π/3` over `(2 ln 2/π) B²` |
//! | random walk | `1.5 Σ_k sin⁴u_k/u_k⁴`: 1.5 for each octave that is shorter than the covariate's changes |
//!
//! A random walk makes octaves repeat each other, and a slow covariate does so too. The density of the noise follows
//! from the fitted model, and that of the covariate from its own Allan variances.

mod pair;
mod scatter;

pub use crate::record::lags::Lags;
pub use pair::Pair;
pub(crate) use pair::Slopes;

use crate::{
    curve::{Curve, Point, Scale, clusters},
    error::Error,
    limits::TWO_SIDED_95,
    list::{self, numbered},
    numerics::{
        math,
        real::{Real, real},
    },
    record::{cross_sums::CrossSums, octave::Accumulator},
    theory::effect::Explanation,
};
use heapless::Vec;

/// The name of a covariate in files and on the command line.
pub const NAME: &str = "covariate";

/// The explanation for the owner of a gyro that follows a covariate.
pub const EXPLANATION: Explanation = Explanation {
    what: "the rate follows something that was recorded alongside, such as the temperature",
    origin: "thermal expansion and the temperature of the drive's electronics; acceleration \
             through the suspension; a supply voltage that shifts the reference",
    check: "hold the covariate steady: the curve should fall by what follows the covariate; or \
            subtract slope times covariate from the rate",
};

/// One octave of a gyro and a covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct CrossPoint {
    /// Averaging factor.
    pub m: u32,
    /// Allan covariance `½ mean (D_g D_x)/m²`, in rate units times the covariate's unit.
    pub covariance: Real,
    /// The covariate's Allan variance, in its unit squared.
    pub variance: Real,
}

/// What a gyro and a covariate share, octave by octave. A diagnosis knows nothing else of the
/// covariate.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct CrossCurve<const K: usize> {
    points: Vec<CrossPoint, K>,
}

impl<const K: usize> CrossCurve<K> {
    /// The cross curve of a gyro and a covariate that took the same samples and gaps. It has the
    /// octaves of the gyro's curve. One count of the covariate stands for `per_count` of its unit.
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
            // The factors of ½ mean (D_g/m)(D_x/m).
            let m = real(gyro_octave.m);
            let half_mean = 0.5 / (gyro_octave.differences as Real * m * m);
            let product = products.read(k, gyro, covariate).to_real();
            // There is room for every octave.
            let _ = points.push(CrossPoint {
                m: gyro_octave.m,
                covariance: half_mean * product * scale.rate_per_count() * per_count,
                variance: half_mean * covariate_octave.sum.to_real() * per_count * per_count,
            });
        }
        Ok(Self { points })
    }

    /// A cross curve from octaves that were computed elsewhere, shortest averaging time first. They have to be those of
    /// the gyro's curve. Octaves beyond `K` are left out.
    pub fn of_points(points: impl IntoIterator<Item = CrossPoint>) -> Self {
        Self {
            points: list::fill(points),
        }
    }

    /// The octaves, shortest averaging time first. They are the octaves of the gyro's curve.
    pub fn points(&self) -> &[CrossPoint] {
        &self.points
    }

    /// The first octave in which the covariate exceeds its sensor's noise. This is octave 0 where the
    /// curve rises from the start. It is octave 0 as well where the curve never rises: then the rate
    /// might follow the noise.
    ///
    /// What counts is the least variance so far. A cycle has little of it at its own period, far behind the noise.
    pub fn first_octave(&self) -> usize {
        let mut least = (0, Real::INFINITY);
        for (k, point) in numbered(self.points.iter()) {
            if point.variance > RISEN * least.1 {
                return if least.0 > 0 { k } else { 0 };
            }
            if point.variance < least.1 {
                least = (k, point.variance);
            }
        }
        0
    }
}

/// The rise above the least variance of a covariate from which on octaves count, where the covariate's
/// curve falls before it rises. The octaves before hold the sensor's own noise, which the rate does not
/// follow and which would dilute the slope. Chosen by hand: at most a quarter of the variance is then
/// noise that does not grow with τ. `cargo xtask study thermal` runs with this value and does not vary
/// it.
const RISEN: Real = 4.0;

/// The slope with which a rate follows a covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slope {
    /// Rate units per unit of the covariate, positive or negative.
    pub value: Real,
    /// Standard error of the slope, in the same unit.
    pub error: Real,
}

impl Slope {
    /// The slope, where the noise has the Allan variance `noise(k)` in octave `k`, in rate units squared. `points` are
    /// those of the gyro's curve. `None` if the covariate does not change.
    pub fn of<const K: usize>(
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
        let points = cross.points().iter().map(|point| (point.m, point.variance));
        let factor = scatter::factor::<K>(points, first, &noise);
        (information > 0.0 && information.is_finite()).then(|| Self {
            value: product / information,
            error: math::sqrt(factor / information),
        })
    }

    /// The slope divided by its standard error.
    pub fn z(&self) -> Real {
        self.value / self.error
    }

    /// The lower and the upper end of the slope's 95 % interval.
    pub fn interval(&self) -> (Real, Real) {
        let half = real(TWO_SIDED_95) * self.error;
        (self.value - half, self.value + half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_of_a_sensor_ends_where_the_curve_rises_for_the_first_time() {
        let first = |variances: &[Real]| {
            let points = (0..).zip(variances).map(|(k, &variance)| CrossPoint {
                m: 1 << k,
                covariance: 0.0,
                variance,
            });
            CrossCurve::<12>::of_points(points).first_octave()
        };
        assert_eq!(first(&[1.0, 4.5, 16.0]), 0);
        assert_eq!(first(&[4.0, 2.0, 1.0, 0.5]), 0);
        assert_eq!(first(&[4.0, 2.0, 1.0, 1.5, 6.0, 24.0]), 4);
        // A cycle nearly vanishes at its own period.
        assert_eq!(first(&[4.0, 2.0, 1.0, 1.5, 6.0, 24.0, 0.1, 0.3]), 4);
    }
}
