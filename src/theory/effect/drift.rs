//! The kernel of a pole whose frequency ran evenly over a range.

use super::{
    SampledShape, SecondDifferences, Tail,
    pole::{Pole, power},
    stationary::Process,
};
use crate::numerics::real::{Real, by_precision, consts::PI, real};
use nalgebra::Complex;

/// The number of frequencies at which the slow factor is taken.
const NODES: usize = 4;

/// The places of the Gauss–Legendre quadrature on −1…1 and their weights, which add up to one (Abramowitz & Stegun 1964,
/// table 25.4).
const PLACES: [Real; NODES] = [
    by_precision(-0.861_136_311_594_052_6, -0.861_136_3),
    by_precision(-0.339_981_043_584_856_3, -0.339_981_05),
    by_precision(0.339_981_043_584_856_3, 0.339_981_05),
    by_precision(0.861_136_311_594_052_6, 0.861_136_3),
];
const WEIGHTS: [Real; NODES] = [
    by_precision(0.173_927_422_568_726_93, 0.173_927_42),
    by_precision(0.326_072_577_431_273_07, 0.326_072_57),
    by_precision(0.326_072_577_431_273_07, 0.326_072_57),
    by_precision(0.173_927_422_568_726_93, 0.173_927_42),
];

/// The widest range relative to the middle frequency. Over a wider one, the factor `1/sin²(πfτ₀)` is no polynomial of
/// third degree: here it is wrong by 0.5 % at the ends of the range.
pub(super) const WIDEST: Real = 0.5;

/// The change of the phase within a block below which block means fall short of the rate by the same at all frequencies of
/// the range, to 0.4 % of what the drift takes. The averages of kernels would cancel there: single precision keeps six
/// digits above.
const SLOW: Real = by_precision(1e-4, 0.3);

/// The least decay of the pole that stands for the tail, per sample.
const LEAST_DECAY: Real = 1e-6;

/// A pole whose frequency ran evenly over a range while its decay stayed. Its rate has the autocovariance
/// `Re zⁿ sinc κ` with the pole `z` of the middle frequency, `κ = π drift τ₀ n` and `sinc κ = sin κ/κ`.
///
/// The kernel is the average of [`Pole`]'s over the frequencies. Its powers `zⁿ` change fast with the frequency, and
/// their factor `F = z/(1−z)²` slowly: expanded in Legendre polynomials, `F = Σ a_l P_l(u)` for the place `u` in the
/// range, from −1 to 1. Because the average of `P_l(u) e^(iκu)` is `i^l j_l(κ)`, with the spherical Bessel functions `j_l`
/// (Abramowitz & Stegun 1964, eq. 10.1.14),
///
/// ```text
/// G(n) = τ₀² Re [ a_0 − zⁿ Σ i^l a_l j_l(κ) ] − ½ τ₀² n ⟨(1+z)/(1−z)⟩
/// ```
///
/// The functions of the pole itself are for a mean square of one and leave the factor τ₀² out.
pub(super) struct DriftingPole {
    /// The mean square of the rate, which is the factor of all functions of the process.
    power: Real,
    /// The decay per sample, and the cycles per sample in the middle of the range.
    decay: Real,
    cycles: Real,
    /// The width of the range, in cycles per sample.
    drift: Real,
    /// The pole without a drift.
    middle: Pole,
    /// The average of `(1+z)/(1−z)`.
    long: Real,
    /// The coefficients `i^l a_l`.
    coefficients: [Complex<Real>; NODES],
}

impl DriftingPole {
    /// A pole with this mean square and this decay per sample, whose frequency ran over a range around these cycles per
    /// sample.
    pub(super) fn new(power: Real, decay: Real, cycles: Real, drift: Real) -> Self {
        let drift = drift.min(WIDEST * cycles);
        let one = Complex::new(1.0, 0.0);
        let mut long = 0.0;
        let mut coefficients = [Complex::new(0.0, 0.0); NODES];
        for (place, weight) in PLACES.into_iter().zip(WEIGHTS) {
            let pole = Pole::at(one, decay, cycles + 0.5 * drift * place);
            long += weight * pole.long_mean();
            let factor = pole.factor() * weight;
            // The Legendre polynomials of degree 0 to 3, times 2l + 1.
            let square = place * place;
            let polynomials = [
                1.0,
                3.0 * place,
                2.5 * (3.0 * square - 1.0),
                3.5 * place * (5.0 * square - 3.0),
            ];
            for (coefficient, polynomial) in coefficients.iter_mut().zip(polynomials) {
                *coefficient += factor * polynomial;
            }
        }
        let [zero, first, second, third] = coefficients;
        let quarter = Complex::new(0.0, 1.0);
        Self {
            power,
            decay,
            cycles,
            drift,
            middle: Pole::at(one, decay, cycles),
            long,
            coefficients: [zero, first * quarter, -second, -third * quarter],
        }
    }

