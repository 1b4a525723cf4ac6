//! What the course of a record tells, on simulated records, and what a step and a warm-up add to a curve.

use allanite::{
    Accumulator, Model, Scale,
    course::{Course, What, allan_variance_of_step, allan_variance_of_warm_up, analyse, events},
    fit::{Options, fit},
};
use allanite_host::simulate::{Coefficients, Preset, Simulator};

/// The octave variances of a record that holds nothing but this function of the sample, in counts².
fn measured(samples: u32, rate: impl Fn(u32) -> f64) -> Vec<(u32, f64)> {
    const COUNT: f64 = 1.0 / 1_048_576.0;
    let mut accumulator = Accumulator::<24>::new();
    for n in 0..samples {
        accumulator.push((rate(n) / COUNT).round() as i32);
    }
    let curve = accumulator.curve_of(Scale::new(COUNT, 1.0).unwrap(), 1);
    let points = curve.points().iter();
    points.map(|point| (point.m, point.variance)).collect()
}

#[test]
fn the_allan_variance_of_a_step_is_that_of_a_record_that_holds_nothing_else() {
    for (samples, at, size) in [(5000, 1234, 0.5), (4096, 4000, -2.0), (777, 3, 100.0)] {
        let octaves = measured(samples, |n| if n >= at { size } else { 0.0 });
        assert!(octaves.len() >= 9, "{}", octaves.len());
        for (m, variance) in octaves {
            let expected = allan_variance_of_step(m, u64::from(samples), f64::from(at), size);
            let off = (variance - expected).abs();
            assert!(off <= 1e-9 * size * size, "m {m}: {variance}, {expected}");
        }
    }
    assert_eq!(allan_variance_of_step(64, 127, 60.0, 1.0), 0.0);
}

#[test]
fn the_allan_variance_of_a_warm_up_is_that_of_a_record_that_holds_nothing_else() {
    for (samples, time, size) in [
        (5000, 300.0, 500.0),
        (4096, 4000.0, -500.0),
        (777, 3.0, 500.0),
    ] {
        let octaves = measured(samples, |n| size * (-f64::from(n) / time).exp());
        assert!(octaves.len() >= 9, "{}", octaves.len());
        for (m, variance) in octaves {
            let expected = allan_variance_of_warm_up(m, u64::from(samples), time, size);
            let off = (variance - expected).abs();
            // Rounding to counts adds up to a millionth of a rate unit to each sample.
            assert!(
                off <= 1e-6 * expected + 1e-9,
                "m {m}: {variance}, {expected}"
            );
        }
    }
}

/// A record of the preset "mems" with a step of 0.1 °/s at 500 s.
fn with_step(seed: u64) -> (Accumulator<24>, Course, Scale) {
    let scale = Scale::new(1e-5, 100.0).unwrap();
    let mut gyro = Simulator::new(Preset::Mems.coefficients(), 100.0, seed);
    let (mut accumulator, mut course) = (Accumulator::new(), Course::new());
    for n in 0..1 << 17 {
        let step = if n >= 50_000 { 0.1 } else { 0.0 };
        let count = ((gyro.next().unwrap() + step) / 1e-5).round() as i32;
        accumulator.push(count);
        course.push(count, []);
    }
    (accumulator, course, scale)
}

#[test]
fn a_step_is_underestimated_until_the_noise_is_fitted_without_it() {
    let model = Model::ieee_952();
    let (mut first, mut settled, mut walks) = (0.0, 0.0, [0.0; 3]);
    const SEEDS: u64 = 6;
    for seed in 0..SEEDS {
        let (accumulator, course, scale) = with_step(seed);
        let curve = accumulator.curve(scale);
        let swollen = fit(&curve, &model, Options::default()).unwrap();
        let step_of = |events: &[allanite::course::Event]| {
            let mut steps = events.iter().filter(|event| event.what == What::Step);
            let step = *steps.next().expect("a step");
            assert!((step.at_s - 500.0).abs() <= 20.48, "{step:?}");
            step
        };
        let once = step_of(&events(&course, scale, &model, &swollen.squares()));
        let analysis = analyse(&curve, &model, &course, scale, Options::default()).unwrap();
        let last = step_of(&analysis.events);
        assert!(once.z == last.z || last.z > once.z);
        first += (once.upper - once.lower) / SEEDS as f64;
        settled += (last.upper - last.lower) / SEEDS as f64;
        // The rate random walk of the fit before and after, and what the corrected curve leaves.
        walks[0] += swollen.coefficients[3].square / SEEDS as f64;
        walks[1] += analysis.fit.coefficients[3].square / SEEDS as f64;
        let points = analysis.curve.points().iter().zip(curve.points());
        assert!(points.clone().count() > 12);
        for (corrected, measured) in points {
            assert!(corrected.variance > 0.0 && corrected.variance <= 1.3 * measured.variance);
        }
        walks[2] += (last.size - 0.1).abs() / SEEDS as f64;
    }
    // The noise that swallowed the step has an interval that is twice as wide.
    assert!(first > 2.0 * settled, "{first} → {settled}");
    assert!(walks[0] > 4.0 * walks[1], "{walks:?}");
    assert!(walks[2] < 0.01, "{walks:?}");
}

