//! Compares the covariance of a gyro with a covariate with a direct computation.

use allanite::{
    Axis, Error, Model, Scale,
    diagnosis::{Addition, Diagnosis, Evidence, Options},
    effect::CATALOGUE,
};
use host_tests::simulate::{Coefficients, Course, Simulator, Thermal};
use proptest::prelude::*;
use rayon::prelude::*;

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

/// The slopes that diagnoses of records of a random walk claim, with their standard errors. The rate follows a
/// temperature with `slope`.
fn claimed(
    coefficients: Coefficients,
    course: Course,
    slope: f64,
    records: u64,
) -> Vec<(f64, f64)> {
    const RATE_HZ: f64 = 20.0;
    const COUNT: f64 = 1e-4;
    const KELVIN: f64 = 1e-3;
    let thermal = Thermal {
        slope,
        kelvin: 10.0,
        course,
    };
    let one = |seed: u64| {
        let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
        let mut gyro = Gyro::new();
        for n in 0..1 << 13 {
            let time_s = f64::from(n) / RATE_HZ;
            let rate = simulator.next().unwrap_or_default() + thermal.rate_at(time_s);
            let celsius = thermal.celsius_at(time_s);
            gyro.push((
                (rate / COUNT).round() as i32,
                [(celsius / KELVIN).round() as i32],
            ));
        }
        let scale = Scale::new(COUNT, RATE_HZ).expect("positive");
        let record = gyro.evidence(0, scale, [KELVIN]).expect("one axis");
        let evidence = Evidence {
            covariates: &record.covariates,
            ..Evidence::NONE
        };
        let (model, options) = (Model::ieee_952(), Options::default());
        let mut diagnosis = Diagnosis::new(record.curve, evidence, &model, &CATALOGUE, options);
        let mut slope = None;
        let report = diagnosis.run(|step| {
            if let Some(Addition::Covariate(followed)) = &step.added {
                slope = Some((followed.slope.value, followed.slope.error));
            }
        });
        report.expect("a curve to diagnose");
        slope
    };
    (0..records).into_par_iter().filter_map(one).collect()
}

/// The coefficients of a gyro whose random walk dominates.
const WALK: Coefficients = Coefficients {
    quantization: 0.0,
    angle_random_walk: 5e-3,
    bias_instability: 0.0,
    rate_random_walk: 3e-3,
    rate_ramp: 0.0,
};

/// The slope of an unrelated temperature exceeds 3.5 standard errors in 0.05 % of records: 1 of 2000.
#[test]
fn a_random_walk_is_not_blamed_on_an_unrelated_warm_up() {
    for time_s in [20.0, 100.0, 400.0, 1e6] {
        let blamed = claimed(WALK, Course::WarmUp { time_s }, 0.0, 2000);
        assert!(blamed.len() <= 5, "{time_s} s: {} of 2000", blamed.len());
    }
}

#[test]
fn a_coupling_that_stands_out_of_a_random_walk_is_found() {
    let slope = 0.05;
    let found = claimed(WALK, Course::WarmUp { time_s: 100.0 }, slope, 100);
    assert!(found.len() >= 98, "{}", found.len());
    let mean = found.iter().map(|one| one.0).sum::<f64>() / found.len() as f64;
    assert!((mean / slope - 1.0).abs() < 0.05, "{mean}");
    let inside = found
        .iter()
        .filter(|(value, error)| (value - slope).abs() < 1.96 * error);
    assert!(inside.count() >= 88, "of {}", found.len());
}
