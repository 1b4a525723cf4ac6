//! Compares the covariance of a gyro with a covariate with a direct computation.

use allanite::{
    Axis, Error, Model, Record, Scale,
    covariate::{Pair, Slope},
    diagnosis::{Addition, FollowedCovariate, Options, Verdict},
    effect::CATALOGUE,
    spectrum::{Spectrum, SpectrumAccumulator},
};
use allanite_host::{
    diagnosis::diagnose,
    simulate::{Coefficients, Course, Simulator, Thermal},
};
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
        let record = gyro.record_so_far(0, (scale, [kelvin])).unwrap();
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
        let refused = gyro.record_so_far(0, (scale, [unit])).unwrap_err();
        assert!(matches!(refused, Error::InvalidScale { .. }), "{unit}");
    }
    let refused = gyro.record_so_far(1, (scale, [1.0])).unwrap_err();
    assert_eq!(refused, Error::UnknownAxis { axis: 1, axes: 1 });
}

/// The sampling rate of the records, and the sizes of a count of the gyro and of the temperature.
const RATE_HZ: f64 = 20.0;
const COUNT: f64 = 1e-4;
const KELVIN: f64 = 1e-3;

/// What a diagnosis tries.
#[derive(Clone, Copy)]
enum Tried {
    Temperature,
    /// The temperature, its rate of change, and both together.
    Both,
}

/// The covariates that diagnoses of records claim. The rate follows a temperature with the slope of `thermal`, and its
/// rate of change with `rate_slope`.
fn claimed(
    coefficients: Coefficients,
    thermal: Thermal,
    rate_slope: f64,
    tried: Tried,
    records: u64,
) -> Vec<FollowedCovariate> {
    let one = |seed: u64| {
        let mut simulator = Simulator::new(coefficients, RATE_HZ, seed);
        let mut gyro = Axis::<OCTAVES, 2, (), ()>::new();
        let mut temperature = Gyro::new();
        let counts = |n: i32| (thermal.celsius_at(f64::from(n) / RATE_HZ) / KELVIN).round() as i32;
        let mut before = counts(0);
        for n in 0..1 << 13 {
            let time_s = f64::from(n) / RATE_HZ;
            let celsius = |n: f64| thermal.celsius_at((n / RATE_HZ).max(0.0));
            let change = (celsius(f64::from(n)) - celsius(f64::from(n) - 1.0)) * RATE_HZ;
            let rate = simulator.next().unwrap_or_default() + thermal.rate_at(time_s);
            let count = ((rate + rate_slope * change) / COUNT).round() as i32;
            let celsius = counts(n);
            gyro.push((count, [celsius, celsius - before]));
            temperature.push((celsius, [celsius - before]));
            before = celsius;
        }
        let scale = Scale::new(COUNT, RATE_HZ).expect("positive");
        let units = [KELVIN, KELVIN * RATE_HZ];
        let record = gyro.record_so_far(0, (scale, units)).expect("one axis");
        let own = Scale::new(KELVIN, RATE_HZ).expect("positive");
        let shared = temperature
            .record_so_far(0, (own, [units[1]]))
            .expect("one axis");
        let pair = Pair {
            covariates: [0, 1],
            shared: shared.covariates[0].clone(),
        };
        let (number, pairs) = match tried {
            Tried::Temperature => (1, &[][..]),
            Tried::Both => (2, std::slice::from_ref(&pair)),
        };
        let (model, options) = (Model::ieee_952(), Options::default());
        let record = Record {
            covariates: &record.covariates[..number],
            pairs,
            ..(&record.curve).into()
        };
        let mut found = None;
        let report = diagnose(record, &model, &CATALOGUE, options, |step| {
            if let Some(Addition::Covariate(followed)) = step.added {
                found = Some(followed);
            }
        });
        report.expect("a curve to diagnose");
        found
    };
    (0..records).into_par_iter().filter_map(one).collect()
}

