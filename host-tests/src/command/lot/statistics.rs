//! Statistics of a lot.

use crate::quantile::quantile;
use statrs::{
    distribution::{ContinuousCDF as _, Normal},
    statistics::Statistics as _,
};

/// A modified z-score above which a value is an outlier (Iglewicz & Hoaglin, How to Detect and Handle Outliers, 1993).
const OUTLYING: f64 = 3.5;

/// The factor from the median absolute deviation of normal values to their standard deviation.
const NORMAL: f64 = 1.4826;

/// The least number of values of which outliers are told.
const LEAST: usize = 8;

/// Values of a lot, in ascending order.
pub(super) struct Values(Vec<f64>);

impl Values {
    /// The finite ones of these values.
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The value below which this share lies; `None` without values.
    pub(super) fn percentile(&self, percent: f64) -> Option<f64> {
        (!self.0.is_empty()).then(|| quantile(&self.0, percent / 100.0))
    }

    /// The process capability for an upper limit, (limit − mean)/(3 standard deviations), as ISO 22514-2 defines it.
    /// `None` for fewer than two values, or if all are the same.
    pub(super) fn capability(&self, limit: f64) -> Option<f64> {
        let deviation = self.0.iter().std_dev();
        let is_known = self.0.len() >= 2 && deviation > 0.0;
        is_known.then(|| (limit - self.0.iter().mean()) / (3.0 * deviation))
    }

    /// The values beyond which one is an outlier: in logarithms, which of coefficients are nearly normal. `None` for
    /// too few values, or if more than half of them are the same.
    pub(super) fn fences(&self) -> Option<(f64, f64)> {
        let logarithms: Vec<f64> = self
            .0
            .iter()
            .filter(|value| **value > 0.0)
            .map(|value| value.ln())
            .collect();
        if logarithms.len() < LEAST {
            return None;
        }
        let median = quantile(&logarithms, 0.5);
        let mut distances: Vec<f64> = logarithms.iter().map(|one| (one - median).abs()).collect();
        distances.sort_by(f64::total_cmp);
        let width = OUTLYING * NORMAL * quantile(&distances, 0.5);
        (width > 0.0).then(|| ((median - width).exp(), (median + width).exp()))
    }
}

/// The number of standard errors that one of `comparisons` differences of equal values exceeds with a probability of 1 %
/// (Bonferroni).
pub(super) fn significant(comparisons: usize) -> f64 {
    let share = 0.01 / (2.0 * comparisons.max(1) as f64);
    Normal::standard().inverse_cdf(1.0 - share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_known_values() {
        let values = Values::of([4.0, 1.0, f64::NAN, 3.0, 2.0, 5.0].into_iter());
        assert_eq!((values.len(), values.percentile(50.0)), (5, Some(3.0)));
        // The standard deviation is √2.5.
        let capability = values.capability(6.0).unwrap();
        assert!((capability - 3.0 / (3.0 * 2.5_f64.sqrt())).abs() < 1e-12);
        assert!(values.fences().is_none());
        assert!(Values::of([2.0].into_iter()).capability(3.0).is_none());
    }

    #[test]
    fn outliers_lie_beyond_the_fences_and_others_do_not() {
        let usual = (0..100).map(|i| 0.005 * (1.0 + 0.001 * f64::from(i)));
        let values = Values::of(usual.clone().chain([0.01]));
        let (low, high) = values.fences().unwrap();
        assert!(usual.clone().all(|value| low < value && value < high));
        assert!(high < 0.01);
    }

    #[test]
    fn more_comparisons_need_a_larger_difference() {
        assert!((significant(1) - 2.5758).abs() < 1e-3);
        assert!(significant(1000) > 4.0 && significant(1000) < 5.0);
    }
}
