//! The kernel of one complex pole, which Gauss–Markov noise, resonances and low-passed noise share.

use super::{Decay, SecondDifferences, Tail};
use crate::{
    numerics::{
        math,
        real::{Real, by_precision, consts::PI, real},
    },
    theory::lattice,
};
use nalgebra::Complex;

/// The decay exponent of a cluster above which nothing remains of the pole beyond the cluster, and the
/// reciprocal of what remains approaches the end of the floating-point range. The exponentials are then
/// 1e-87 and 4e-18, and their squares still lie within the range.
const GONE: Real = by_precision(200.0, 40.0);

/// The magnitude of an exponent below which Taylor's series gives the remainders of the exponential. Above
/// it, cancellation leaves twelve digits in double precision, or six in single precision.
const SMALL: Real = by_precision(0.1, 1.0);

/// The magnitude of an exponent from which the remainder of the exponential is taken from one. Through the square of
/// the exponent it would lose eight of sixteen digits, or three of seven in single precision.
const LARGE: Real = by_precision(1e4, 1e2);

/// The magnitude of a sample's exponent below which κ is computed by its series. Above it, cancellation
/// leaves as many digits as above [`SMALL`].
const SLOW: Real = by_precision(0.01, 0.3);

/// The factors `1/11` to `1/4` of Taylor's series. The next power is below 1e-17 of the first in double
/// precision, or 1e-8 in single precision.
const RECIPROCALS: [Real; 8] = {
    let mut reciprocals = [0.0; 8];
    let mut i = 0;
    while i < 8 {
        reciprocals[i] = 1.0 / (11 - i) as Real;
        i += 1;
    }
    reciprocals
};

const ONE: Complex<Real> = Complex::new(1.0, 0.0);

/// A rate whose autocovariance at a lag of `n` samples is `Re w zⁿ`, with `z = e^(−s)` and a complex weight `w`.
///
/// ```text
/// G(n) = −½ τ₀² Re w[ n (1+z)/(1−z) − 2z (1−zⁿ)/(1−z)² ] = τ₀² Re w[ κ n − (e^(−sn) − 1 + sn) z/(1−z)² ],
/// κ = s z/(1−z)² − ½ (1+z)/(1−z)
/// ```
///
/// The second form does not cancel if the pole is slow. All functions leave the factor τ₀² to the caller.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pole {
    /// The decay per sample, τ₀/T.
    decay: Real,
    /// The cycles per sample, fτ₀.
    cycles: Real,
    /// The exponent `s`, for the alias of the frequency below half the sample rate.
    exponent: Complex<Real>,
    /// Re w κ.
    slope: Real,
    /// Re w (1+z)/(1−z).
    long: Real,
    /// w z/(1−z)².
    factor: Complex<Real>,
}

impl Pole {
    /// A pole with time constant `time_s` and frequency `frequency_hz`, whose weight is one.
    pub(super) fn new(time_s: Real, frequency_hz: Real, interval_s: Real) -> Self {
        Self::weighted(ONE, time_s, frequency_hz, interval_s)
    }

    /// A pole with this weight.
    pub(super) fn weighted(
        weight: Complex<Real>,
        time_s: Real,
        frequency_hz: Real,
        interval_s: Real,
    ) -> Self {
        Self::at(weight, interval_s / time_s, frequency_hz * interval_s)
    }

    /// A pole with this weight, this decay per sample and these cycles per sample.
    pub(super) fn at(weight: Complex<Real>, decay: Real, cycles: Real) -> Self {
        let s = Complex::new(decay, 2.0 * PI * (math::floor(cycles + 0.5) - cycles));
        let z = power(decay, cycles, 1.0);
        let sample = Exponential {
            exponent: s,
            power: z,
        };
        let rest = sample.rest();
        let (factor, long) = (z / (rest * rest), (z + 1.0) / rest);
        let slope = if s.norm_sqr() < SLOW * SLOW {
            // This is the series of κ, whose next term is s⁵/5040.
            -s * (ONE - s * s / 30.0) / 6.0
        } else {
            s * factor - long * 0.5
        };
        Self {
            decay,
            cycles,
            exponent: s,
            slope: (weight * slope).re,
            long: (weight * long).re,
            factor: weight * factor,
        }
    }

    /// The variance of the mean of many samples, times the number of samples.
    pub(super) fn long_mean(&self) -> Real {
        self.long
    }

