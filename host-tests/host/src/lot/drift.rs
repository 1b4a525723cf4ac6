//! Differences between two measurements of one device.

use super::{Measurement, quantile_above};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor, Normal};

/// The probability that a lot without any drift names one.
const FALSE_DRIFT: f64 = 0.01;

/// Probabilities below this one are not told apart. Its normal quantile is 37.
const LEAST: f64 = 1e-300;

/// The tests that a comparison makes.
const TESTS: f64 = 2.0;

/// The difference of two measurements of one coefficient, in standard errors with its sign, by the test that is the more
/// significant of two. [`threshold`] charges for both. `longer` is how many times as long the later record is.
///
/// The first test is the difference of the squares against the combined standard error. It suits a coefficient that others
/// hide, whose error does not grow with it. The second one is the ratio of the squares, which is that of F if each is
/// a variance with the equivalent degrees of freedom `2 (square/error)²` (NIST SP 1065, 2008, section 5.4). It suits a
/// coefficient that dominates its octaves. There the error grows with the coefficient, so that the first test never
/// exceeds the reciprocal of the relative error, however much the coefficient has grown.
///
/// Where one of them is an upper bound, the bound stands for its square in the ratio. Its degrees of freedom are those of
/// the other measurement, in proportion to the lengths of the records, or those of its own error beside the geometric mean
/// of both squares if these are fewer.
pub fn difference(before: &Measurement, now: &Measurement, longer: f64) -> f64 {
    let error = before.error.hypot(now.error);
    let difference = now.square - before.square;
    if error.is_nan() || error <= 0.0 {
        return 0.0;
    }
    let of_squares = difference / error;
    let of_ratio = if difference >= 0.0 {
        growth(before, now, 1.0 / longer)
    } else {
        growth(now, before, longer).map(|z| -z)
    };
    let of_ratio = of_ratio.unwrap_or(0.0);
    if of_ratio.abs() > of_squares.abs() {
        of_ratio
    } else {
        of_squares
    }
}

/// The significance of a ratio by the F distribution, as the normal variable that is as improbable. `None` if the larger
/// square is not measured, or not beyond the smaller one's bound. `length` is that of the record of the smaller square, in
/// lengths of the other.
fn growth(smaller: &Measurement, larger: &Measurement, length: f64) -> Option<f64> {
    let freedom = |square: f64, error: f64| 2.0 * (square / error).powi(2);
    if !larger.is_measured {
        return None;
    }
    let of_larger = freedom(larger.square, larger.error);
    let (square, of_smaller) = if smaller.is_measured {
        (smaller.square, freedom(smaller.square, smaller.error))
    } else {
        let bound = smaller.upper().powi(2);
        let between = (bound * larger.square).sqrt();
        let own = freedom(between, smaller.error);
        (bound, own.min(length * of_larger))
    };
    let distribution = FisherSnedecor::new(of_larger, of_smaller).ok()?;
    let beyond = distribution.sf(larger.square / square);
    (beyond < 0.5).then(|| quantile_above(beyond.max(LEAST)))
}

/// The number of standard errors from which on a difference is a drift, where so many differences are looked at. A lot
/// without drift names one with a probability of 1 % at most (Šidák, Journal of the American Statistical Association 62,
/// 626, 1967).
pub fn threshold(comparisons: usize) -> f64 {
    let tests = TESTS * comparisons.max(1) as f64;
    // 1 − (1 − P)^(1/n), with the digits of a small number.
    let each = -((-FALSE_DRIFT).ln_1p() / tests).exp_m1();
    -Normal::standard().inverse_cdf(0.5 * each)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(square: f64, relative: f64) -> Measurement {
        Measurement {
            square,
            above: relative * square,
            below: relative * square,
            error: relative * square,
            is_measured: true,
            is_observable: true,
        }
    }

    /// By scipy: `norm.isf(f.sf(100, 22.2, 22.2))` is 8.41, where the difference is 3.30 standard errors.
    #[test]
    fn a_coefficient_that_grew_tenfold_has_drifted_although_its_error_grew_with_it() {
        let [before, now] = [measured(1.0, 0.3), measured(100.0, 0.3)];
        let found = difference(&before, &now, 1.0);
        assert!((found - 8.412_666_066).abs() < 1e-6, "{found}");
        assert!((difference(&now, &before, 1.0) + found).abs() < 1e-9);
    }

    /// By scipy: 4.847511 of the ratio, and 4.472136 of the difference.
    #[test]
    fn the_more_significant_test_counts() {
        let found = difference(&measured(1.0, 0.1), &measured(2.0, 0.1), 1.0);
        assert!((found - 4.847_511_460).abs() < 1e-6, "{found}");
        // A hidden coefficient's error does not depend on it: 10/√2 of the difference.
        let [before, now] = [measured(2.0, 0.5), measured(12.0, 1.0 / 12.0)];
        let found = difference(&before, &now, 1.0);
        assert!((found - 10.0 / 2.0_f64.sqrt()).abs() < 1e-9, "{found}");
    }

    fn bound(square: f64, error: f64) -> Measurement {
        Measurement {
            square,
            above: error,
            below: error,
            error,
            is_measured: false,
            is_observable: false,
        }
    }

    #[test]
    fn a_hidden_coefficient_is_compared_with_a_bound_by_the_difference() {
        // Both have the same error of 1. The ratio is less significant.
        let found = difference(&bound(0.0, 1.0), &measured(8.0, 0.125), 1.0);
        assert!((found - 8.0 / 2.0_f64.sqrt()).abs() < 1e-9, "{found}");
        let certain = Measurement {
            error: 0.0,
            ..bound(0.0, 1.0)
        };
        assert_eq!(difference(&certain, &certain, 1.0), 0.0);
    }

    /// By scipy: `norm.isf(f.sf(20/1.644854, n, n))` for n of 20 and of 10 degrees of freedom.
    #[test]
    fn a_coefficient_that_grew_out_of_its_bound_is_compared_by_the_ratio() {
        let now = measured(20.0, 0.1_f64.sqrt());
        let found = difference(&bound(0.0, 1.0), &now, 1.0);
        assert!((found - 4.983_606_805_7).abs() < 1e-5, "{found}");
        // The bound is from a record of half the length.
        let shorter = difference(&bound(0.0, 1.0), &now, 2.0);
        assert!((shorter - 3.628_453_252_7).abs() < 1e-5, "{shorter}");
        let back = difference(&now, &bound(0.0, 1.0), 1.0);
        assert!((back + found).abs() < 1e-9, "{back}");
    }

    /// By scipy: `norm.isf((1 - 0.99**(1/n))/2)` for n tests.
    #[test]
    fn more_comparisons_need_a_larger_difference() {
        for (comparisons, expected) in [(1, 2.806_225_315), (500, 4.416_088_708)] {
            let found = threshold(comparisons);
            assert!((found - expected).abs() < 1e-6, "{comparisons}: {found}");
        }
        assert!(threshold(1_000_000) > threshold(1000));
    }

    #[test]
    fn differences_beyond_all_tables_are_finite() {
        let found = difference(&measured(1.0, 1e-3), &measured(1e9, 1e-3), 1.0);
        assert!(found > 30.0 && found.is_finite(), "{found}");
    }
}
