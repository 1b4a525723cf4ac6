//! The probability with which an effect of a given size shows.

use crate::{
    chi_squared::chi_squared_tail,
    limits::ADEQUATE_P,
    math,
    real::{Real, consts::FRAC_1_SQRT_2, consts::PI, real},
};

/// The probability with which an effect at its limit shows.
pub(super) const PROBABILITY: Real = 0.95;

/// The number of intervals of Simpson's rule. The integrand is smooth between its ends; eight intervals
/// more change a probability by 3e-3 with two degrees of freedom, and by less with more.
const INTERVALS: u8 = 12;
/// How often an interval that holds the answer is halved. A root of the noncentrality of some 5 is then
/// known to 0.1 %.
const HALVINGS: u8 = 13;

/// What a record must pass before a diagnosis adds an effect: its model is not adequate, and the effect
/// improves it.
///
/// The residuals of a record with an effect have the expectation `δ`, in units in which octaves are
/// independent and have a variance of one, if the weights are right. Along `δ`, their sum is `s + z`,
/// where `s = |δ|` is the root of the noncentrality and `z` is normal with the variance `along`. The other
/// degrees of freedom add `rest` times a χ². With `q = (s + z)²`,
///
/// ```text
/// P = P(q + rest · χ²(n − 1) > χ²_99 %(n)  and  q > gain).
/// ```
///
/// Without the second condition and with variances of one, this is the noncentral χ² distribution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    /// The χ² above which the model is not adequate.
    threshold: Real,
    /// The least fall of the score for which the effect is added.
    gain: Real,
    degrees_of_freedom: usize,
}

/// The variances of the residuals, relative to those that the weights expect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variances {
    /// The variance along the effect's shift.
    pub(super) along: Real,
    /// The mean variance across it.
    pub(super) rest: Real,
}

impl Gate {
    /// `None` without degrees of freedom, because such a model is never judged.
    pub(super) fn new(degrees_of_freedom: usize, gain: Real) -> Option<Self> {
        Some(Self {
            threshold: quantile(degrees_of_freedom)?,
            gain,
            degrees_of_freedom,
        })
    }

