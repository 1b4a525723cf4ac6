//! The sums of fourth powers of differences.

use super::octave::Accumulator;

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
pub(crate) const STOPPED: [u64; 3] = [u64::MAX; 3];

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

    /// Adds the fourth powers of differences of an octave with these magnitudes, which are below 2^31.
    #[inline(always)]
    pub(crate) fn add_magnitudes(&mut self, octave: usize, magnitudes: &[u32]) {
        let Some(sum) = self.sums.get_mut(octave) else {
            return;
        };
        for some in magnitudes.chunks(TOGETHER) {
            add_limbs(sum, fourth_powers(some));
        }
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
}

/// The fourth powers of so many numbers below 2^31 add up to less than 2^132.
const TOGETHER: usize = 128;

/// The sum of the fourth powers of at most [`TOGETHER`] numbers below 2^31, lowest limb first.
#[inline(never)]
fn fourth_powers(magnitudes: &[u32]) -> [u64; 3] {
    // A square below 2^62 is the sum of two digits to the base 2^31, whose products a vector holds. Sums of their upper and lower
    // halves stay below 2^40.
    const BITS: u32 = 31;
    const DIGIT: u64 = (1 << BITS) - 1;
    let mut sums = [0_u64; 6];
    for &magnitude in magnitudes {
        let square = u64::from(magnitude).wrapping_mul(magnitude.into());
        let (low, high) = (square & DIGIT, square >> BITS);
        let products = [
            low.wrapping_mul(low),
            low.wrapping_mul(high),
            high.wrapping_mul(high),
        ];
        for (sums, product) in sums.as_chunks_mut::<2>().0.iter_mut().zip(products) {
            sums[0] = sums[0].wrapping_add(product & 0xFFFF_FFFF);
            sums[1] = sums[1].wrapping_add(product >> 32);
        }
    }
    let [low, cross, high] = [[sums[0], sums[1]], [sums[2], sums[3]], [sums[4], sums[5]]]
        .map(|[lower, upper]| u128::from(lower) + (u128::from(upper) << 32));
    // low + 2^32 cross + 2^62 high; the last term has 132 bits.
    let lower = low + (cross << (BITS + 1)) + ((high & ((1 << 62) - 1)) << (2 * BITS));
    let upper = (high >> 62) << 60;
    let total = (lower >> 64) + upper;
    [lower as u64, total as u64, (total >> 64) as u64]
}

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
    fn magnitudes_together_have_the_sum_of_each() {
        let largest = (1 << 31) - 1;
        let mut random = 1_u32;
        for bits in [4, 15, 16, 17, 24, 31] {
            let magnitudes: [u32; 300] = core::array::from_fn(|i| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                if i % 7 == 0 {
                    largest >> (31 - bits)
                } else {
                    random >> (32 - bits)
                }
            });
            let mut singly = FourthMoments::<2>::NEW;
            let mut together = FourthMoments::<2>::NEW;
            for length in [0, 1, 128, 300] {
                let some = &magnitudes[..length];
                some.iter().for_each(|&one| singly.add(1, one.into()));
                together.add_magnitudes(1, some);
                assert_eq!(singly, together, "{bits} {length}");
            }
        }
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
}
