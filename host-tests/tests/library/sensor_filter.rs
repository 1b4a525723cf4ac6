//! Tests that every sensor's low pass keeps its noise below half the output rate.

use allanite::{
    Accumulator, Curve, Model, Scale,
    diagnosis::{Options, Verdict},
    effect::CATALOGUE as EFFECTS,
    sensor::{
        BMI160, CATALOGUE, Description, ICM_20602, ICM_20948, ICM_42688_P, ICM_45686, L3GD20,
        LSM6DSO, LSM6DSR, LSM6DSV16X, LSM9DS1, MPU_6050, MPU_6500,
    },
};
use allanite_host::{
    diagnosis::diagnose,
    simulate::{Hidden, Preset, Simulator},
};
use std::f64::consts::PI;

const OCTAVES: usize = 20;

/// The rate and the low pass that a data sheet gives for the values of the start-up writes.
struct LowPass {
    description: &'static Description,
    rate_hz: f64,
    poles: u8,
    /// The power response at a frequency in Hz. Where the order is unknown, it is the widest possible.
    response: fn(f64) -> f64,
}

/// One pole with its cut-off at `cutoff_hz`.
fn one_pole(f: f64, cutoff_hz: f64) -> f64 {
    1.0 / (1.0 + (f / cutoff_hz).powi(2))
}

/// A digital Butterworth filter that runs at 400 Hz behind a decimator, which passes nothing above 200 Hz.
fn butterworth(f: f64, cutoff_hz: f64, poles: i32) -> f64 {
    if f >= 200.0 {
        return 0.0;
    }
    let warped = |f: f64| (PI * f / 400.0).tan();
    1.0 / (1.0 + (warped(f) / warped(cutoff_hz)).powi(2 * poles))
}

/// A running mean over one sample interval, applied twice.
fn sinc_squared(f: f64, rate_hz: f64) -> f64 {
    let x = PI * f / rate_hz;
    (x.sin() / x).powi(4)
}

const LOW_PASSES: [LowPass; 12] = [
    LowPass {
        description: &BMI160,
        rate_hz: 200.0,
        poles: 1,
        // 5.06 Hz at 50 Hz, in proportion to the rate.
        response: |f| one_pole(f, 4.0 * 5.06),
    },
    LowPass {
        description: &ICM_20602,
        rate_hz: 200.0,
        poles: 1,
        response: |f| one_pole(f, 20.0),
    },
    LowPass {
        description: &ICM_20948,
        rate_hz: 225.0,
        poles: 1,
        response: |f| one_pole(f, 24.0),
    },
    LowPass {
        description: &ICM_42688_P,
        rate_hz: 100.0,
        poles: 3,
        response: |f| butterworth(f, 47.6, 3),
    },
    LowPass {
        description: &ICM_45686,
        rate_hz: 100.0,
        poles: 1,
        response: |f| one_pole(f, 100.0 / 16.0),
    },
    LowPass {
        description: &L3GD20,
        rate_hz: 95.0,
        poles: 2,
        response: |f| one_pole(f, 32.0) * one_pole(f, 25.0),
    },
    LowPass {
        description: &LSM6DSO,
        rate_hz: 104.0,
        poles: 2,
        response: |f| sinc_squared(f, 104.0),
    },
    LowPass {
        description: &LSM6DSR,
        rate_hz: 104.0,
        poles: 2,
        response: |f| sinc_squared(f, 104.0),
    },
    LowPass {
        description: &LSM6DSV16X,
        rate_hz: 120.0,
        poles: 2,
        response: |f| sinc_squared(f, 120.0),
    },
    LowPass {
        description: &LSM9DS1,
        rate_hz: 119.0,
        poles: 2,
        response: |f| one_pole(f, 38.0) * one_pole(f, 31.0),
    },
    LowPass {
        description: &MPU_6050,
        rate_hz: 200.0,
        poles: 1,
        response: |f| one_pole(f, 20.0),
    },
    LowPass {
        description: &MPU_6500,
        rate_hz: 200.0,
        poles: 1,
        response: |f| one_pole(f, 20.0),
    },
];

/// The integral of a power response, up to 20 kHz.
fn noise_bandwidth_hz(response: fn(f64) -> f64) -> f64 {
    const STEP_HZ: f64 = 0.1;
    let midpoints = (0..200_000).map(|n| (f64::from(n) + 0.5) * STEP_HZ);
    midpoints.map(response).sum::<f64>() * STEP_HZ
}

/// The factor on N by the noise at multiples of the rate, which sampling folds onto frequency zero.
fn folding(response: fn(f64) -> f64, rate_hz: f64) -> f64 {
    let folded = (1..1000).map(|k| response(f64::from(k) * rate_hz));
    (1.0 + 2.0 * folded.sum::<f64>()).sqrt()
}

