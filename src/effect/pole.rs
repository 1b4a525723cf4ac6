//! The kernel of one complex pole, which Gauss–Markov noise, resonances and low-passed noise share.

use super::SecondDifferences;
use crate::{lattice, math};
use nalgebra::Complex;

/// Decays of a cluster beyond this leave nothing of what lies past it.
const GONE: f64 = 200.0;

const ONE: Complex<f64> = Complex::new(1.0, 0.0);

/// A rate whose autocovariance is `Re zⁿ` at a lag of `n` samples.
///
/// ```text
/// G(n) = −½ τ₀² Re[ n (1+z)/(1−z) − 2z (1−zⁿ)/(1−z)² ]
/// ```
///
/// All functions leave the factor τ₀² to the caller.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pole {
    /// Decay a sample, τ₀/T.
    decay: f64,
    /// Cycles a sample, fτ₀.
    cycles: f64,
    /// Re (1+z)/(1−z): the variance that a long mean has, times its samples.
    long: f64,
    /// z/(1−z)².
    factor: Complex<f64>,
}

impl Pole {
    /// A pole of time constant `time_s` and frequency `frequency_hz`.
    pub(super) fn new(time_s: f64, frequency_hz: f64, interval_s: f64) -> Self {
        let decay = interval_s / time_s;
        let cycles = frequency_hz * interval_s;
        let z = power(decay, cycles, 1.0);
        // 1 − z without cancellation where the pole is slow.
        let (sine, _) = math::sincos_of_turns(0.5 * cycles);
        let rest = Complex::new(
            -math::expm1(-decay) + 2.0 * math::exp(-decay) * sine * sine,
            -z.im,
        );
        Self {
            decay,
            cycles,
            long: ((z + 1.0) / rest).re,
            factor: z / (rest * rest),
        }
    }

    /// `G(n)/τ₀²`.
    pub(super) fn kernel(&self, n: f64) -> f64 {
        let power = power(self.decay, self.cycles, n);
        -0.5 * n * self.long + (self.factor * (ONE - power)).re
    }

    /// `[G(x + m) − 2 G(x) + G(|x − m|)]/τ₀²`.
    pub(super) fn second_difference(&self, x: f64, m: f64) -> f64 {
        let power = |n: f64| power(self.decay, self.cycles, n);
        if x < m {
            let powers = power(m + x) - power(x) * 2.0 + power(m - x);
            -self.long * (m - x) - (self.factor * powers).re
        } else {
            let rest = ONE - power(m);
            -(self.factor * power(x - m) * rest * rest).re
        }
    }

    /// `σ²(mτ₀)` for a power `W = z^m`: `[m·long − Re factor (1−W)(3−W)]/m²`.
    fn variance_of(&self, m: f64, w: Complex<f64>) -> f64 {
        let slow = self.decay * m < 1e-4 && self.cycles == 0.0;
        if slow {
            // The terms cancel to the first order: to that order the rate is a walk of
            // K² = 2/T, in samples σ² = 2 decay (2m² + 1)/6m · (1 − decay · m · 3/4).
            return self.decay * (2.0 * m * m + 1.0) / (3.0 * m) * (1.0 - 0.75 * self.decay * m);
        }
        let product = self.factor * (ONE - w) * (Complex::new(3.0, 0.0) - w);
        (m * self.long - product.re) / (m * m)
    }

    /// Allan variance.
    pub(super) fn variance(&self, m: f64) -> f64 {
        self.variance_of(m, power(self.decay, self.cycles, m))
    }

    /// Allan variances at ascending averaging factors: powers by squaring from octave to octave.
    pub(super) fn variances(&self, factors: impl Iterator<Item = f64>, mut each: impl FnMut(f64)) {
        let mut last: Option<(f64, Complex<f64>)> = None;
        for m in factors {
            let w = match last {
                Some((before, w)) if m == 2.0 * before => w * w,
                _ => power(self.decay, self.cycles, m),
            };
            last = Some((m, w));
            each(self.variance_of(m, w));
        }
    }

    /// Adds `weight` times the second differences for clusters of `m` samples: powers by
    /// multiplication along the lattice.
    pub(super) fn add_second_differences(&self, m: f64, weight: f64, sum: &mut SecondDifferences) {
        let quarter = power(self.decay, self.cycles, 0.25 * m);
        let mut powers = lattice::Powers::new(quarter);
        let cluster = powers.near(4);
        let gone = self.decay * m > GONE;
        let beyond = if gone {
            Complex::new(0.0, 0.0)
        } else {
            // z^(x−m) (1−z^m)² = z^x (z^−m − 2 + z^m).
            ONE / cluster - 2.0 + cluster
        };
        sum.add_slots(|slot| {
            let (own, position) = (powers.next(slot), lattice::position(slot));
            let value = if position < 4 {
                let (after, before) = (slot.saturating_add(4), slot.abs_diff(4));
                let near = powers.near(after) - own * 2.0 + powers.near(before);
                -self.long * m * (1.0 - 0.25 * f64::from(position)) - (self.factor * near).re
            } else if gone && position == 4 {
                -self.factor.re
            } else {
                -(self.factor * own * beyond).re
            };
            weight * value
        });
    }
}

/// `e^((−decay + 2πi cycles) n)`.
fn power(decay: f64, cycles: f64, n: f64) -> Complex<f64> {
    let size = math::exp(-decay * n);
    if cycles == 0.0 {
        return Complex::new(size, 0.0);
    }
    let (sine, cosine) = math::sincos_of_turns(cycles * n);
    Complex::new(size * cosine, size * sine)
}
