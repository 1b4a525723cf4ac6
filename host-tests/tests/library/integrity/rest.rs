//! A gyro at rest is valid, whatever its noise.

use super::{
    FINE, RATE_HZ, assert_unremarkable, assert_valid, counts_per_rate, integrity, quantised, rest,
};
use allanite_host::simulate::{Coefficients, Hidden, Preset, Simulator};

#[test]
fn a_gyro_at_rest_is_valid_and_no_event_is_counted() {
    for preset in Preset::TYPICAL {
        assert_valid("at 131 counts", 100, |seed| {
            let counts = rest(preset, FINE, seed);
            assert_unremarkable(integrity(&counts).tally());
            counts
        });
    }
}

#[test]
fn a_gyro_whose_samples_often_repeat_is_valid() {
    // A scale of 0.05 deg/s per count is as coarse as gyros come. The noise is then one count rms.
    assert_valid("0.05 deg/s", 100, |seed| rest(Preset::Mems, 20.0, seed));
    for preset in Preset::TYPICAL {
        for rms in [0.55, 0.6, 0.8] {
            assert_valid(&format!("{rms} counts"), 40, |seed| {
                let scale = counts_per_rate(preset, rms);
                // The mean rate lies anywhere between the middle and the edge of a count.
                let offset = seed as f64 / 40.0 / scale;
                let rates = Simulator::new(preset.coefficients(), RATE_HZ, seed);
                quantised(rates.map(|rate| rate + offset), scale)
            });
        }
    }
}

#[test]
fn records_at_other_sampling_rates_are_valid() {
    for (rate_hz, scale) in [(10.0, 131.0), (1000.0, 131.0), (8000.0, 16.4)] {
        assert_valid(&format!("{rate_hz} Hz"), 40, |seed| {
            let simulator = Simulator::new(Preset::Mems.coefficients(), rate_hz, seed);
            quantised(simulator, scale)
        });
    }
}

#[test]
fn a_record_with_any_hidden_effect_is_valid() {
    let effects = [
        ("sinusoid", [0.3, 0.0], 0.005),
        ("sinusoid", [0.3, 0.0], 0.5),
        ("sinusoid", [0.003, 0.0], 1.0),
        ("sinusoid", [7.7, 0.0], 5.0),
        ("sinusoid", [1.5626, 0.0], 2.0),
        ("gauss_markov", [5.0, 0.0], 0.01),
        ("gauss_markov", [5.0, 0.0], 0.5),
        ("gauss_markov", [200.0, 0.0], 0.5),
        ("resonance", [20.0, 30.0], 0.5),
        ("random_telegraph", [0.05, 0.0], 0.2),
        ("random_telegraph", [5.0, 0.0], 0.02),
        ("random_telegraph", [5.0, 0.0], 0.15),
        ("random_telegraph", [50.0, 0.0], 0.15),
        ("low_pass", [0.02, 0.0], 0.005),
        ("low_pass", [0.2, 0.0], 0.005),
        ("decimation_filter", [0.014, 2.0], 0.005),
        ("decimation_filter", [0.1, 1.0], 0.005),
    ];
    for (name, parameters, coefficient) in effects {
        let hidden =
            Hidden::new(name, parameters, coefficient).expect("an effect of the catalogue");
        assert_valid(
            &format!("{name} {parameters:?} {coefficient}"),
            20,
            |seed| {
                let coefficients = Preset::Mems.coefficients();
                quantised(
                    Simulator::with_hidden(coefficients, &[hidden], RATE_HZ, seed),
                    FINE,
                )
            },
        );
    }
}

#[test]
fn a_thermal_ramp_and_a_warm_up_are_valid() {
    let ramp = |slope_per_hour: f64| move |t: f64| slope_per_hour / 3600.0 * t;
    let warm_up = |t: f64| 0.1 * (1.0 - (-t / 120.0).exp());
    let late = |t: f64| 5.0 / 3600.0 * (t - 300.0).max(0.0);
    let effects: [(&str, &(dyn Fn(f64) -> f64 + Sync)); 4] = [
        ("5 deg/s/h", &ramp(5.0)),
        ("-20 deg/s/h", &ramp(-20.0)),
        ("warm-up", &warm_up),
        ("late ramp", &late),
    ];
    for (name, rate_at) in effects {
        for (preset, scale) in [
            (Preset::Mems, 20.0),
            (Preset::Mems, FINE),
            (Preset::Fog, 400.0),
        ] {
            assert_valid(name, 30, |seed| {
                let simulator = Simulator::new(preset.coefficients(), RATE_HZ, seed);
                let rates = simulator.enumerate();
                quantised(
                    rates.map(|(n, rate)| rate + rate_at(n as f64 / RATE_HZ)),
                    scale,
                )
            });
        }
    }
}

#[test]
fn pure_white_noise_is_valid_whatever_its_scale() {
    // The coarsest scale makes the noise 0.6 counts rms.
    for scale in [12.0, 131.0, 1e4, 1e7] {
        assert_valid("white", 20, |seed| {
            let coefficients = Coefficients {
                angle_random_walk: 0.005,
                ..Coefficients::default()
            };
            quantised(Simulator::new(coefficients, RATE_HZ, seed), scale)
        });
    }
}
