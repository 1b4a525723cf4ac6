//! Comparison of mean squares, and the median of a neighbourhood.

use crate::numerics::{
    math,
    real::{Real, real},
};

/// The standard normal variable that has the same probability as the ratio `f` of two mean squares under the same
/// variance, where the numerator has `a` and the denominator has `b` degrees of freedom: the approximation of the F
/// distribution by Paulson, Annals of Mathematical Statistics 13, 233, 1942.
pub(super) fn standardised_ratio(f: Real, a: Real, b: Real) -> Real {
    if !(f > 0.0 && a > 0.0 && b > 0.0) {
        return 0.0;
    }
    let root = math::exp(math::log(f) / 3.0);
    let (above, below) = (2.0 / (9.0 * a), 2.0 / (9.0 * b));
    let mean = (1.0 - below) * root - (1.0 - above);
    mean / math::sqrt(below * root * root + above)
}

/// The median of some values, or the upper one of the two in the middle; 0 of none. It takes a time that grows with
/// the square of their number.
pub(super) fn median<I: Iterator<Item = Real> + Clone>(values: I) -> Real {
    let count = |values: I| values.fold(0_u32, |n, _| n.saturating_add(1));
    let half = count(values.clone()) / 2;
    let is_middle = |&value: &Real| {
        let others = values.clone();
        let (below, same) = others.fold((0_u32, 0_u32), |(below, same), other| {
            (
                below.saturating_add(u32::from(other < value)),
                same.saturating_add(u32::from(other == value)),
            )
        });
        below <= half && half < below.saturating_add(same)
    };
    values.clone().find(is_middle).unwrap_or(0.0)
}

/// The standard deviation of a normal variable of mean 0, from the median of its size.
pub(super) fn deviation_of_median(median: Real) -> Real {
    // The third quartile of the normal distribution (Abramowitz & Stegun 1964, table 26.5).
    median / real(0.674_49)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_have_the_probabilities_of_the_f_distribution() {
        // Upper quantiles of F at 0.1 % and 99.9 %: those of χ²/a for b without end, and their reciprocals for a without end
        // (Abramowitz & Stegun 1964, tables 26.8 and 26.9).
        let normal = real(3.090_232);
        let endless = 1e9;
        for (f, a, b, expected) in [
            (59.703 / 30.0, 30.0, endless, normal),
            (11.588 / 30.0, 30.0, endless, -normal),
            (30.0 / 11.588, endless, 30.0, normal),
            (30.0 / 59.703, endless, 30.0, -normal),
            (3.217, 30.0, 30.0, normal),
        ] {
            let found = standardised_ratio(real(f), real(a), real(b));
            assert!((found - expected).abs() < 0.02, "{f} {a} {b}: {found}");
        }
    }
}
