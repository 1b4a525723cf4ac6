//! Two covariates whose slopes are estimated together, such as a temperature and its rate of change.

use super::{CrossCurve, Slope, scatter};
use crate::{
    curve::{Point, clusters},
    list::numbered,
    numerics::{math, real::Real},
};

/// Two covariates that may act together. A rate that follows a temperature with a lag depends on the
/// temperature and on its rate of change.
///
/// Where two covariates take similar courses, each slope alone would take a part of the other one. So both follow
/// from the normal equations `Σ_j A_ij α_j = b_i`, whose sums are those of the single slopes:
///
/// ```text
/// A_ij = Σ_k (n/m_k) C_ij,k / σ²_k,      b_i = Σ_k (n/m_k) C_gi,k / σ²_k
/// ```
///
/// `C_ij` is the Allan covariance of the two covariates, which is what [`shared`](Self::shared) holds. The covariance
/// of the right side is taken as `√(c_i c_j) A_ij`, with the factors `c` of the single slopes. For a pair it is exact
/// where both factors are equal, as for white noise.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct Pair<const K: usize> {
    /// The covariates' places among [`Record::covariates`](crate::Record::covariates).
    pub covariates: [usize; 2],
    /// The cross curve of the two: that of an axis whose counts are the first covariate's, with the second one as its
    /// covariate. It has the octaves of the gyro's curve.
    pub shared: CrossCurve<K>,
}

impl<const K: usize> Pair<K> {
    /// The slopes of both, where the noise has the Allan variance `noise(k)` in octave `k`, in rate units squared.
    /// `covariates` are those of the evidence and `points` those of the gyro's curve. `None` if a covariate does not
    /// change or if the two take the same course.
    pub fn slopes(
        &self,
        covariates: &[CrossCurve<K>],
        points: &[Point],
        noise: impl Fn(usize) -> Real,
    ) -> Option<[Slope; 2]> {
        let [one, other] = self.covariates;
        let crosses = [covariates.get(one)?, covariates.get(other)?];
        Slopes::of(self, crosses, points, noise).map(|both| both.slopes)
    }
}

/// The slopes of two covariates that act together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    pub(crate) slopes: [Slope; 2],
    /// The correlation of their errors.
    pub(crate) correlation: Real,
}

/// The share of a covariate's information that must remain beside the other one. With less, two exponentials of nearly
/// one time constant would be told apart by rounding alone. Chosen by hand: errors are then 30 times those of the
/// single slope, and the sums of single precision hold four digits more.
const LEAST_OWN: Real = 1e-3;

impl Slopes {
    /// The slopes, where the noise has the Allan variance `noise(k)` in octave `k`. `None` if a covariate does not
    /// change or if the two take the same course.
    pub(crate) fn of<const K: usize>(
        pair: &Pair<K>,
        crosses: [&CrossCurve<K>; 2],
        points: &[Point],
        noise: impl Fn(usize) -> Real,
    ) -> Option<Self> {
        let [one, other] = crosses;
        let first = one.first_octave().max(other.first_octave());
        let (mut products, mut informations, mut shared) = ([0.0; 2], [0.0; 2], 0.0);
        let all = points.iter().zip(pair.shared.points());
        let all = all.zip(one.points().iter().zip(other.points()));
        for (k, ((point, between), (one, other))) in numbered(all).skip(first) {
            let weight = clusters(point) / noise(k);
            let [product, other_product] = &mut products;
            let [information, other_information] = &mut informations;
            *product += weight * one.covariance;
            *other_product += weight * other.covariance;
            *information += weight * one.variance;
            *other_information += weight * other.variance;
            shared += weight * between.covariance;
        }
        let factors = crosses.map(|cross| {
            let points = cross.points().iter().map(|point| (point.m, point.variance));
            scatter::factor::<K>(points, first, &noise)
        });
        Self::solve(products, informations, shared, factors)
    }

    /// Solves the normal equations of two covariates in units in which their information is one.
    fn solve(
        products: [Real; 2],
        informations: [Real; 2],
        shared: Real,
        factors: [Real; 2],
    ) -> Option<Self> {
        let [unit, other_unit] = informations.map(math::sqrt);
        let r = shared / unit / other_unit;
        let own = 1.0 - r * r;
        // Also false where a number is not finite.
        if !(own > LEAST_OWN && unit.is_finite() && other_unit.is_finite()) {
            return None;
        }
        let [product, other_product] = products;
        let (b, other_b) = (product / unit, other_product / other_unit);
        let [c, other_c] = factors;
        let between = r * math::sqrt(c * other_c);
        let variance = (c - 2.0 * r * between + r * r * other_c) / (own * own);
        let other_variance = (other_c - 2.0 * r * between + r * r * c) / (own * own);
        let covariance = ((1.0 + r * r) * between - r * (c + other_c)) / (own * own);
        let (error, other_error) = (math::sqrt(variance), math::sqrt(other_variance));
        Some(Self {
            slopes: [
                Slope {
                    value: (b - r * other_b) / own / unit,
                    error: error / unit,
                },
                Slope {
                    value: (other_b - r * b) / own / other_unit,
                    error: other_error / other_unit,
                },
            ],
            correlation: (covariance / error / other_error).clamp(-1.0, 1.0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_solve_the_normal_equations_and_have_the_covariance_of_a_direct_computation() {
        let (informations, shared): ([Real; 2], Real) = ([4.0, 25.0], -6.0);
        let true_slopes = [0.3, -0.2];
        let products = [
            informations[0] * true_slopes[0] + shared * true_slopes[1],
            shared * true_slopes[0] + informations[1] * true_slopes[1],
        ];
        let factors: [Real; 2] = [2.0, 4.5];
        let found = Slopes::solve(products, informations, shared, factors).unwrap();
        // A⁻¹ M A⁻¹ with A⁻¹ = [25 6; 6 4]/64 and M = [8 -18; -18 112.5].
        let inverse = [[25.0 / 64.0, 6.0 / 64.0], [6.0 / 64.0, 4.0 / 64.0]];
        let m: [[Real; 2]; 2] = [[8.0, -18.0], [-18.0, 112.5]];
        let covariance = |i: usize, j: usize| {
            let pairs = [(0, 0), (0, 1), (1, 0), (1, 1)];
            let terms = pairs.map(|(k, l)| inverse[i][k] * m[k][l] * inverse[l][j]);
            terms.iter().sum::<Real>()
        };
        for (i, (slope, true_slope)) in found.slopes.iter().zip(true_slopes).enumerate() {
            let error = math::sqrt(covariance(i, i));
            assert!((slope.value - true_slope).abs() < 1e-5);
            assert!((slope.error / error - 1.0).abs() < 1e-5);
        }
        let variances = covariance(0, 0) * covariance(1, 1);
        let correlation = covariance(0, 1) / math::sqrt(variances);
        assert!((found.correlation - correlation).abs() < 1e-5);
        assert!(Slopes::solve(products, informations, 9.9999, factors).is_none());
    }
}