    /// τ₀² times the mean square.
    fn square(&self, shape: &SampledShape) -> Real {
        self.power * shape.interval_s * shape.interval_s
    }

    /// The change of the phase, or the decay, within a block of `m` samples.
    fn is_slow(&self, m: Real) -> bool {
        (self.decay + 2.0 * PI * self.cycles) * m < SLOW
    }

    /// `κ` for `n` samples, in turns.
    fn turns(&self, n: Real) -> Real {
        0.5 * self.drift * n
    }

    /// The average of `F zⁿ`, from the powers `zⁿ` and `e^(iκ)`.
    fn mean(&self, n: Real, power: Complex<Real>, turned: Complex<Real>) -> Complex<Real> {
        let mut sum = Complex::new(0.0, 0.0);
        let functions = bessel(2.0 * PI * self.turns(n), turned);
        for (coefficient, function) in self.coefficients.iter().zip(functions) {
            sum += coefficient * function;
        }
        power * sum
    }

    /// The average of `F zⁿ`.
    fn mean_at(&self, n: Real) -> Complex<Real> {
        let turned = power(0.0, self.turns(n), 1.0);
        self.mean(n, power(self.decay, self.cycles, n), turned)
    }

    /// The share of the autocovariance at a lag of `n` samples that the drift takes: `1 − sinc κ`.
    fn lost(&self, n: Real) -> Real {
        let turned = power(0.0, self.turns(n), 1.0);
        lost(2.0 * PI * self.turns(n), turned)
    }

    /// `G(n)/τ₀²`.
    fn kernel(&self, n: Real) -> Real {
        if self.is_slow(n) {
            return self.middle.kernel(n);
        }
        let [zero, ..] = self.coefficients;
        (zero - self.mean_at(n)).re - 0.5 * self.long * n
    }

    /// `[G(x + m) − 2 G(x) + G(|x − m|)]/τ₀²`.
    fn second_difference(&self, x: Real, m: Real) -> Real {
        if self.is_slow(m) {
            return self.middle.second_difference(x, m) * (1.0 - self.lost(x));
        }
        if x < m {
            return self.kernel(m + x) - 2.0 * self.kernel(x) + self.kernel(m - x);
        }
        // The part of the kernel that is proportional to n is gone.
        let sum = self.mean_at(x + m) - self.mean_at(x) * 2.0 + self.mean_at(x - m);
        -sum.re
    }

    /// The Allan variance `σ²(mτ₀)`.
    fn variance(&self, m: Real) -> Real {
        if self.is_slow(m) {
            let at_m = self.middle.second_difference(m, m);
            return self.middle.variance(m) - at_m * self.lost(m) / (m * m);
        }
        (self.second_difference(m, m) - self.second_difference(0.0, m)) / (m * m)
    }

    /// Writes `scale` times the semivariogram of the means of blocks of `m` samples.
    fn variogram(&self, m: Real, scale: Real, values: &mut [Real]) {
        let block = power(self.decay, self.cycles, m);
        let turn = power(0.0, self.turns(m), 1.0);
        let (mut own, mut turned) = (block, turn);
        if self.is_slow(m) {
            self.middle.variogram(m, scale, values);
            // Without a drift, the autocovariance of the means is Re F (1−W)² W^(l−1)/m² with W = z^m.
            let at_m = self.middle.decay_from(m);
            let mut covariance = Complex::new(at_m.cosine, at_m.sine) * (-scale / (m * m));
            let mut n = m;
            for value in values {
                *value += covariance.re * lost(2.0 * PI * self.turns(n), turned);
                covariance *= block;
                turned *= turn;
                n += m;
            }
            return;
        }
        let at_zero = 2.0 * self.kernel(m);
        let [mut before, ..] = self.coefficients;
        let mut here = self.mean(m, own, turned);
        let scale = scale / (m * m);
        let mut n = m;
        for value in values {
            n += m;
            own *= block;
            turned *= turn;
            let next = self.mean(n, own, turned);
            let difference = (here * 2.0 - before - next).re;
            *value = scale * (difference - at_zero);
            (before, here) = (here, next);
        }
    }

    /// The tail of a pole that keeps its frequency and forgets its phase as fast: the squares of its autocovariance have
    /// the same sum, `∫ sinc²(π drift t) dt = 1/(2 drift)` on one side.
    fn tail(&self, m: Real) -> Tail {
        let decay = (self.decay + self.drift).max(LEAST_DECAY);
        Pole::at(Complex::new(1.0, 0.0), decay, self.cycles).tail(m)
    }
}

