//! Evidence beyond the curve: whether the differences have a Gaussian distribution.

use crate::{curve::Curve, list::numbered, octave::Accumulator, real::Real};
use heapless::Vec;

/// The sums Σ D⁴ of every octave of an accumulator, over the differences that the accumulator squares.
///
/// An Allan variance does not distinguish Gauss–Markov noise from random telegraph noise. The kurtosis
/// of the differences `D_s = θ_{s+2m} − 2θ_{s+m} + θ_s` does: it is 3 for any Gaussian noise, and more
/// where a rate jumps. The fourth powers are those of the same quarter-overlapping differences whose
/// squares the accumulator sums. So the sums are all that is kept in addition, 24 bytes per octave.
///
/// The sums are integers of 192 bits that stop at their largest value. A difference of 2^48 or more
/// stops the sum of its octave at once. The differences of a 16-bit converter stay below that in any
/// octave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FourthMoments<const OCTAVES: usize> {
    sums: [[u64; 3]; OCTAVES],
}

/// A sum that has stopped.
const STOPPED: [u64; 3] = [u64::MAX; 3];

impl<const OCTAVES: usize> FourthMoments<OCTAVES> {
    /// Sums of no difference yet.
    pub(crate) const NEW: Self = Self {
        sums: [[0; 3]; OCTAVES],
    };

    /// Adds the fourth power of a difference of an octave.
    #[inline(always)]
    pub(crate) fn add(&mut self, octave: usize, difference: i64) {
        let Some(sum) = self.sums.get_mut(octave) else {
            return;
        };
        // A gyro at rest takes this path, with two multiplications and one limb.
        let short = difference as i16;
        if i64::from(short) == difference {
            let square = i32::from(short).wrapping_mul(i32::from(short)) as u32;
            let fourth = u64::from(square) * u64::from(square);
            if let Some(low) = sum[0].checked_add(fourth) {
                sum[0] = low;
                return;
            }
        }
        // On a core of 64 bits, the same is short for differences of 32 bits, which records that were rounded from
        // floats have.
        #[cfg(target_pointer_width = "64")]
        if let Ok(magnitude) = u32::try_from(difference.unsigned_abs()) {
            let square = u128::from(magnitude).wrapping_mul(magnitude.into());
            let lower = u128::from(sum[1]) << 64 | u128::from(sum[0]);
            if let Some(lower) = lower.checked_add(square.wrapping_mul(square)) {
                [sum[0], sum[1]] = [lower as u64, (lower >> 64) as u64];
                return;
            }
        }
        add_large(sum, difference.unsigned_abs());
    }

    /// Adds the sums of another record.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            add_limbs(own, *other);
        }
    }

    /// The sum of octave `k` so far, lowest limb first. It includes the difference that is still
    /// pending in `accumulator`.
    pub(crate) fn read(&self, k: usize, accumulator: &Accumulator<OCTAVES>) -> [u64; 3] {
        let mut sum = self.sums.get(k).copied().unwrap_or([0; 3]);
        if let Some(difference) = accumulator.pending_difference(k) {
            add_large(&mut sum, difference.unsigned_abs());
        }
        sum
    }

    /// The sums, for a snapshot that restores them.
    #[cfg(feature = "storage")]
    pub(crate) fn sums_mut(&mut self) -> &mut [[u64; 3]; OCTAVES] {
        &mut self.sums
    }

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

const LIMB: Real = 18_446_744_073_709_551_616.0; // 2^64

/// Adds the fourth power of a difference of any size.
#[cold]
#[inline(never)]
fn add_large(sum: &mut [u64; 3], magnitude: u64) {
    if magnitude >= 1 << 48 {
        *sum = STOPPED;
        return;
    }
    // The square has 96 bits. It is split, so that its own square needs no more than 128 bits at a
    // time.
    let square = u128::from(magnitude) * u128::from(magnitude);
    let (upper, lower) = ((square >> 64) as u64, square as u64);
    let low = u128::from(lower) * u128::from(lower);
    // 2 · upper · lower is below 2^97, and upper² below 2^64.
    let cross = (u128::from(upper) * u128::from(lower)) << 1;
    let middle = (low >> 64) + (cross & u128::from(u64::MAX));
    let high = (cross >> 64) + u128::from(upper) * u128::from(upper) + (middle >> 64);
    add_limbs(sum, [low as u64, middle as u64, high as u64]);
}

/// Adds 192 bits to 192 bits, and stops at the largest value.
fn add_limbs(sum: &mut [u64; 3], limbs: [u64; 3]) {
    let mut carry = false;
    for (own, limb) in sum.iter_mut().zip(limbs) {
        let (once, first) = own.overflowing_add(limb);
        let (twice, second) = once.overflowing_add(u64::from(carry));
        *own = twice;
        carry = first || second;
    }
    if carry {
        *sum = STOPPED;
    }
}

/// Excess kurtosis of one octave's differences.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

    /// Σ D⁴ in 128 bits, for differences whose sum fits.
    fn direct(differences: &[i64]) -> [u64; 3] {
        let fourth = differences.iter().map(|&difference| {
            let square = u128::from(difference.unsigned_abs()).pow(2);
            square * square
        });
        let sum: u128 = fourth.sum();
        [sum as u64, (sum >> 64) as u64, 0]
    }

    #[test]
    fn sums_of_fourth_powers_are_exact_beyond_64_bits() {
        let differences = [3, -65_535, 65_536, -(1 << 31), 1 << 31, -1, 65_535];
        let mut moments = FourthMoments::<2>::NEW;
        for _ in 0..3 {
            differences.iter().for_each(|&d| moments.add(1, d));
        }
        assert_eq!(moments.sums, [[0; 3], direct(&differences.repeat(3))]);
        let mut merged = moments.clone();
        merged.merge(&moments);
        assert_eq!(merged.sums[1], direct(&differences.repeat(6)));
        // (2^48 − 1)⁴ = 2^192 − 2^146 + 6·2^96 − 2^50 + 1.
        let mut large = FourthMoments::<1>::NEW;
        large.add(0, (1 << 48) - 1);
        let high = u64::MAX - (1 << 18) + 1;
        assert_eq!(
            large.sums[0],
            [u64::MAX - (1 << 50) + 2, (6 << 32) - 1, high]
        );
    }

    #[test]
    fn a_sum_that_would_overflow_stops_and_stays_stopped() {
        let mut moments = FourthMoments::<2>::NEW;
        moments.add(0, 1 << 48);
        assert_eq!(moments.sums[0], STOPPED);
        moments.add(0, 1);
        moments.merge(&FourthMoments::NEW);
        assert_eq!(moments.sums[0], STOPPED);
        let largest = (1 << 48) - 1;
        moments.add(1, largest);
        moments.add(1, largest);
        assert_eq!(moments.sums[1], STOPPED);
    }

    struct Completed([Option<i64>; 4]);

    impl crate::octave::Observer for Completed {
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
