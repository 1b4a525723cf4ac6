//! Values of one quantity in a lot.

use crate::quantile::quantile;

/// Values in ascending order.
#[derive(Clone, Debug)]
pub struct Sample(Vec<f64>);

impl Sample {
    /// The finite ones of these values.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    /// The logarithms of the positive values.
    pub fn logarithms(&self) -> Self {
        let positive = self.0.iter().filter(|value| **value > 0.0);
        Self(positive.map(|value| value.ln()).collect())
    }

    /// The values in ascending order.
    pub fn values(&self) -> &[f64] {
        &self.0
    }

    /// The value below which this share lies, from 0 to 1; `None` without values.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        (!self.0.is_empty()).then(|| quantile(&self.0, share))
    }

    /// The median; `None` without values.
    pub fn median(&self) -> Option<f64> {
        self.quantile(0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `numpy.percentile` of these ten values gives the same.
    #[test]
    fn percentiles_are_those_of_numpy() {
        let values = [
            0.0047, 0.0051, 0.0049, 0.0055, 0.0050, 0.0046, 0.0053, 0.0048, 0.0052, 0.0058,
        ];
        let sample = Sample::of(values.into_iter().chain([f64::NAN, f64::INFINITY]));
        assert_eq!(sample.values().len(), 10);
        for (share, expected) in [(0.05, 0.004_645), (0.5, 0.005_05), (0.95, 0.005_665)] {
            let found = sample.quantile(share).unwrap();
            assert!((found - expected).abs() < 1e-12, "{share}: {found}");
        }
        assert_eq!(Sample::of([].into_iter()).median(), None);
    }
}
