//! The process capability of a lot for an upper limit.

use super::Sample;
use crate::confidence::TWO_SIDED_95;
use statrs::statistics::Statistics as _;

/// Fewer values than these have no capability.
const LEAST: usize = 2;

/// The capability for an upper limit, and its 95 % interval.
///
/// `Cpu = (ln limit − mean)/(3 s)`, where mean and standard deviation s are those of the logarithms (Montgomery,
/// Introduction to Statistical Quality Control, section 8.3: the one-sided ratio, and a transformation where values are not
/// normal). The coefficients of noise are positive and scatter by factors. A normal distribution of the coefficients
/// themselves would have some of them below zero, and too few of them far above.
///
/// The spread includes the errors of the measurements, so that a longer record can raise the capability. The limit has
/// no lower counterpart, so that Cpu is Cpk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capability {
    /// The capability.
    pub value: f64,
    /// Its 95 % interval, `Cpu ± 1.96 √(1/(9n) + Cpu²/(2(n − 1)))` for n devices (Bissell, Applied Statistics 39, 331,
    /// 1990).
    pub interval: [f64; 2],
}

impl Capability {
    /// The capability of these coefficients. `None` for fewer than two, or if all are the same.
    pub fn of(sample: &Sample, limit: f64) -> Option<Self> {
        let logarithms = sample.logarithms();
        let values = logarithms.values();
        let count = values.len() as f64;
        if values.len() < LEAST {
            return None;
        }
        let (mean, deviation) = (values.iter().mean(), values.iter().std_dev());
        if deviation.is_nan() || deviation <= 0.0 {
            return None;
        }
        let value = (limit.ln() - mean) / (3.0 * deviation);
        let error = (1.0 / (9.0 * count) + value * value / (2.0 * (count - 1.0))).sqrt();
        let half = TWO_SIDED_95 * error;
        Some(Self {
            value,
            interval: [value - half, value + half],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VALUES: [f64; 10] = [
        0.0047, 0.0051, 0.0049, 0.0055, 0.0050, 0.0046, 0.0053, 0.0048, 0.0052, 0.0058,
    ];

    /// numpy: mean and `std(ddof=1)` of the logarithms are −5.282843294648 and 0.072187546047.
    #[test]
    fn capability_is_that_of_the_logarithms() {
        let capability = Capability::of(&Sample::of(VALUES.into_iter()), 0.007).unwrap();
        assert!((capability.value - 1.482_241_662_17).abs() < 1e-9);
        let [low, high] = capability.interval;
        assert!((low - 0.767_005_4).abs() < 1e-6 && (high - 2.197_477_9).abs() < 1e-6);
    }

    #[test]
    fn another_unit_changes_nothing() {
        let scaled = Sample::of(VALUES.into_iter().map(|value| 60.0 * value));
        let there = Capability::of(&scaled, 60.0 * 0.007).unwrap().value;
        let here = Capability::of(&Sample::of(VALUES.into_iter()), 0.007).unwrap();
        assert!((there - here.value).abs() < 1e-9);
    }

    #[test]
    fn a_spread_that_is_not_known_has_no_capability() {
        for values in [vec![], vec![2.0], vec![2.0, 2.0], vec![0.0, 2.0]] {
            let sample = Sample::of(values.iter().copied());
            assert_eq!(Capability::of(&sample, 3.0), None, "{values:?}");
        }
    }
}
