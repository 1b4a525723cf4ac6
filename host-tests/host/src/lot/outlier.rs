//! Devices that are unlike the others of a lot.

use super::{Measurement, Sample};

/// A modified z-score above which a value is an outlier (Iglewicz & Hoaglin, How to Detect and Handle Outliers, 1993).
const OUTLYING: f64 = 3.5;

/// The factor from the standard deviation of normal values to their median absolute deviation (same source).
const NORMAL: f64 = 0.6745;

/// The least number of devices of which outliers are told. Chosen by hand.
const LEAST: usize = 8;

/// The coefficients beyond which a device is an outlier. Median and median absolute deviation are those of the logarithms;
/// up to half of the devices may be outliers without moving them far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fences {
    /// The lower fence; zero if most of the devices have upper bounds only.
    pub low: f64,
    /// The upper fence.
    pub high: f64,
    /// The median of the coefficients, or of their upper bounds if most of the devices have these only.
    pub median: f64,
    /// Whether most of the devices have upper bounds only.
    pub of_bounds: bool,
}

impl Fences {
    /// The fences of these devices. `None` for fewer than eight, or if more than half of them are the same.
    pub fn of(measurements: &[Measurement]) -> Option<Self> {
        let measured = measurements.iter().filter(|one| one.is_measured);
        // A coefficient that most devices do not show is unusual in one that does: above the bounds of the others.
        let is_seen = 2 * measured.clone().count() >= measurements.len();
        let logarithms = if is_seen {
            Sample::of(measured.map(Measurement::value)).logarithms()
        } else {
            let ends = measurements.iter().map(Measurement::upper);
            Sample::of(ends).logarithms()
        };
        if logarithms.values().len() < LEAST {
            return None;
        }
        let median = logarithms.median()?;
        let distances = logarithms.values().iter().map(|one| (one - median).abs());
        let width = OUTLYING * Sample::of(distances).median()? / NORMAL;
        (width > 0.0).then(|| Self {
            low: if is_seen { (median - width).exp() } else { 0.0 },
            high: (median + width).exp(),
            median: median.exp(),
            of_bounds: !is_seen,
        })
    }

    /// Whether a measurement lies beyond a fence with its whole 95 % interval. A device whose own error is large is not
    /// far from the others.
    pub fn exclude(&self, one: &Measurement) -> bool {
        one.is_measured && (one.lower() > self.high || one.upper() < self.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(value: f64, relative: f64) -> Measurement {
        let square = value * value;
        Measurement {
            square,
            above: relative * square,
            below: relative * square,
            error: relative * square,
            is_measured: true,
            is_observable: true,
        }
    }

    const VALUES: [f64; 10] = [
        0.0047, 0.0051, 0.0049, 0.0055, 0.0050, 0.0046, 0.0053, 0.0048, 0.0052, 0.0058,
    ];

    /// numpy: the median of the logarithms is ln 0.00504975, their median absolute deviation 0.0495454513.
    #[test]
    fn fences_are_three_and_a_half_robust_deviations_away() {
        let fences = Fences::of(&VALUES.map(|value| measured(value, 0.01))).unwrap();
        assert!((fences.median - 0.005_049_752_469).abs() < 1e-11);
        let width = 3.5 * 0.049_545_451_321 / 0.6745;
        for (found, expected) in [(fences.low, -width), (fences.high, width)] {
            assert!(((found / fences.median).ln() - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn half_of_the_devices_do_not_move_the_fences_beyond_the_others() {
        let usual = (0..60).map(|i| 0.005 * (1.0 + 0.001 * f64::from(i)));
        let unusual = (0..40).map(|_| 0.05);
        let all: Vec<Measurement> = usual
            .clone()
            .chain(unusual)
            .map(|value| measured(value, 0.02))
            .collect();
        let fences = Fences::of(&all).unwrap();
        assert!(
            usual
                .clone()
                .all(|value| !fences.exclude(&measured(value, 0.02)))
        );
        assert!(fences.exclude(&measured(0.05, 0.02)));
    }

    #[test]
    fn an_outlier_has_its_whole_interval_beyond_a_fence() {
        let fences = Fences::of(&VALUES.map(|value| measured(value, 0.01))).unwrap();
        assert!(fences.exclude(&measured(0.0070, 0.02)));
        assert!(!fences.exclude(&measured(0.0070, 0.2)));
        assert!(fences.exclude(&measured(0.0030, 0.02)));
    }

    #[test]
    fn a_coefficient_that_the_others_do_not_show_is_an_outlier_above_their_bounds() {
        let bound = |value: f64| Measurement {
            square: 0.0,
            is_measured: false,
            ..measured(value, 0.6)
        };
        let mut all: Vec<Measurement> = VALUES.map(bound).into();
        all.push(measured(0.05, 0.1));
        let fences = Fences::of(&all).unwrap();
        assert!(fences.low == 0.0 && fences.of_bounds);
        assert!(fences.exclude(&all[10]) && !fences.exclude(&all[0]));
        assert!(!fences.exclude(&measured(0.006, 0.1)));
    }

    #[test]
    fn few_or_equal_devices_have_no_outliers() {
        assert_eq!(
            Fences::of(&VALUES.map(|value| measured(value, 0.01))[..7]),
            None
        );
        assert_eq!(Fences::of(&[measured(1.0, 0.01); 20]), None);
    }
}