/// A temperature that changes by 10 K, which the rate follows with `slope`.
const fn thermal(slope: f64, course: Course) -> Thermal {
    Thermal {
        slope,
        kelvin: 10.0,
        course,
    }
}

/// The coefficients of a gyro whose random walk dominates.
const WALK: Coefficients = Coefficients {
    quantization: 0.0,
    angle_random_walk: 5e-3,
    bias_instability: 0.0,
    rate_random_walk: 3e-3,
    rate_ramp: 0.0,
};

#[test]
fn a_coupling_that_stands_out_of_a_random_walk_is_found() {
    let slope = 0.05;
    let course = Course::WarmUp { time_s: 100.0 };
    let found = claimed(WALK, thermal(slope, course), 0.0, Tried::Temperature, 100);
    assert!(found.len() >= 98, "{}", found.len());
    let found: Vec<Slope> = found.iter().map(|one| one.slope).collect();
    assert_slopes(&found, slope);
}

/// Asserts that slopes are right on average, and inside their intervals as often as they should be.
fn assert_slopes(found: &[Slope], slope: f64) {
    let number = found.len() as f64;
    let mean = found.iter().map(|one| one.value).sum::<f64>() / number;
    let inside = found
        .iter()
        .filter(|one| (one.value - slope).abs() < 1.96 * one.error)
        .count();
    println!("slope {slope}: mean {mean}, {inside} of {number} inside");
    assert!((mean / slope - 1.0).abs() < 0.05, "{mean}");
    assert!(inside as f64 >= 0.88 * number, "{inside} of {number}");
}

/// The coefficients of a gyro with white and flicker noise.
const FLICKER: Coefficients = Coefficients {
    quantization: 0.0,
    angle_random_walk: 5e-3,
    bias_instability: 4e-3,
    rate_random_walk: 0.0,
    rate_ramp: 0.0,
};

/// Temperatures whose changes are not proportional to themselves. Those of an exponential are, so that no record could
/// tell which of the two acts.
const CYCLE: Course = Course::Cycle { period_s: 150.0 };

#[test]
fn a_temperature_and_its_rate_that_act_together_are_both_named_with_their_slopes() {
    for (coefficients, slope, rate_slope) in [(FLICKER, 0.01, 0.25), (WALK, 0.03, -0.6)] {
        let found = claimed(
            coefficients,
            thermal(slope, CYCLE),
            rate_slope,
            Tried::Both,
            200,
        );
        assert!(found.len() >= 198, "{}", found.len());
        let both = |one: &FollowedCovariate| one.beside.map(|beside| (one.slope, beside.slope));
        let (slopes, rates): (Vec<_>, Vec<_>) = found.iter().filter_map(both).unzip();
        println!("both named in {} of 200", slopes.len());
        assert!(slopes.len() >= 190, "both in {}", slopes.len());
        assert_slopes(&slopes, slope);
        assert_slopes(&rates, rate_slope);
    }
}

#[test]
fn one_of_a_temperature_and_its_rate_that_acts_alone_is_named_alone() {
    for coefficients in [FLICKER, WALK] {
        for (slope, rate_slope, place) in [(0.03, 0.0, 0), (0.0, 0.6, 1)] {
            let found = claimed(
                coefficients,
                thermal(slope, CYCLE),
                rate_slope,
                Tried::Both,
                500,
            );
            let alone = found
                .iter()
                .filter(|one| one.index == place && one.beside.is_none());
            let slopes: Vec<Slope> = alone.map(|one| one.slope).collect();
            println!(
                "{place} alone in {} of {} of 500",
                slopes.len(),
                found.len()
            );
            assert!(slopes.len() >= 495, "{place}: {} of 500", slopes.len());
            assert_slopes(&slopes, slope + rate_slope);
        }
    }
}