#[test]
fn every_sensor_has_a_low_pass_of_a_data_sheet() {
    let names = LOW_PASSES
        .each_ref()
        .map(|low_pass| low_pass.description.name);
    assert_eq!(names, CATALOGUE.map(|description| description.name));
}

#[test]
fn the_noise_bandwidth_is_below_nyquist_at_the_rate_that_is_set() {
    for low_pass in &LOW_PASSES {
        let Description {
            name,
            rate_hz,
            filter,
            ..
        } = *low_pass.description;
        assert_eq!(
            (rate_hz, filter.poles),
            (low_pass.rate_hz, low_pass.poles),
            "{name}"
        );
        assert!(
            filter.noise_bandwidth_hz < rate_hz / 2.0,
            "{name}: {filter:?}"
        );
        // The noise bandwidths of the ICM-42688-P's data sheet are up to 2 % below those of ideal filters.
        let expected = noise_bandwidth_hz(low_pass.response);
        assert!(
            (filter.noise_bandwidth_hz / expected - 1.0).abs() < 0.025,
            "{name}: {filter:?} instead of {expected} Hz"
        );
    }
}

#[test]
fn folded_noise_raises_the_angle_random_walk_by_at_most_two_per_cent() {
    for low_pass in &LOW_PASSES {
        let factor = folding(low_pass.response, low_pass.rate_hz);
        assert!(factor < 1.02, "{}: {factor}", low_pass.description.name);
    }
}

/// These settings were in use once, and each fails one of the tests above.
#[test]
fn a_low_pass_that_is_too_wide_is_noticed() {
    // The ICM-42688-P after reset: second order, 92.3 Hz, noise bandwidth 89.5 Hz.
    let after_reset: fn(f64) -> f64 = |f| butterworth(f, 92.3, 2);
    assert!(noise_bandwidth_hz(after_reset) > 50.0);
    assert!(folding(after_reset, 100.0) > 1.3);
    // The MPU-6050 behind 42 Hz, at 100 Hz.
    let wide: fn(f64) -> f64 = |f| one_pole(f, 42.0);
    assert!(noise_bandwidth_hz(wide) > 50.0);
    assert!(folding(wide, 100.0) > 1.2);
}

/// Counts of a gyro behind a sensor's low pass, and what a diagnosis finds missing in a model of it.
fn missing(model: &Model, curve: &Curve<OCTAVES>) -> Vec<&'static str> {
    let mut found = Vec::new();
    let verdict = diagnose(curve, model, &EFFECTS, Options::default(), |step| {
        let terms = step.model.terms().iter();
        let known = |name: &str| model.position(name).is_some();
        let names = terms.map(|term| term.effect.name());
        found = names.filter(|name| !known(name)).collect();
    });
    assert!(matches!(verdict, Ok(Verdict::Adequate | Verdict::Improved)));
    found
}

/// The filter's shape follows from its noise bandwidth. A model that has it explains the record, and one that lacks it
/// names a filter.
#[test]
fn a_known_filter_is_part_of_the_model_and_not_found() {
    for (description, cutoff_hz) in [(&MPU_6500, 20.0), (&ICM_42688_P, 45.93), (&LSM6DSO, 31.24)] {
        let term = description.filter.term();
        let [time_constant_s, poles, _] = term.parameters;
        let found_hz = 1.0 / (2.0 * PI * time_constant_s);
        assert!((found_hz / cutoff_hz - 1.0).abs() < 1e-3, "{found_hz}");
        assert_eq!(poles, f64::from(description.filter.poles));

        let coefficients = Preset::Mems.coefficients();
        let hidden = Hidden::new("low_pass", term.parameters, coefficients.angle_random_walk);
        let rate_hz = description.rate_hz;
        let simulator = Simulator::with_hidden(coefficients, hidden.as_slice(), rate_hz, 3);
        let scale = Scale::new(1e-4, rate_hz).unwrap();
        let mut accumulator = Accumulator::<OCTAVES>::new();
        for rate in simulator.take(1 << 17) {
            accumulator.push((rate / 1e-4).round() as i32);
        }
        let curve = accumulator.curve(scale);
        let (unaware, mut aware) = (Model::ieee_952(), Model::ieee_952());
        aware.put(term).unwrap();
        assert!(missing(&aware, &curve).is_empty(), "{}", description.name);
        let named = missing(&unaware, &curve);
        let is_filter = |name: &&str| ["low_pass", "decimation_filter", "notch"].contains(name);
        assert!(
            named.iter().all(is_filter),
            "{}: {named:?}",
            description.name
        );
        // So near half the rate, the ICM-42688-P's filter changes the octaves by little more than their scatter.
        let is_plain = cutoff_hz < 0.4 * rate_hz;
        assert!(!named.is_empty() || !is_plain, "{}", description.name);
    }
}
