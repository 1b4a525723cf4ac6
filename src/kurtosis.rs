//! Evidence beyond the curve: are the differences Gaussian?

use crate::curve::Curve;
use crate::list::numbered;
use crate::real::Real;
use heapless::Vec;

/// Fourth moments of the differences, octave by octave, beside an
/// [`Accumulator`](crate::Accumulator) that takes the same counts.
///
/// An Allan variance does not know Gauss–Markov noise from random telegraph noise. The kurtosis of
/// the differences `D_s = θ_{s+2m} − 2θ_{s+m} + θ_s` does: 3 for any Gaussian noise, more where a rate
/// jumps. Starts advance by a whole cluster, which is enough for a moment that few events decide.
///
/// Integers only. Every sample touches octave 0 and at most one other, as in the accumulator: sample
/// `n` completes a cluster of the octaves up to its trailing zeros, and all but the first of them
/// wait for a sample of their own. `56 · OCTAVES + 16` bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FourthMoments<const OCTAVES: usize> {
    position: u64,
    angle: u64,
    octaves: [Octave; OCTAVES],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Octave {
    /// Angles at the last two boundaries, the newest at the parity of its number.
    boundaries: [u64; 2],
    differences: u64,
    squares: u128,
    fourth: u128,
}

impl Octave {
    const EMPTY: Self = Self {
        boundaries: [0; 2],
        differences: 0,
        squares: 0,
        fourth: 0,
    };

    /// The boundary of number `block`.
    fn push(&mut self, block: u64, angle: u64) {
        let [even, odd] = self.boundaries;
        let (oldest, middle) = if block & 1 == 0 {
            (even, odd)
        } else {
            (odd, even)
        };
        self.boundaries[(block & 1) as usize] = angle;
        if block < 2 {
            return;
        }
        let difference = angle
            .wrapping_sub(middle)
            .wrapping_sub(middle.wrapping_sub(oldest)) as i64;
        // Differences beyond 2^31 saturate, and so do the sums: no gyro of 16 bits has them at rest.
        let magnitude = difference.unsigned_abs().min(1 << 31);
        let square = u128::from(magnitude * magnitude);
        self.differences = self.differences.saturating_add(1);
        self.squares = self.squares.saturating_add(square);
        self.fourth = self.fourth.saturating_add(square * square);
    }
}

impl<const OCTAVES: usize> FourthMoments<OCTAVES> {
    /// Nothing yet.
    pub const fn new() -> Self {
        const {
            assert!(OCTAVES >= 1 && OCTAVES <= 30, "1 to 30 octaves");
        }
        Self {
            position: 0,
            angle: 0,
            octaves: [Octave::EMPTY; OCTAVES],
        }
    }

    /// Adds one count.
    pub fn push(&mut self, count: i32) {
        self.angle = self.angle.wrapping_add_signed(i64::from(count));
        self.position = self.position.wrapping_add(1);
        let n = self.position;
        self.octaves[0].push(n, self.angle);
        // Octave k ≥ 1 takes the boundary at n − 2^(k−1) from the octave below, which has it as its
        // last but one or its last.
        let k = n.trailing_zeros() as usize + 1;
        if k < OCTAVES {
            let block = n >> k;
            // At octave k − 1 the boundary has twice the number, which is even.
            let boundary = self.octaves[k - 1].boundaries[0];
            self.octaves[k].push(block, boundary);
        }
    }

    /// Adds counts, one by one.
    pub fn push_slice(&mut self, counts: &[i32]) {
        for &count in counts {
            self.push(count);
        }
    }

    /// Samples were lost: no difference spans this moment.
    pub fn gap(&mut self) {
        self.position = 0;
        self.angle = 0;
        for octave in &mut self.octaves {
            octave.boundaries = [0; 2];
        }
    }

    /// Adds another record of the same sensor.
    pub fn merge(&mut self, other: &Self) {
        self.gap();
        for (own, more) in self.octaves.iter_mut().zip(&other.octaves) {
            own.differences = own.differences.saturating_add(more.differences);
            own.squares = own.squares.saturating_add(more.squares);
            own.fourth = own.fourth.saturating_add(more.fourth);
        }
    }

    /// Excess kurtosis of every octave with at least 30 differences that are not all zero, and whose
    /// fourth powers fit into 128 bits: give it counts no finer than a hundredth of the noise.
    pub fn kurtosis(&self) -> Kurtosis<OCTAVES> {
        let mut points = Vec::new();
        for (k, octave) in numbered(self.octaves.iter()) {
            let saturated = octave.fourth == u128::MAX;
            if octave.differences < 30 || octave.squares == 0 || saturated {
                continue;
            }
            let n = octave.differences as Real;
            let (squares, fourth) = (octave.squares as Real, octave.fourth as Real);
            // As many points as octaves.
            let _ = points.push(KurtosisPoint {
                m: 1_u32.wrapping_shl(k as u32),
                differences: octave.differences,
                excess: (fourth / squares) * (n / squares) - 3.0,
            });
        }
        Kurtosis { points }
    }
}

impl<const OCTAVES: usize> Default for FourthMoments<OCTAVES> {
    fn default() -> Self {
        Self::new()
    }
}

/// Excess kurtosis of one octave's differences.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct KurtosisPoint {
    /// Averaging factor.
    pub m: u32,
    /// Differences behind it.
    pub differences: u64,
    /// Kurtosis less 3: zero for Gaussian noise.
    pub excess: Real,
}

/// Excess kurtosis by octave, shortest averaging time first.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Kurtosis<const K: usize> {
    /// The octaves that have one.
    pub points: Vec<KurtosisPoint, K>,
}

impl<const K: usize> Kurtosis<K> {
    /// Whether exponentially correlated noise that has `share(k)` of the variance of the curve's octave
    /// `k` jumps (random telegraph noise) or not (Gauss–Markov noise); `None` where that cannot be
    /// said.
    ///
    /// Telegraph noise that jumps would have an excess of `share² · E(τ/T_c)`: the record's excess is
    /// regressed on that, which gives 1 for telegraph and 0 for Gaussian noise.
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
            // Variance of the excess of Gaussian differences, half of each shared with the next.
            let variance = 27.0 / point.differences as Real;
            product += expected * point.excess / variance;
            weight += expected * expected / variance;
        }
        if weight < DECISIVE * DECISIVE {
            return None;
        }
        Some(product > 0.5 * weight)
    }
}

/// Standard errors that lie between the two before one is named.
const DECISIVE: Real = 6.0;

/// Excess kurtosis of the differences of random telegraph noise alone, at `x = τ/T_c`: where jumps
/// are rare, a share `x` of the differences holds one, and its size is triangular in its place.
/// `1.8/x − 1.6` to a fifth for `x ≤ 1`; zero is close beyond.
pub(crate) fn telegraph_excess(x: Real) -> Real {
    (1.8 / x - 1.6).max(0.0)
}