/// A temperature is slow, so that it reaches the lowest bins of the spectrum only. The levels that it reaches are left
/// out. What is left is as well explained as a record without a temperature.
#[test]
fn a_spectrum_is_explained_when_what_follows_a_strong_temperature_is_subtracted() {
    const SAMPLES: i32 = 1 << 15;
    let cases = [
        (Course::WarmUp { time_s: 60.0 }, 0.05),
        (Course::Cycle { period_s: 300.0 }, 0.03),
        (Course::Cycle { period_s: 300.0 }, 0.3),
        (Course::Cycle { period_s: 20.0 }, 0.03),
    ];
    for (course, slope) in cases {
        let thermal = thermal(slope, course);
        let one = |seed: u64| {
            let mut simulator = Simulator::new(FLICKER, RATE_HZ, seed);
            let mut gyro = Axis::<16, 1, (), ()>::new();
            let mut spectrum = SpectrumAccumulator::<64, 7>::new();
            for n in 0..SAMPLES {
                let time_s = f64::from(n) / RATE_HZ;
                let rate = simulator.next().unwrap_or_default() + thermal.rate_at(time_s);
                let count = (rate / COUNT).round() as i32;
                let celsius = (thermal.celsius_at(time_s) / KELVIN).round() as i32;
                gyro.push((count, [celsius]));
                spectrum.push_slice(&[count]);
            }
            let scale = Scale::new(COUNT, RATE_HZ).expect("positive");
            let evidence = gyro.record_so_far(0, (scale, [KELVIN])).expect("one axis");
            let (model, options) = (Model::ieee_952(), Options::default());
            let bins: Spectrum<140> = spectrum.spectrum(scale);
            let all = bins.bins().len();
            let record = Record {
                covariates: &evidence.covariates,
                ..Record::new(&evidence.curve, &bins)
            };
            let mut last = None;
            let verdict = diagnose(record, &model, &CATALOGUE, options, |step| {
                last = Some(step.clone());
            });
            let last = last.expect("a step");
            let followed = last.covariate.is_some();
            let alone = last.model.terms().len() == model.terms().len();
            let left = last.comparison.bins.len();
            (
                verdict.expect("a curve to diagnose"),
                followed && alone,
                last.fit.p_value,
                (left, all),
            )
        };
        let found: Vec<_> = (0..60_u64).into_par_iter().map(one).collect();
        let right = found
            .iter()
            .filter(|one| one.0 == Verdict::Improved && one.1)
            .count();
        let low = found.iter().filter(|one| one.2 < 0.1).count();
        println!(
            "{course:?}: {right} of 60 right, p < 0.1 in {low}; bins {:?}",
            found[0].3
        );
        assert!(right >= 57, "{course:?}: {right} of 60");
        assert!(low <= 14, "{course:?}: p < 0.1 in {low} of 60");
    }
}

#[test]
fn an_exponential_warm_up_and_its_rate_are_not_claimed_together() {
    let course = Course::WarmUp { time_s: 100.0 };
    let found = claimed(FLICKER, thermal(0.05, course), 0.0, Tried::Both, 200);
    assert!(found.len() >= 198, "{}", found.len());
    let together = found.iter().filter(|one| one.beside.is_some()).count();
    assert!(together <= 1, "{together} of 200");
}

mod thorough {
    use super::*;

    /// The slope of an unrelated temperature exceeds 3.5 standard errors in 0.05 % of records: 1 of 2000.
    #[test]
    fn a_random_walk_is_not_blamed_on_an_unrelated_warm_up() {
        for tried in [Tried::Temperature, Tried::Both] {
            let mut all = 0;
            for time_s in [20.0, 100.0, 400.0, 1e6] {
                let course = Course::WarmUp { time_s };
                let blamed = claimed(WALK, thermal(0.0, course), 0.0, tried, 2000).len();
                println!("blamed at {time_s} s: {blamed} of 2000");
                assert!(blamed <= 5, "{time_s} s: {blamed} of 2000");
                all += blamed;
            }
            assert!(all <= 8, "{all} of 8000");
        }
    }
}
