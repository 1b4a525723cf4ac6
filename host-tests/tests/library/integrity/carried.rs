//! A gyro that is carried for the whole record is refused by its record, its fit and its self-test.

use super::{FINE, RATE_HZ, SAMPLES, counts_per_rate, quantised};
use allanite::{
    Axes, Axis, Error, Model, Scale,
    axis::Gated,
    diagnosis::{Diagnosis, Options, Verdict},
    effect::CATALOGUE,
    fit::{self, Fitting},
    ieee_952,
    integrity::Reason,
    motion,
    self_test::{Limit, Plan, SelfTest, Status},
};
use allanite_host::simulate::{Preset, Simulator};
use core::ops::ControlFlow;

/// Rates in deg/s that turn smoothly about all axes, of the size of this deviation: white noise behind two low passes of 1 Hz.
fn carried(size: f64, samples: usize, seed: u64) -> [Vec<f64>; 3] {
    let mut state = seed.wrapping_mul(2) + 1;
    let mut uniform = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
    };
    let mut stages = [[0.0_f64; 2]; 3];
    let mut axes = [(); 3].map(|()| Vec::with_capacity(samples));
    for _ in 0..samples + 1000 {
        for (axis, stage) in axes.iter_mut().zip(&mut stages) {
            stage[0] += 0.06 * (uniform() - stage[0]);
            stage[1] += 0.06 * (stage[0] - stage[1]);
            axis.push(stage[1]);
        }
    }
    axes.map(|axis| {
        let axis = &axis[1000..];
        let deviation = (axis.iter().map(|x| x * x).sum::<f64>() / axis.len() as f64).sqrt();
        axis.iter().map(|x| size * x / deviation).collect()
    })
}

/// Counts of three axes of a gyro of this grade that moves by so much, so many for a deg/s.
fn recorded(preset: Preset, per_rate: f64, size: f64, samples: usize, seed: u64) -> [Vec<i32>; 3] {
    let motion = carried(size, samples, seed);
    let mut seed = 3 * seed;
    motion.map(|motion| {
        seed += 1;
        let simulator = Simulator::new(preset.coefficients(), RATE_HZ, seed);
        let rates = simulator.zip(motion).map(|(noise, rate)| noise + rate);
        quantised(rates, per_rate)
    })
}

fn axes(counts: &[Vec<i32>; 3]) -> Axes<16> {
    let mut axes = Axes::new();
    let [x, y, z] = counts;
    for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
        axes.push([x, y, z]);
    }
    axes
}

fn scale(per_rate: f64) -> Scale {
    Scale::new((1.0 / per_rate) as _, RATE_HZ as _).unwrap()
}

fn is_carried(reason: Option<Reason>) -> bool {
    matches!(reason, Some(Reason::Moved { .. }))
}

#[test]
fn every_door_of_the_library_refuses_a_gyro_that_is_carried() {
    let scale = scale(FINE);
    for seed in 0..5 {
        let counts = recorded(Preset::Mems, FINE, 5.0, 6000, seed);
        let mut axes = axes(&counts);
        for axis in 0..3 {
            let record = axes.record(axis, scale).unwrap();
            assert!(is_carried(record.invalid), "{:?}", record.invalid);
            let model = Model::ieee_952();
            let fitted = fit::fit(&record, &model, fit::Options::default());
            assert!(
                matches!(fitted, Err(Error::Invalid(Reason::Moved { .. }))),
                "{fitted:?}"
            );
            let mut fitting = Fitting::new(&record, model.clone(), fit::Options::default());
            assert!(matches!(fitting.advance(), Err(Error::Invalid(_))));
            assert!(matches!(ieee_952::fit(&record), Err(Error::Invalid(_))));
            // Whoever wants the numbers all the same asks for the curve.
            assert!(fit::fit(&record.curve, &model, fit::Options::default()).is_ok());
            let mut diagnosis = Diagnosis::new(&record, &model, &CATALOGUE, Options::default());
            let verdict = diagnosis.run(|_| {}, &mut || ControlFlow::Continue(()));
            assert!(
                matches!(verdict, Ok(Some(Verdict::Invalid(Reason::Moved { .. })))),
                "{verdict:?}"
            );
        }
    }
}

#[test]
fn a_self_test_of_a_gyro_that_is_carried_blames_the_motion() {
    let scale = scale(FINE);
    let usual = Preset::Mems.coefficients();
    for seed in 10..15 {
        let [counts, ..] = recorded(Preset::Mems, FINE, 5.0, 6000, seed);
        let plan = Plan {
            limits: [Limit {
                effect: "angle_random_walk",
                most: (2.0 * usual.angle_random_walk) as _,
            }]
            .into_iter()
            .collect(),
            least_p: 1e-3,
            false_pass: 0.01,
            false_fail: 0.01,
            shortest_s: 5.0,
            longest_s: 60.0,
        };
        let mut test = SelfTest::<16>::new(plan, scale).unwrap();
        let mut axis = Axis::<16, 0, Gated>::new();
        let mut status = test.status(0);
        for count in counts {
            axis.push(count);
            if test.is_due(axis.samples()) {
                let record = axis.record_so_far(0, scale).unwrap();
                status = test.look(&record).unwrap();
            }
        }
        assert!(
            matches!(status, Status::Invalid(Reason::Moved { .. })),
            "{status:?}"
        );
    }
}

#[test]
fn gyros_at_rest_are_not_carried() {
    let mut all = 0;
    for preset in Preset::TYPICAL {
        let per_rate = counts_per_rate(preset, 8.0);
        for seed in 0..4 {
            for samples in [1000, 6000, SAMPLES] {
                let counts = recorded(preset, per_rate, 0.0, samples, seed);
                let found = axes(&counts).record(0, scale(per_rate)).unwrap().invalid;
                assert!(!is_carried(found), "{preset:?} {samples}: {found:?}");
                all += 1;
            }
        }
    }
    assert_eq!(all, 12 * Preset::TYPICAL.len());
}

#[test]
fn the_unit_makes_no_difference_if_it_is_known() {
    let counts = recorded(Preset::Mems, FINE, 1.0, 6000, 7);
    let curves = |per_rate: f64| {
        let axes = axes(&counts);
        axes.accumulators().map(|axis| axis.curve(scale(per_rate)))
    };
    let per_degree = core::f64::consts::PI / 180.0;
    let [degrees, radians] = [FINE, FINE / per_degree].map(curves);
    let [found, same] = [(&degrees, 1.0), (&radians, per_degree)]
        .map(|(curves, unit)| motion::judge(curves.each_ref(), Some(unit as _)));
    assert!(is_carried(found), "{found:?}");
    assert_eq!(found, same);
}
