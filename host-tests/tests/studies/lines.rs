//! Lines at the limits of a spectrum, and what is said of their origin.

use allanite_host::simulate::{Preset, Random};
use allanite_studies::lines::{Said, diagnose, draw, near_half};
use program::{json, output};
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};
use std::{f64::consts::TAU, fmt::Write, path::Path};
use tempfile::TempDir;

#[test]
fn a_strong_line_never_ends_a_diagnosis_with_an_error() {
    // Records of which the variance of an octave was negative, so that the covariance had no factor.
    for seed in [65, 146, 203, 293] {
        let line = draw(Preset::Mems, seed);
        let (said, _) = diagnose(Preset::Mems, line, seed);
        assert!(matches!(said, Said::Line { .. }), "{seed}: {said:?}");
    }
}

/// Of 200 records, 190 intervals held the frequency. They were 178 while the noise beside a line near the last bin was
/// taken to beat in the bins of the level alone.
#[test]
fn intervals_near_half_the_rate_hold_the_frequency() {
    let tally = near_half(Preset::Mems, 200);
    assert!(tally.found >= 196, "{tally:?}");
    let share = tally.covered as f64 / tally.found as f64;
    assert!((0.93..=0.975).contains(&share), "{share}: {tally:?}");
    let mean_error_hz = tally.error_hz / tally.found as f64;
    assert!(mean_error_hz.abs() < 0.03, "{mean_error_hz}");
}

/// A consumer gyro with sinusoids of these frequencies and amplitudes.
fn simulated(folder: &Path, rate_hz: &str, duration_s: &str, sines: &[(f64, f64)]) {
    let sines: Vec<String> = sines
        .iter()
        .map(|(f, a)| format!("sinusoid:frequency_hz={f},amplitude={a}"))
        .collect();
    let mut arguments = vec!["simulate", "mems", "--rate", rate_hz];
    arguments.extend(["--duration", duration_s, "--output", "log.csv"]);
    for sine in &sines {
        arguments.extend(["--effect", sine]);
    }
    output(folder, &arguments);
}

/// White noise and the vibration of an engine at 600 rpm, at 10 Hz and 20 Hz. Its frequency wanders as a random walk, by
/// this share at the end.
fn engine(folder: &Path, rate_hz: f64, wanders: f64) {
    const SAMPLES: usize = 1 << 16;
    let mut random = Random::seed_from_u64(5);
    // The sum of twelve uniform numbers is nearly normal (Irwin 1927).
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let (mut walk, mut turns) = (0.0, 0.0);
    let mut text = String::from("gx\n");
    for _ in 0..SAMPLES {
        walk += wanders * normal() / (SAMPLES as f64).sqrt();
        turns += 10.0 * (1.0 + walk) / rate_hz;
        let vibration = 0.05 * (TAU * turns).sin() + 0.04 * (2.0 * TAU * turns).sin();
        writeln!(text, "{:.6}", 0.05 * normal() + vibration).unwrap();
    }
    std::fs::write(folder.join("log.csv"), text).unwrap();
}

fn axis(folder: &Path, rate_hz: &str) -> (Value, String) {
    let arguments = ["log.csv", "--rate", rate_hz, "--unit", "deg/s"];
    let document = json(folder, &[&["diagnose"], &arguments[..]].concat());
    let text = output(folder, &[&["diagnose"], &arguments[..]].concat());
    (document["axes"][0].clone(), text)
}

/// Whether a text has the word *mains*, as which a part of *remains* does not count.
fn says_mains(text: &str) -> bool {
    let mut words = text.split(|c: char| !c.is_alphabetic());
    words.any(|word| word == "mains")
}

#[test]
fn a_line_at_half_the_rate_is_said_to_be_there_and_not_to_be_mains() {
    // One record is 10.9 min long. At 50 Hz itself, the amplitude that is seen depends on the phase.
    for frequency_hz in [49.9, 50.0] {
        let folder = TempDir::new().unwrap();
        simulated(folder.path(), "100", "655.36", &[(frequency_hz, 0.08)]);
        let (axis, text) = axis(folder.path(), "100");
        let line = &axis["lines"][0];
        let [lower, value, upper] =
            ["lower_hz", "frequency_hz", "upper_hz"].map(|name| line[name].as_f64().unwrap());
        assert!(lower < 49.9 && (upper - 50.0).abs() < 1e-9, "{line}");
        assert!(lower <= value && value <= upper && lower > 48.5, "{line}");
        assert!(
            text.contains("cannot be told from one at half the sample rate"),
            "{text}"
        );
        assert!(!says_mains(&text), "{text}");
    }
    // An interval that ends below half the rate is not said to reach it. A step of half a per cent from the second of these
    // frequencies leads beyond it.
    for (frequency_hz, amplitude) in [(48.7, 0.08), (49.75, 0.2)] {
        let folder = TempDir::new().unwrap();
        simulated(folder.path(), "100", "655.36", &[(frequency_hz, amplitude)]);
        let (axis, text) = axis(folder.path(), "100");
        let line = &axis["lines"][0];
        let [lower, upper] = ["lower_hz", "upper_hz"].map(|name| line[name].as_f64().unwrap());
        assert!(frequency_hz - 0.3 < lower && lower < frequency_hz, "{line}");
        assert!(frequency_hz < upper && upper < frequency_hz + 0.1, "{line}");
        assert!(!text.contains("half the sample rate, where"), "{text}");
    }
}

#[test]
fn vibration_of_an_engine_is_never_said_to_be_mains() {
    // At 40 Hz, 50 Hz is seen at 10 Hz and 6 times as much at 20 Hz; at 60 Hz, twice as much is.
    for rate_hz in ["40", "60", "100"] {
        for wanders in [0.0, 0.0005, 0.005, 0.03] {
            let folder = TempDir::new().unwrap();
            engine(folder.path(), rate_hz.parse().unwrap(), wanders);
            let (axis, text) = axis(folder.path(), rate_hz);
            assert!(!says_mains(&text), "{rate_hz} Hz, {wanders}: {text}");
            if wanders == 0.0 && rate_hz == "100" {
                assert_eq!(axis["combs"][0]["orders"], json!([1, 2]), "{axis}");
            }
        }
    }
}

#[test]
fn steady_lines_of_mains_are_said_to_be_mains() {
    let folder = TempDir::new().unwrap();
    simulated(
        folder.path(),
        "1000",
        "131.072",
        &[(50.02, 0.2), (100.04, 0.1)],
    );
    let (both, text) = axis(folder.path(), "1000");
    assert_eq!(both["combs"][0]["mains_hz"], json!(50.0), "{both}");
    assert_eq!(both["combs"][0]["orders"], json!([1, 2]));
    assert!(
        text.contains("sinusoids (50 Hz mains and 1 harmonic)"),
        "{text}"
    );

    simulated(folder.path(), "1000", "131.072", &[(59.97, 0.2)]);
    let (one, text) = axis(folder.path(), "1000");
    assert!(says_mains(&text), "{text}");
    assert_eq!(one["combs"][0]["mains_hz"], json!(60.0), "{one}");
    assert!(
        text.contains("missing effect: sinusoid (60 Hz mains)"),
        "{text}"
    );
    assert!(
        text.contains("is steady and agrees with 60 Hz mains"),
        "{text}"
    );

    // Any other line is not.
    simulated(folder.path(), "1000", "131.072", &[(56.3, 0.2)]);
    let (_, text) = axis(folder.path(), "1000");
    assert!(!says_mains(&text), "{text}");
}