/// What is told of a record of 11 minutes in which a rate random walk hides beside a rate ramp, and the rate steps by
/// `step` at 200 s. The white noise of a sample is 0.05 °/s.
fn told_beside_walk_and_ramp(step: f64, seed: u64) -> allanite::course::Events {
    let scale = Scale::new(1e-5, 100.0).unwrap();
    let coefficients = Coefficients {
        angle_random_walk: 0.005,
        rate_random_walk: 3.96e-4,
        rate_ramp: 4.5e-4,
        ..Coefficients::default()
    };
    let (mut accumulator, mut course) = (Accumulator::<24>::new(), Course::<0>::new());
    let gyro = Simulator::new(coefficients, 100.0, seed).take(1 << 16);
    for (n, rate) in gyro.enumerate() {
        let rate = rate + if n >= 20_000 { step } else { 0.0 };
        let count = (rate / 1e-5).round() as i32;
        accumulator.push(count);
        course.push(count, []);
    }
    let curve = accumulator.curve(scale);
    let model = Model::ieee_952();
    let analysis = analyse(&curve, &model, &course, scale, Options::default()).unwrap();
    analysis.events
}

#[test]
fn a_walk_that_the_curve_does_not_resolve_beside_a_ramp_is_no_step() {
    for seed in 0..60 {
        let events = told_beside_walk_and_ramp(0.0, seed);
        assert!(events.is_empty(), "seed {seed}: {events:?}");
    }
}

#[test]
fn a_step_beside_a_walk_and_a_ramp_is_told() {
    const SEEDS: u64 = 20;
    let (mut told, mut covered) = (0, 0);
    for seed in 0..SEEDS {
        let events = told_beside_walk_and_ramp(0.05, seed);
        let mut steps = events.iter().filter(|event| event.what == What::Step);
        let near = steps.find(|step| (step.at_s - 200.0).abs() <= 10.24);
        told += u64::from(near.is_some());
        covered += u64::from(near.is_some_and(|step| step.lower < 0.05 && 0.05 < step.upper));
    }
    assert!(told >= SEEDS - 1, "{told}");
    assert!(covered * 4 >= told * 3, "{covered} of {told}");
}

#[test]
fn lost_samples_move_events_by_their_time_and_gaps_do_not() {
    let scale = Scale::new(1e-5, 100.0).unwrap();
    let mut gyro = Simulator::new(Preset::Mems.coefficients(), 100.0, 3);
    let (mut accumulator, mut course) = (Accumulator::<24>::new(), Course::<0>::new());
    for n in 0..1 << 17 {
        if n == 30_000 {
            // 100 s are lost, and then some more of unknown number.
            accumulator.gap();
            course.lost(10_000);
            course.gap();
        }
        let step = if n >= 50_000 { 0.1 } else { 0.0 };
        let count = ((gyro.next().unwrap() + step) / 1e-5).round() as i32;
        accumulator.push(count);
        course.push(count, []);
    }
    let curve = accumulator.curve(scale);
    let model = Model::ieee_952();
    let analysis = analyse(&curve, &model, &course, scale, Options::default()).unwrap();
    let [step] = analysis.events[..] else {
        panic!("{:?}", analysis.events)
    };
    assert_eq!(step.what, What::Step);
    assert!((step.at_s - 600.0).abs() <= 41.0, "{step:?}");
    assert!(step.lower < 0.1 && 0.1 < step.upper, "{step:?}");
}

#[test]
fn a_course_that_is_too_short_tells_nothing() {
    let scale = Scale::new(1.0, 100.0).unwrap();
    let model = Model::ieee_952();
    let mut course = Course::<0>::new();
    for n in 0..500 {
        assert!(events(&course, scale, &model, &[1.0; 5]).is_empty(), "{n}");
        course.push(if n < 250 { 0 } else { 1000 }, []);
    }
}