    /// The decay per sample.
    pub(super) fn decay(&self) -> Real {
        self.decay
    }

    /// Whether the pole is real and positive, so that its autocovariance only falls.
    pub(super) fn is_plain(&self) -> bool {
        self.cycles == 0.0
    }

    /// `w z/(1−z)²`, which multiplies the powers of `z` in the kernel.
    pub(super) fn factor(&self) -> Complex<Real> {
        self.factor
    }

    /// The power `z^n` with its exponent.
    fn power(&self, n: Real) -> Exponential {
        self.known(n, power(self.decay, self.cycles, n))
    }

    fn known(&self, n: Real, power: Complex<Real>) -> Exponential {
        Exponential {
            exponent: self.exponent * n,
            power,
        }
    }

    /// `G(n)/τ₀²`.
    pub(super) fn kernel(&self, n: Real) -> Real {
        self.kernel_of(n, &self.power(n))
    }

    fn kernel_of(&self, n: Real, power: &Exponential) -> Real {
        self.slope * n - (self.factor * power.second_rest()).re
    }

    /// `[G(x + m) − 2 G(x) + G(|x − m|)]/τ₀²`.
    pub(super) fn second_difference(&self, x: Real, m: Real) -> Real {
        if x < m {
            self.kernel(m + x) - 2.0 * self.kernel(x) + self.kernel(m - x)
        } else {
            let rest = self.power(m).rest();
            -(self.factor * self.power(x - m).power * rest * rest).re
        }
    }

    /// The second differences from `m` on, divided by τ₀².
    pub(super) fn tail(&self, m: Real) -> Tail {
        Tail {
            start: m,
            decays: [Some(self.decay_from(m)), None],
        }
    }

    /// The part that the pole has in the second differences from `m` on, divided by τ₀².
    pub(super) fn decay_from(&self, m: Real) -> Decay {
        let rest = self.power(m).rest();
        let at_m = -(self.factor * rest * rest);
        Decay {
            decay: self.decay,
            phase: -self.exponent.im,
            cosine: at_m.re,
            sine: at_m.im,
        }
    }

    /// `σ²(mτ₀)` for a power `W = z^m`: `[m·long − Re factor (1−W)(3−W)]/m²`.
    fn variance_of(&self, m: Real, w: Complex<Real>) -> Real {
        let power = self.known(m, w);
        if !power.is_small() {
            let product = self.factor * (ONE - w) * (Complex::new(3.0, 0.0) - w);
            return (m * self.long - product.re) / (m * m);
        }
        // This form does not cancel. With φ = W − 1 + v it is Re factor [4 φ − (W² − 1 + 2v)] − 2 κ m, where
        // the brackets equal 2vφ − φ² − 2 (v²/2 − φ).
        let (v, third) = (power.exponent, power.third_rest());
        let second = v * v * 0.5 - third;
        let product = self.factor * (v * second * 2.0 - second * second - third * 2.0);
        product.re / (m * m) - 2.0 * self.slope / m
    }

    /// The Allan variance `σ²(mτ₀)`.
    pub(super) fn variance(&self, m: Real) -> Real {
        self.variance_of(m, self.power(m).power)
    }

    /// The Allan variances at ascending averaging factors. The power is squared from octave to octave.
    pub(super) fn variances(
        &self,
        factors: impl Iterator<Item = Real>,
        mut each: impl FnMut(Real),
    ) {
        let mut last: Option<(Real, Complex<Real>)> = None;
        for m in factors {
            let w = match last {
                Some((before, w)) if m == 2.0 * before => w * w,
                _ => power(self.decay, self.cycles, m),
            };
            last = Some((m, w));
            each(self.variance_of(m, w));
        }
    }

    /// Writes `scale` times the semivariogram of the means of blocks of `m` samples.
    pub(super) fn variogram(&self, m: Real, scale: Real, values: &mut [Real]) {
        values.fill(0.0);
        self.add_variogram(m, scale, values);
    }

    /// Adds `scale` times the semivariogram of the means of blocks of `m` samples.
    ///
    /// It is `γ(l) = σ²(m) + Re factor (1−W)² (1 − W^(l−1))/m²` with `W = z^m`, in which nothing cancels.
    pub(super) fn add_variogram(&self, m: Real, scale: Real, values: &mut [Real]) {
        let block = self.power(m);
        let rest = block.rest();
        let first = scale * self.variance_of(m, block.power);
        let unit = self.factor * rest * rest * (scale / (m * m));
        // This is 1 − W^(l−1).
        let mut gone = Complex::new(0.0, 0.0);
        for value in values {
            *value += first + (unit * gone).re;
            gone = rest + block.power * gone;
        }
    }