impl Process for DriftingPole {
    fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
        self.square(shape) * self.kernel(lag)
    }

    fn second_difference(&self, x: Real, m: Real, shape: &SampledShape) -> Real {
        self.square(shape) * self.second_difference(x, m)
    }

    fn variance(&self, m: Real, _: &SampledShape) -> Real {
        self.power * self.variance(m)
    }

    fn add_second_differences(
        &self,
        m: Real,
        weight: Real,
        shape: &SampledShape,
        sum: &mut SecondDifferences,
    ) {
        let weight = weight * self.square(shape);
        sum.add(m, |x| weight * self.second_difference(x, m));
    }

    fn tail(&self, m: Real, shape: &SampledShape) -> Option<Tail> {
        Some(self.tail(m).scaled(self.square(shape)))
    }

    fn variogram(&self, m: Real, _: &SampledShape, values: &mut [Real]) {
        self.variogram(m, self.power, values);
    }
}

/// The argument below which power series give the spherical Bessel functions. Above it, the recursion upwards loses
/// at most a digit of the largest function.
const SMALL: Real = 1.0;

/// The number of terms of the series beyond the first. The next one is below 1e-17, or below 1e-9 in single precision.
const TERMS: u8 = if cfg!(feature = "double") { 9 } else { 5 };

/// The spherical Bessel functions `j_0` to `j_3` of an argument `κ ≥ 0` whose `e^(iκ)` is given (Abramowitz & Stegun
/// 1964, eqs. 10.1.2, 10.1.11 and 10.1.19).
fn bessel(kappa: Real, turned: Complex<Real>) -> [Real; NODES] {
    if kappa < SMALL {
        let mut functions = [0.0; NODES];
        // This is κ^l/(2l+1)!!.
        let mut first = 1.0;
        let mut odd = 1.0;
        for function in &mut functions {
            *function = first * series(kappa, odd, 1);
            odd += 2.0;
            first *= kappa / odd;
        }
        return functions;
    }
    let per_kappa = 1.0 / kappa;
    let zero = turned.im * per_kappa;
    let first = (zero - turned.re) * per_kappa;
    let second = 3.0 * first * per_kappa - zero;
    let third = 5.0 * second * per_kappa - first;
    [zero, first, second, third]
}

/// `1 − j_0(κ)`, without cancellation if `κ` is small.
fn lost(kappa: Real, turned: Complex<Real>) -> Real {
    if kappa < SMALL {
        return kappa * kappa / 6.0 * series(kappa, 1.0, 2);
    }
    1.0 - turned.im / kappa
}

/// The nested sum `1 − x/(k(o+2k)) (1 − x/((k+1)(o+2k+2)) (1 − …))` with `x = κ²/2`, an odd number `o` and the first
/// `k`.
fn series(kappa: Real, odd: Real, first: u8) -> Real {
    let half_square = 0.5 * kappa * kappa;
    let mut sum = 1.0;
    for k in (first..=TERMS).rev() {
        let k = real(k);
        sum = 1.0 - half_square * sum / (k * (odd + 2.0 * k));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::double;

    /// The average of `P_l(u) e^(iκu)` over −1…1, by its real or its imaginary part.
    fn average(l: usize, kappa: f64) -> f64 {
        const STEPS: i32 = 2000;
        let mut sum = 0.0;
        for i in 0..STEPS {
            let u = (f64::from(i) + 0.5) / f64::from(STEPS) * 2.0 - 1.0;
            let polynomial = [1.0, u, 1.5 * u * u - 0.5, 2.5 * u * u * u - 1.5 * u][l];
            // The factors i^0 to i^3 make the function of even degree real, and the other ones imaginary.
            let wave = [
                libm::cos(kappa * u),
                libm::sin(kappa * u),
                -libm::cos(kappa * u),
                -libm::sin(kappa * u),
            ][l];
            sum += polynomial * wave;
        }
        sum / f64::from(STEPS)
    }

    #[test]
    fn spherical_bessel_functions_are_averages_of_legendre_polynomials() {
        for kappa in [0.0, 1e-3, 0.1, 0.7, 0.999, 1.001, 1.7, 4.0, 30.0] {
            let turned = Complex::new(real(libm::cos(kappa)), real(libm::sin(kappa)));
            let found = bessel(real(kappa), turned);
            for (l, found) in found.into_iter().enumerate() {
                let expected = average(l, kappa);
                assert!(
                    (double(found) - expected).abs() < 3e-5,
                    "j_{l}({kappa}): {found}, not {expected}"
                );
            }
            let lost = double(lost(real(kappa), turned));
            let expected = 1.0 - average(0, kappa);
            assert!((lost - expected).abs() < 3e-5 * expected.max(1e-3));
        }
    }
}
