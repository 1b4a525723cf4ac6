//! Records of one, two and three effects, as other people's were: what is said of each, word by word.

use allanite::{Coefficient, diagnosis::Verdict};
use allanite_host::simulate::{Coefficients, Hidden, Simulator};
use allanite_studies::{measured::Measured, said::Said};
use program::json;
use std::fs;
use tempfile::TempDir;

const RATE_HZ: f64 = 100.0;
const SAMPLES: usize = 1 << 16;
const SEEDS: u64 = 3;
/// The white noise of a sample, in deg/s.
const WHITE: f64 = 0.05;

/// The angle random walk.
const N: f64 = 0.005;

/// A gyro with Q 2e-4, N 0.005, B 0.004 and K 3e-4, in deg and s.
const GYRO: Coefficients = Coefficients {
    quantization: 2e-4,
    angle_random_walk: N,
    bias_instability: 0.004,
    rate_random_walk: 3e-4,
    rate_ramp: 0.0,
};

/// An effect with its shape and its size.
type Effect = (&'static str, [f64; 3], f64);

fn said(effects: &[Effect], seed: u64) -> Said {
    let hidden: Vec<Hidden> = effects
        .iter()
        .map(|&(name, shape, size)| Hidden::new(name, shape, size).expect("of the catalogue"))
        .collect();
    let mut simulator = Simulator::with_hidden(GYRO, &hidden, RATE_HZ, seed);
    Said::of(&Measured::of(&mut simulator, GYRO, SAMPLES))
}

/// Whether an interval of 95 % holds a value that lies outside of it by less than half its width: one in 10 000 does not.
fn holds(found: &Coefficient, truth: f64) -> bool {
    let beyond = 0.5 * (found.upper - found.lower);
    (found.lower - beyond..=found.upper + beyond).contains(&truth)
}

/// Demands that all effects are named and nothing else, with a first parameter as near as given, and that N is in its
/// interval.
fn told(effects: &[Effect], within: f64) {
    let names: Vec<&str> = effects.iter().map(|(name, ..)| *name).collect();
    for seed in 0..SEEDS {
        let said = said(effects, seed);
        let words = said.words();
        assert!(
            said.compared(&names).exact,
            "{names:?}, seed {seed}: {words}"
        );
        assert!(!said.is_unexplained(), "{names:?}, seed {seed}: {words}");
        let white = said.coefficient("N").expect("white noise");
        assert!(
            holds(white, N),
            "{names:?}, seed {seed}: {words}, {white:?}"
        );
        for (name, [first, ..], _) in effects {
            let mut found = said.named.iter().zip(&said.shapes);
            let is_near = found.any(|((found, _), shape)| {
                found == name && (shape[0] / first - 1.0).abs() < within
            });
            assert!(is_near, "{name}, seed {seed}: {words}");
        }
    }
}

#[test]
fn slow_gauss_markov_noise_is_no_random_walk() {
    told(&[("gauss_markov", [7.0, 0.0, 0.0], 0.1)], 0.6);
}

#[test]
fn two_strong_lines_side_by_side_are_two_lines() {
    let lines = [
        ("sinusoid", [9.78, 0.0, 0.0], 3.0 * WHITE),
        ("sinusoid", [11.43, 0.0, 0.0], 2.8 * WHITE),
    ];
    told(&lines, 1e-3);
}

#[test]
fn a_filter_at_the_sample_rate_has_nothing_beside_it() {
    let time_s = 1.0 / (std::f64::consts::TAU * 30.0);
    told(&[("digital_low_pass", [time_s, 4.0, 0.0], N)], 0.05);
}

/// Software that smooths a log smooths its quantization and flicker noise too. They are no resonances and lines.
#[test]
fn a_mean_over_samples_of_the_whole_output_has_nothing_beside_it() {
    for samples in [3.0, 5.0, 9.0] {
        told(&[("moving_average", [samples, 0.0, 0.0], N)], 1e-6);
    }
}

#[test]
fn a_line_behind_a_moving_average_is_told_from_it() {
    let line = ("sinusoid", [7.7, 0.0, 0.0], 0.3 * WHITE);
    told(&[line, ("moving_average", [4.0, 0.0, 0.0], N)], 1e-3);
}

#[test]
fn a_low_pass_of_the_whole_output_has_nothing_beside_it() {
    for cutoff_hz in [12.0, 25.0] {
        let time_s = 1.0 / (std::f64::consts::TAU * cutoff_hz);
        told(&[("output_low_pass", [time_s, 2.0, 0.0], N)], 0.05);
    }
}

#[test]
fn a_line_below_the_edge_of_a_low_pass_is_told_from_it() {
    let line = ("sinusoid", [1.362, 0.0, 0.0], 3.9 * WHITE);
    told(&[line, ("low_pass", [0.0134, 4.0, 0.0], N)], 0.05);
}

#[test]
fn a_line_above_the_edge_of_a_low_pass_is_told_from_it() {
    let line = ("sinusoid", [20.0, 0.0, 0.0], 0.4 * WHITE);
    let time_s = 1.0 / (std::f64::consts::TAU * 8.0);
    told(&[line, ("low_pass", [time_s, 2.0, 0.0], N)], 0.05);
}

#[test]
fn a_resonance_and_a_line_beside_it_are_told() {
    let resonance = ("resonance", [17.0, 6.0, 0.0], 0.8 * WHITE);
    told(
        &[resonance, ("sinusoid", [6.3, 0.0, 0.0], 0.7 * WHITE)],
        0.05,
    );
}

#[test]
fn a_resonance_that_hardly_rings_is_one_resonance() {
    told(&[("resonance", [4.0, 0.7, 0.0], WHITE)], 0.2);
}

#[test]
fn a_notch_as_wide_as_its_frequency_is_one_notch() {
    told(&[("notch", [14.0, 0.9, 0.0], N)], 0.1);
}

#[test]
fn white_noise_that_rises_keeps_the_coefficient_of_its_plateau() {
    // A resonance that hardly rings is as good.
    let effects = [("mode_split", [10.0, 30.0, 0.0], N)];
    for seed in 0..SEEDS {
        let said = said(&effects, seed);
        let words = said.words();
        assert!(said.compared(&["mode_split"]).among, "{seed}: {words}");
        let white = said.coefficient("N").expect("white noise");
        assert!(holds(white, N), "{seed}: {words}, {white:?}");
    }
}

#[test]
fn a_filter_and_noise_that_can_exchange_their_times_leave_n_open() {
    // Both densities are Lorentzians, so that either may be the white noise.
    let effects = [
        ("low_pass", [0.03, 1.0, 0.0], N),
        ("gauss_markov", [0.43, 0.0, 0.0], 0.8 * WHITE),
    ];
    let mut named = 0;
    for seed in 0..4 * SEEDS {
        let said = said(&effects, seed);
        let words = said.words();
        // White noise that rises and then falls is as good in some of the records, and told instead.
        if !said.compared(&["low_pass", "gauss_markov"]).exact {
            continue;
        }
        named += 1;
        let white = said.coefficient("N").expect("white noise");
        assert!(holds(white, N), "{seed}: {words}, {white:?}");
        // The plateau below both edges: N² of the gyro, and 2 s² T of the process.
        let plateau = (N.powi(2) + 2.0 * (0.8 * WHITE).powi(2) * 0.43).sqrt();
        assert!(holds(white, 0.98 * plateau), "{seed}: {words}, {white:?}");
    }
    assert!(named >= 2 * SEEDS, "{named}");
}

/// The taps of a filter whose gain has the square `(1 + (f/10 Hz)²)/(1 + (f/30 Hz)⁴)` up to half the sample rate.
fn rise(taps: usize) -> Vec<f64> {
    const STEPS: usize = 4096;
    let gain = |hz: f64| ((1.0 + (hz / 10.0).powi(2)) / (1.0 + (hz / 30.0).powi(4))).sqrt();
    let tap = |n: usize| {
        let lag = n as f64 - (taps / 2) as f64;
        let at = |step: usize| {
            let cycles = 0.5 * (step as f64 + 0.5) / STEPS as f64;
            gain(cycles * RATE_HZ) * (std::f64::consts::TAU * cycles * lag).cos()
        };
        (0..STEPS).map(at).sum::<f64>() / STEPS as f64
    };
    (0..taps).map(tap).collect()
}

/// A sensor that filters before it lowers its rate folds nothing back. The catalogue's rising noise is folded, so that the
/// diagnosis takes another effect for the difference, and tells what it adds to the plateau that everybody reads off the curve.
#[test]
fn a_rise_that_the_catalogue_has_nearly_leaves_the_plateau_to_read() {
    const TAPS: usize = 129;
    let white = Coefficients {
        angle_random_walk: N,
        ..Coefficients::default()
    };
    let rest = Coefficients {
        angle_random_walk: 0.0,
        ..GYRO
    };
    let record = |coefficients, seed| {
        let simulator = Simulator::with_hidden(coefficients, &[], RATE_HZ, seed);
        simulator.take(SAMPLES + TAPS).collect::<Vec<f64>>()
    };
    let taps = rise(TAPS);
    let mut read = Vec::new();
    for seed in 0..SEEDS {
        let folder = TempDir::new().unwrap();
        let (white, rest) = (record(white, seed), record(rest, seed + 1000));
        let passed = white.windows(TAPS).map(|window| {
            window
                .iter()
                .zip(&taps)
                .map(|(x, tap)| x * tap)
                .sum::<f64>()
        });
        let rows = passed.zip(rest).map(|(x, y)| format!("{}\n", x + y));
        let text = format!(
            "# rate_hz={RATE_HZ}\n# unit=deg/s\ngx\n{}",
            rows.collect::<String>()
        );
        fs::write(folder.path().join("log.csv"), text).unwrap();
        let document = json(folder.path(), &["diagnose", "log.csv"]);
        let axis = &document["axes"][0];
        assert_ne!(axis["verdict"], Verdict::Adequate.name(), "{axis}");
        let notes = axis["notes"].as_array().unwrap().iter();
        let words = notes.filter_map(|note| {
            note.as_str()?
                .split_once("the curve reads ")?
                .1
                .split(' ')
                .next()
        });
        read.extend(words.map(|number| number.parse::<f64>().unwrap()));
    }
    assert!(!read.is_empty());
    assert!(
        read.iter().all(|plateau| (plateau / N - 1.0).abs() < 0.1),
        "{read:?}"
    );
}