    /// Adds `weight` times the second differences for clusters of `m` samples. The powers follow from one
    /// another by multiplication along the lattice.
    pub(super) fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        sum: &mut SecondDifferences,
    ) {
        let quarter = power(self.decay, self.cycles, 0.25 * m);
        let mut powers = lattice::Powers::new(quarter);
        let cluster = self.known(m, powers.near(4));
        let gone = self.decay * m > GONE;
        let beyond = if gone {
            Complex::new(0.0, 0.0)
        } else {
            // z^(x−m) (1−z^m)² = z^x (1−z^m)²/z^m.
            let rest = cluster.rest();
            self.factor * rest * rest / cluster.power
        };
        let kernel = |powers: &lattice::Powers, position: u32| {
            let n = 0.25 * m * real(position);
            self.kernel_of(n, &self.known(n, powers.near(position as usize)))
        };
        sum.add_slots(|slot| {
            let (own, position) = (powers.next(slot), lattice::position(slot));
            let value = if position < 4 {
                kernel(&powers, position.saturating_add(4)) - 2.0 * kernel(&powers, position)
                    + kernel(&powers, position.abs_diff(4))
            } else if gone && position == 4 {
                -self.factor.re
            } else {
                -(beyond * own).re
            };
            weight * value
        });
    }
}

/// The exponential `e^(−v)`.
struct Exponential {
    /// `v`.
    exponent: Complex<Real>,
    power: Complex<Real>,
}

impl Exponential {
    fn is_small(&self) -> bool {
        self.exponent.norm_sqr() < SMALL * SMALL
    }

    /// `1 − v + v²/2 − e^(−v)`, without cancellation if `v` is small.
    fn third_rest(&self) -> Complex<Real> {
        let v = self.exponent;
        if !self.is_small() {
            return ONE - v + v * v * 0.5 - self.power;
        }
        // v³/3! − v⁴/4! + …
        let mut sum = ONE;
        for reciprocal in RECIPROCALS {
            sum = ONE - v * sum * reciprocal;
        }
        v * v * v * sum / 6.0
    }

    /// `e^(−v) − 1 + v`.
    fn second_rest(&self) -> Complex<Real> {
        self.exponent * self.exponent * 0.5 - self.third_rest()
    }

    /// `1 − e^(−v)`.
    fn rest(&self) -> Complex<Real> {
        if self.exponent.norm_sqr() > LARGE * LARGE {
            return ONE - self.power;
        }
        self.exponent - self.second_rest()
    }
}

/// `1 − e^(−v)`, without cancellation if `v` is small.
pub(super) fn rest(v: Complex<Real>) -> Complex<Real> {
    let power = power(v.re, -v.im / (2.0 * PI), 1.0);
    Exponential { exponent: v, power }.rest()
}

/// `e^((−decay + 2πi cycles) n)`.
pub(super) fn power(decay: Real, cycles: Real, n: Real) -> Complex<Real> {
    let size = math::exp(-decay * n);
    if cycles == 0.0 {
        return Complex::new(size, 0.0);
    }
    let (sine, cosine) = math::sincos_of_turns(cycles * n);
    Complex::new(size * cosine, size * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_far_faster_than_a_sample_is_white() {
        for time_s in [1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15] {
            let pole = Pole::new(time_s, 0.0, 1.0);
            for m in [1.0, 4.0, 1024.0] {
                let variance = pole.variance(m) * m;
                assert!((variance - 1.0).abs() < 1e-5, "{time_s} {m}: {variance}");
            }
        }
    }

    /// Far from the origin, the second difference is `z^(x−m) (1−z^m)² z/(1−z)²`, without its sign, where `z^m` is gone.
    #[test]
    fn second_differences_of_long_clusters_do_not_cancel() {
        let pole = Pole::new(1.0, 0.0, 0.01);
        for m in [16_384.0, 131_072.0, 1_048_576.0] {
            let found = pole.second_difference(m, m);
            let expected = -pole.factor.re;
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{m}: {found} {expected}"
            );
        }
    }
}
