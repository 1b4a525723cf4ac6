//! Compares the covariance of a gyro with a covariate with a direct computation.

use allanite::{Axis, Error, Scale};
use proptest::prelude::*;

const OCTAVES: usize = 10;

/// A gyro with one covariate and no other parts.
type Gyro = Axis<OCTAVES, 1, (), ()>;

/// The second differences of windows of `m` samples that start a quarter window apart, within one
/// stretch.
fn differences(counts: &[i32], m: usize) -> Vec<i128> {
    let sum = |part: &[i32]| part.iter().map(|&count| i128::from(count)).sum::<i128>();
    let starts = (0..).step_by((m / 4).max(1));
    let both = starts.map_while(|start| counts.get(start..start + 2 * m));
    both.map(|both| sum(&both[m..]) - sum(&both[..m])).collect()
}

fn record() -> impl Strategy<Value = Vec<(i32, i32)>> {
    let pair = (-1_000_000_000..1_000_000_000, -40_000..40_000);
    proptest::collection::vec(pair, 60..900)
}

proptest! {
    #[test]
    fn covariances_are_those_of_a_direct_computation(
        stretches in proptest::collection::vec(record(), 1..4),
        merged in any::<bool>(),
    ) {
        let mut gyro = Gyro::new();
        for stretch in &stretches {
            let mut more = Gyro::new();
            let record = if merged { &mut more } else { &mut gyro };
            record.gap();
            for &(count, covariate) in stretch {
                record.push((count, [covariate]));
            }
            gyro.merge(&more);
        }
        let (per_count, kelvin) = (0.01, 1.0 / 256.0);
        let scale = Scale::new(per_count, 100.0).unwrap();
        let record = gyro.evidence(0, scale, [kelvin]).unwrap();
        let [curve] = &record.covariates[..] else { panic!("one covariate") };
        prop_assert_eq!(curve.points().len(), record.curve.points().len());
        for point in curve.points() {
            let (mut product, mut square, mut number) = (0_i128, 0_i128, 0_u32);
            for stretch in &stretches {
                let (counts, covariates): (Vec<i32>, Vec<i32>) = stretch.iter().copied().unzip();
                let m = point.m as usize;
                let pairs = differences(&counts, m).into_iter().zip(differences(&covariates, m));
                for (own, other) in pairs {
                    product += own * other;
                    square += other * other;
                    number += 1;
                }
            }
            let unit = 0.5 / (f64::from(number) * f64::from(point.m).powi(2));
            let covariance = unit * product as f64 * per_count * kelvin;
            let variance = unit * square as f64 * kelvin * kelvin;
            prop_assert!((point.variance - variance).abs() <= 1e-12 * variance);
            prop_assert!((point.covariance - covariance).abs() <= 1e-12 * covariance.abs());
        }
    }
}

#[test]
fn impossible_units_and_axes_are_refused() {
    let mut gyro = Gyro::new();
    for n in 0..100 {
        gyro.push((n * n % 17, [n]));
    }
    let scale = Scale::new(1.0, 100.0).unwrap();
    let units = [0.0, -1.0, f64::NAN, f64::INFINITY];
    for unit in units {
        let refused = gyro.evidence(0, scale, [unit]).unwrap_err();
        assert!(matches!(refused, Error::InvalidScale { .. }), "{unit}");
    }
    let refused = gyro.evidence(1, scale, [1.0]).unwrap_err();
    assert_eq!(refused, Error::UnknownAxis { axis: 1, axes: 1 });
}
