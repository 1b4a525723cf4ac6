//! What a gyro shares with a covariate, against direct computation.

use allanite::{Accumulator, CrossSums, Error, Scale};
use proptest::prelude::*;

const OCTAVES: usize = 10;

/// Second differences of windows of `m` samples, a quarter window apart, in one stretch.
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
        let (mut gyro, mut cross) = (Accumulator::<OCTAVES>::new(), CrossSums::<OCTAVES>::new());
        for stretch in &stretches {
            if merged {
                let (mut more, mut more_cross) = (Accumulator::new(), CrossSums::new());
                for &(count, covariate) in stretch {
                    more.push(count);
                    more_cross.push(count, covariate);
                }
                gyro.merge(&more);
                cross.merge(&more_cross);
            } else {
                gyro.gap();
                cross.gap();
                for &(count, covariate) in stretch {
                    gyro.push(count);
                    cross.push(count, covariate);
                }
            }
        }
        let (per_count, kelvin) = (0.01, 1.0 / 256.0);
        let scale = Scale::new(per_count, 100.0).unwrap();
        let curve = cross.curve(&gyro, scale, kelvin).unwrap();
        prop_assert_eq!(curve.points().len(), gyro.curve(scale).points().len());
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
fn sums_of_other_samples_are_refused() {
    let (mut gyro, mut cross) = (Accumulator::<OCTAVES>::new(), CrossSums::<OCTAVES>::new());
    for n in 0..100 {
        gyro.push(n * n % 17);
        cross.push(n * n % 17, n);
    }
    let scale = Scale::new(1.0, 100.0).unwrap();
    assert!(cross.curve(&gyro, scale, 1.0).is_ok());
    assert!(matches!(
        cross.curve(&gyro, scale, 0.0),
        Err(Error::InvalidScale { .. })
    ));
    gyro.push(1);
    assert!(matches!(
        cross.curve(&gyro, scale, 1.0),
        Err(Error::Misaligned {
            gyro: 100,
            covariate: 99
        })
    ));
    cross.reset();
    assert_eq!(cross, CrossSums::new());
}