    /// The probability to pass with the root `s` of the noncentrality.
    pub(super) fn probability(&self, s: Real, variances: Variances) -> Real {
        let deviation = math::sqrt(variances.along);
        let from = |q: Real| (math::sqrt(q) - s) / deviation;
        let (low, high) = (from(self.gain), from(self.threshold));
        let others = self.degrees_of_freedom.saturating_sub(1);
        if low >= high || others == 0 {
            return normal_tail(low.max(high));
        }
        // Beyond six standard errors, nothing is left of the integrand.
        let low = low.max(-6.0);
        if low >= high {
            return 1.0;
        }
        let step = (high - low) / real(INTERVALS);
        let integrand = |i: u8| {
            let z = low + step * real(i);
            let q = s + deviation * z;
            let missing = (self.threshold - q * q) / variances.rest;
            math::exp(-0.5 * z * z) * chi_squared_tail(missing, others)
        };
        let weight = |i: u8| match i {
            0 | INTERVALS => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let sum: Real = (0..=INTERVALS).map(|i| weight(i) * integrand(i)).sum();
        normal_tail(high) + sum * step / (3.0 * math::sqrt(2.0 * PI))
    }

    /// The root of the noncentrality with which the probability is [`PROBABILITY`].
    pub(super) fn needed(&self, variances: Variances) -> Real {
        // The upper end passes by itself with 98 %, whatever the others add.
        let most = math::sqrt(self.threshold.max(self.gain)) + 2.1 * math::sqrt(variances.along);
        let (mut low, mut high) = (0.0, most);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.probability(middle, variances) < PROBABILITY {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// The probability that a standard normal variable exceeds `x`.
fn normal_tail(x: Real) -> Real {
    0.5 * math::erfc(x * FRAC_1_SQRT_2)
}

/// The χ² above which a model is not adequate. `None` without degrees of freedom.
fn quantile(degrees_of_freedom: usize) -> Option<Real> {
    if degrees_of_freedom == 0 {
        return None;
    }
    // Wilson & Hilferty 1931 give it to some per cent, and it is then halved in.
    let n = real(degrees_of_freedom);
    let spread = 2.0 / (9.0 * n);
    let root = 1.0 - spread + 2.326_348 * math::sqrt(spread);
    let rough = n * root * root * root;
    let (mut low, mut high) = (0.9 * rough, 1.1 * rough);
    for _ in 0..16 {
        let middle = 0.5 * (low + high);
        if chi_squared_tail(middle, degrees_of_freedom) > real(ADEQUATE_P) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_random::Random;

    const ONE: Variances = Variances {
        along: 1.0,
        rest: 1.0,
    };

    #[test]
    fn the_quantiles_are_those_of_the_tables() {
        // Abramowitz & Stegun 1964, table 26.8.
        for (degrees, expected) in [(1, 6.63490), (2, 9.21034), (11, 24.7250), (30, 50.8922)] {
            let found = quantile(degrees).unwrap_or_default();
            assert!((found / expected - 1.0).abs() < 1e-4, "{degrees}: {found}");
        }
        assert_eq!(quantile(0), None);
    }

    /// The noncentral χ² distribution is a mixture of central ones, with Poisson weights (Abramowitz &
    /// Stegun 1964, eq. 26.4.25).
    #[test]
    fn without_a_gain_the_power_is_that_of_the_noncentral_chi_squared_distribution() {
        for degrees in [1, 2, 5, 11, 20] {
            let Some(gate) = Gate::new(degrees, 0.0) else {
                continue;
            };
            let s = gate.needed(ONE);
            let half = 0.5 * s * s;
            let (mut weight, mut power) = (math::exp(-half), 0.0);
            for j in 0..60 {
                power += weight * chi_squared_tail(gate.threshold, degrees + 2 * j);
                weight *= half / real(j + 1);
            }
            // With two degrees of freedom, Simpson's rule meets the root of a χ² with one.
            assert!((power - PROBABILITY).abs() < 4e-3, "{degrees}: {power}");
        }
        // The threshold of one degree of freedom is 2.576, and 1.645 beyond it leave 5 %.
        let s = Gate::new(1, 0.0).map_or(0.0, |gate| gate.needed(ONE));
        assert!((s - 4.2207).abs() < 0.01, "{s}");
    }

    fn square(x: f64) -> f64 {
        x * x
    }

    /// A number that is nearly normal: the sum of twelve uniform ones.
    fn normal(random: &mut Random) -> f64 {
        0.5 * (0..12).map(|_| random.signed()).sum::<f64>()
    }

    #[test]
    fn the_probability_is_the_share_of_draws_that_pass() {
        let mut random = Random::new(77);
        let variances = Variances {
            along: 1.7,
            rest: 0.8,
        };
        for (degrees, gain, s) in [
            (11, 12.0, 5.0),
            (11, 12.0, 4.0),
            (4, 20.0, 5.0),
            (1, 3.0, 3.0),
        ] {
            let Some(gate) = Gate::new(degrees, gain) else {
                continue;
            };
            const DRAWS: u32 = 40_000;
            let mut passed = 0_u32;
            for _ in 0..DRAWS {
                let root = s + math::sqrt(variances.along) * real(normal(&mut random));
                let q = if root > 0.0 { root * root } else { 0.0 };
                let rest: f64 = (1..degrees).map(|_| square(normal(&mut random))).sum();
                if q > gain && q + variances.rest * real(rest) > gate.threshold {
                    passed += 1;
                }
            }
            let share = real(passed) / real(DRAWS);
            let expected = gate.probability(s, variances);
            assert!((share - expected).abs() < 0.008, "{share}, not {expected}");
        }
    }
}
