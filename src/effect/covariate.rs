//! A covariate: the rate follows something that was sampled alongside.
//!
//! Measured and not modelled: `D_g = D_noise + α D_x`, so that no kernel is needed, and none of the
//! curve's shapes is claimed. The slope comes from the octave sums as
//!
//! ```text
//! α̂ = Σ_k (n/m_k) C_gx,k / σ²_k  /  Σ_k (n/m_k) σ²_x,k / σ²_k,      Var α̂ = c / Σ_k (n/m_k) σ²_x,k / σ²_k
//! ```
//!
//! with `C_gx` and `σ²_x` of the [`CrossCurve`], `σ²` of the noise, `n/m` clusters in an octave. An
//! octave sees the density of the covariate through `|H(f)|² = 2 sin⁴(πfτ)/(πfτ)²`, and all octaves
//! together weight it with `W(f) = Σ_k (n/m_k) |H_k(f)|²/σ²_k`, so that `c` is `W` times the noise's
//! density: 2 for white noise, whose `Σ|H|²` is 2, and `π²/(6 ln² 2) = 3.42` for flicker noise, from
//! `∫ sin⁴u/u⁴ du = π/3` over `(2 ln 2/π) B²`. What a gyro may follow is slow, so that flicker's is
//! taken: on the cautious side above white noise.

use super::Explanation;
use crate::{
    cross_sums::CrossCurve,
    curve::Point,
    fit::clusters,
    limits::TWO_SIDED_95,
    list::numbered,
    math,
    real::{Real, real},
};

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
        let first = first_own(cross);
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
        let half = real(TWO_SIDED_95) * self.error;
        (self.value - half, self.value + half)
    }
}

/// A sensor's own noise, which the rate does not follow, would dilute the slope: where a covariate's
/// curve falls before it rises, octaves count from where it has risen to this many times its least.
const RISEN: Real = 4.0;

/// The first octave in which the covariate is more than its sensor's noise: the very first, where the
/// curve rises from the start; so too, where it never rises and all of it is noise that the rate might
/// follow.
fn first_own<const K: usize>(cross: &CrossCurve<K>) -> usize {
    let points = cross.points();
    let least = numbered(points.iter()).min_by(|(_, a), (_, b)| a.variance.total_cmp(&b.variance));
    let Some((at, least)) = least.filter(|&(at, _)| at > 0) else {
        return 0;
    };
    let mut later = numbered(points.iter()).skip(at);
    later
        .find(|(_, point)| point.variance > RISEN * least.variance)
        .map_or(0, |(k, _)| k)
}
