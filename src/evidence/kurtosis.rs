//! Evidence beyond the curve: whether the differences have a Gaussian distribution.

use crate::{
    curve::{Curve, LIMB},
    list::numbered,
    numerics::real::Real,
    record::{fourth_moments::STOPPED, octave::Accumulator},
};
use heapless::Vec;

pub use crate::record::fourth_moments::FourthMoments;

impl<const OCTAVES: usize> FourthMoments<OCTAVES> {
    /// Excess kurtosis of every octave of `accumulator`, whose differences these are. An octave is left
    /// out if it has fewer than 30 differences, if all of them are zero, or if its sum has stopped.
    pub(crate) fn kurtosis(&self, accumulator: &Accumulator<OCTAVES>) -> Kurtosis<OCTAVES> {
        let mut points = Vec::new();
        for (k, octave) in numbered(accumulator.octaves()) {
            let fourth = self.read(k, accumulator);
            let squares = octave.sum.to_real();
            if octave.differences < 30 || squares == 0.0 || fourth == STOPPED {
                continue;
            }
            // The sum is taken in units of the mean square, so that it fits in single precision.
            let n = octave.differences as Real;
            let mean_square = squares / n;
            let [low, middle, high] = fourth.map(|limb| limb as Real / mean_square / mean_square);
            let mean = ((high / n) * LIMB + middle / n) * LIMB + low / n;
            // There are as many points as octaves.
            let _ = points.push(KurtosisPoint {
                m: octave.m,
                differences: octave.differences,
                excess: mean - 3.0,
            });
        }
        Kurtosis { points }
    }
}

/// Excess kurtosis of one octave's differences.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct KurtosisPoint {
    /// Averaging factor.
    pub m: u32,
    /// The number of differences behind the excess.
    pub differences: u64,
    /// Kurtosis less 3, `n Σ D⁴ / (Σ D²)² − 3`: zero for Gaussian noise.
    pub excess: Real,
}

impl KurtosisPoint {
    /// Variance of the excess that Gaussian noise shows.
    ///
    /// It is `24 Σ_ℓ ρ_ℓ⁴ / n`, where `ρ_ℓ` is the correlation of differences whose starts are `ℓ`
    /// starts apart. This is the term of order four in the Hermite expansion of the excess (Lomnicki
    /// 1961). Starts advance by a quarter of a cluster, or by half of one at `m = 2`, or by one at
    /// `m = 1`. `Σ ρ⁴` is then 1.49, 1.14 and 1.13 for white noise of the rate, and 3.06, 1.54 and 1.01
    /// for a random walk. Noise whose correlation time exceeds a cluster resembles a random walk. The
    /// larger one of both values is taken.
    pub fn variance(&self) -> Real {
        let correlated = match self.m {
            1 => 1.13,
            2 => 1.54,
            _ => 3.06,
        };
        24.0 * correlated / self.differences as Real
    }
}

/// Excess kurtosis by octave, shortest averaging time first.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
pub struct Kurtosis<const K: usize> {
    /// The octaves whose excess is known.
    pub points: Vec<KurtosisPoint, K>,
}

impl<const K: usize> Kurtosis<K> {
    /// Whether exponentially correlated noise jumps (random telegraph noise) or does not (Gauss–Markov
    /// noise). The noise has `share(k)` of the variance of the curve's octave `k`. `None` where the
    /// data do not decide.
    ///
    /// Telegraph noise would have an excess of `share² · E(τ/T_c)`, where `E` is [`telegraph_excess`].
    /// A regression of the record's excess on that gives 1 for telegraph noise and 0 for Gaussian
    /// noise.
    pub(crate) fn jumps(
        &self,
        curve: &Curve<K>,
        correlation_time_s: Real,
        share: impl Fn(usize) -> Real,
    ) -> Option<bool> {
        let (mut product, mut weight) = (0.0, 0.0);
        for (k, octave) in numbered(curve.points().iter()) {
            let Some(point) = self.points.iter().find(|point| point.m == octave.m) else {
                continue;
            };
            let share = share(k);
            let expected = share * share * telegraph_excess(octave.tau_s / correlation_time_s);
            let variance = point.variance();
            product += expected * point.excess / variance;
            weight += expected * expected / variance;
        }
        if weight < DECISIVE * DECISIVE {
            return None;
        }
        Some(product > 0.5 * weight)
    }
}

/// The number of standard errors that must lie between the two kinds of noise before one of them is
/// named. The decision is made half way, three standard errors from either kind, so that Gaussian
/// errors lead to the wrong kind in at most one of 740 records.
const DECISIVE: Real = 6.0;

/// Excess kurtosis of the differences of random telegraph noise alone, at `x = τ/T_c`. Where jumps are
/// rare, a share `x` of the differences holds a jump, which counts by a triangular function of its
/// place. The formula `1.8/x − 1.6` is accurate to a fifth for `x ≤ 1`. Beyond that, the excess is
/// close to zero. The ratio 1.8 is that of the triangle's moments, `(1/5)/(1/3)²`, and 1.6 is fitted by hand.
pub(crate) fn telegraph_excess(x: Real) -> Real {
    (1.8 / x - 1.6).max(0.0)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    struct Completed([Option<i64>; 4]);

    impl crate::record::octave::Observer for Completed {
        fn observe(&mut self, octave: usize, difference: i64) {
            self.0[octave] = Some(difference);
        }
    }

    #[test]
    fn the_excess_equals_that_computed_from_all_differences() {
        let mut accumulator = Accumulator::<4>::new();
        let mut moments = FourthMoments::<4>::NEW;
        let mut all = [const { std::vec::Vec::new() }; 4];
        let mut random = 1_u32;
        for _ in 0..2005 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let mut completed = Completed([None; 4]);
            accumulator.push_observed((random >> 20) as i32, &mut completed);
            for (octave, difference) in numbered(completed.0) {
                if let Some(difference) = difference {
                    moments.add(octave, difference);
                    all[octave].push(difference);
                }
            }
        }
        for (k, all) in all.iter_mut().enumerate() {
            all.extend(accumulator.pending_difference(k));
        }
        let kurtosis = moments.kurtosis(&accumulator);
        assert_eq!(kurtosis.points.len(), 4);
        for (point, all) in kurtosis.points.iter().zip(&all) {
            let n = all.len() as Real;
            let mean = |power| all.iter().map(|&d| (d as Real).powi(power)).sum::<Real>() / n;
            let expected = mean(4) / mean(2).powi(2) - 3.0;
            assert_eq!(point.differences, all.len() as u64);
            assert!((point.excess - expected).abs() < 1e-4, "{point:?}");
        }
    }
}
