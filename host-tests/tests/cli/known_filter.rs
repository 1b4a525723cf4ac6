//! Tests `--filter`: a filter that is known belongs to the model, and one that does not fit is refused with what fits.

use allanite::diagnosis::Verdict;
use allanite_host::verdict::{ADEQUATE, of_five_terms};
use program::{json, number, output, refusal};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// Writes the log of a consumer gyro behind a low pass of two poles with a cut-off of 8 Hz, 2^16 samples at 100 Hz.
fn record(folder: &Path, more: &[&str]) {
    let low_pass = "low_pass:cutoff_hz=8,poles=2";
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "655.36",
        "--effect",
        low_pass,
    ];
    output(
        folder,
        &[&simulate[..], more, &["--output", "log.csv"]].concat(),
    );
}

fn diagnosed(folder: &Path, more: &[&str]) -> Value {
    let mut document = json(folder, &[&["diagnose", "log.csv"], more].concat());
    document["axes"][0].take()
}

fn assert_near(value: &Value, truth: f64, tolerance: f64) {
    assert!(
        (number(value) / truth - 1.0).abs() < tolerance,
        "{value}, not {truth}"
    );
}

/// The parameters of an effect in a step.
fn parameters<'a>(step: &'a Value, name: &str) -> &'a Value {
    let mut effects = step["effects"].as_array().unwrap().iter();
    let effect = effects.find(|effect| effect["name"] == name);
    &effect.unwrap_or_else(|| panic!("{name}: {step}"))["parameters"]
}

#[test]
fn filter_that_is_known_is_no_discovery() {
    let folder = TempDir::new().unwrap();
    record(folder.path(), &["--seed", "5"]);
    let known = diagnosed(folder.path(), &["--filter", "low_pass:cutoff_hz=8,poles=2"]);
    assert_eq!(known["verdict"], Verdict::Adequate.name(), "{known}");
    assert_eq!(known["missing"].as_array().unwrap().len(), 0);
    assert_eq!(known["filter"]["fits"], true);
    let filter = &known["filter"]["parameters"];
    assert_near(&filter["cutoff_hz"], 8.0, 1e-12);
    assert_near(
        &filter["time_constant_s"],
        0.5 / (std::f64::consts::PI * 8.0),
        1e-12,
    );
    let low_pass = parameters(&known["steps"][0], "low_pass");
    assert_near(&low_pass["angle_random_walk"], 0.005, 0.03);
    // Without it, the diagnosis has to find it.
    let found = diagnosed(folder.path(), &[]);
    assert_eq!(found["missing"], serde_json::json!(["low_pass"]));
    assert!(found.get("filter").is_none());
    let low_pass = parameters(&found["steps"][1], "low_pass");
    assert_near(&low_pass["cutoff_hz"], 8.0, 0.05);
    assert_eq!(low_pass["poles"], 2.0);
}

#[test]
fn effects_behind_a_known_filter_are_found_beside_it() {
    let folder = TempDir::new().unwrap();
    let sinusoid = "sinusoid:frequency_hz=2.7,amplitude=0.02";
    record(folder.path(), &["--effect", sinusoid]);
    let found = diagnosed(folder.path(), &["--filter", "low_pass:cutoff_hz=8,poles=2"]);
    assert_eq!(found["missing"], serde_json::json!(["sinusoid"]));
    assert_eq!(
        (&found["verdict"], &found["filter"]["fits"]),
        (&Verdict::Improved.name().into(), &true.into())
    );
    let line = &found["lines"][0];
    assert_near(&line["frequency_hz"], 2.7, 0.005);
    // The record resolves a hundredth of a hertz at best.
    let width_hz = number(&line["narrower_than_hz"]);
    assert!((1e-4..0.3).contains(&width_hz), "{line}");
}

#[test]
fn filter_that_does_not_fit_is_refuted_by_the_one_that_does() {
    let folder = TempDir::new().unwrap();
    record(folder.path(), &[]);
    for given in [
        "low_pass:cutoff_hz=12,poles=2",
        "low_pass:cutoff_hz=8,poles=1",
        "decimation_filter:width_s=0.05,stages=2",
    ] {
        let refuted = diagnosed(folder.path(), &["--filter", given]);
        assert_eq!(
            refuted["verdict"],
            Verdict::Unexplained.name(),
            "{given}: {refuted}"
        );
        assert_eq!(refuted["missing"], serde_json::json!([]), "{given}");
        assert_eq!(refuted["filter"]["fits"], false, "{given}");
        let better = &refuted["filter"]["better"];
        assert_eq!(better["effect"], "low_pass", "{given}");
        assert_near(&better["parameters"]["cutoff_hz"], 8.0, 0.05);
        let text = output(folder.path(), &["diagnose", "log.csv", "--filter", given]);
        assert!(
            text.contains("because the filter does not fit: a low pass (cutoff"),
            "{text}"
        );
    }
}

#[test]
fn every_command_that_fits_a_model_takes_a_filter() {
    let folder = TempDir::new().unwrap();
    record(folder.path(), &[]);
    let filter = ["--filter", "low_pass:cutoff_hz=8,poles=2"];
    let with = |arguments: &[&str]| output(folder.path(), &[arguments, &filter].concat());
    let fitted = with(&["fit", "log.csv"]);
    assert!(
        fitted.contains("behind a low pass (cutoff 8 Hz, time constant 0.01989 s, poles 2)"),
        "{fitted}"
    );
    let said = of_five_terms(" behind the low pass", Some(true), "");
    assert!(fitted.contains(&said), "{fitted}");
    let plain = output(folder.path(), &["fit", "log.csv"]);
    let said = of_five_terms("", Some(false), "a low pass");
    assert!(plain.contains(&said), "{plain}");
    let compared = with(&["compare", "log.csv"]);
    assert!(
        compared.contains("with low pass: cutoff 8 Hz"),
        "{compared}"
    );
    // N of the filtered noise, 0.005 deg/s/√Hz, and not that of the five terms.
    let exported = with(&["export", "log.csv", "--format", "kalibr"]);
    let density = exported
        .lines()
        .find_map(|line| line.strip_prefix("gyroscope_noise_density: "));
    let density: f64 = density
        .and_then(|rest| rest.split(' ').next()?.parse().ok())
        .expect("a density");
    assert!(
        (density / 0.005_f64.to_radians() - 1.0).abs() < 0.03,
        "{density}"
    );
    with(&["report", "log.csv", "--output", "page.html"]);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains(&format!(
        "five terms behind the given low pass are {ADEQUATE}"
    )));
}

/// A moving average that the program of the log took lets everything pass, quantization included. Known, it leaves the five
/// terms; unknown, it is named alone.
#[test]
fn a_moving_average_of_the_whole_output_can_be_known() {
    let folder = TempDir::new().unwrap();
    let average = "moving_average:samples=5";
    let simulate = ["simulate", "mems", "--duration", "655.36", "--effect"];
    output(
        folder.path(),
        &[&simulate[..], &[average, "--output", "log.csv"]].concat(),
    );
    let known = diagnosed(folder.path(), &["--filter", average]);
    assert_eq!(known["verdict"], Verdict::Adequate.name(), "{known}");
    assert_eq!(known["filter"]["fits"], true);
    let fitted = json(folder.path(), &["fit", "log.csv", "--filter", average]);
    let coefficients = fitted["axes"][0]["coefficients"].as_array().unwrap();
    for (symbol, truth) in [("Q", 2e-4), ("N", 5e-3)] {
        let mut found = coefficients.iter();
        let found = found.find(|found| found["symbol"] == symbol).unwrap();
        assert_near(&found["value"], truth, 0.05);
    }
    let unknown = diagnosed(folder.path(), &[]);
    let missing = unknown["missing"].as_array().unwrap();
    assert_eq!(missing.len(), 1, "{missing:?}");
    assert_eq!(missing[0], "moving_average");
}

#[test]
fn what_is_no_filter_is_refused() {
    let folder = TempDir::new().unwrap();
    for (filter, message) in [
        (
            "sinusoid:frequency_hz=1",
            "is no filter on white noise; choose from low_pass, decimation_filter, notch, \
             digital_low_pass, cascade, mode_split, high_pass, output_low_pass, moving_average",
        ),
        (
            "low_pass:poles=2",
            "cutoff_hz or time_constant_s is missing",
        ),
        (
            "low_pass:cutoff_hz=8,poles=5",
            "give a whole number, 1 to 4",
        ),
    ] {
        let refused = refusal(folder.path(), &["fit", "log.csv", "--filter", filter]);
        assert!(refused.contains(message), "{filter}: {refused}");
    }
}

#[test]
fn harmonics_are_said_as_one_comb() {
    let folder = TempDir::new().unwrap();
    let sines = [(6.1, 0.06), (12.2, 0.03), (18.3, 0.02)];
    let sines = sines.map(|(f, a)| format!("sinusoid:frequency_hz={f},amplitude={a}"));
    let effects = sines.iter().flat_map(|sine| ["--effect", sine]);
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "655.36",
        "--output",
        "log.csv",
    ];
    output(
        folder.path(),
        &simulate.into_iter().chain(effects).collect::<Vec<_>>(),
    );
    let found = diagnosed(folder.path(), &[]);
    assert_eq!(
        found["missing"],
        serde_json::json!(["sinusoid", "sinusoid", "sinusoid"])
    );
    let combs = found["combs"].as_array().unwrap();
    assert_eq!(combs.len(), 1);
    assert_eq!(combs[0]["orders"], serde_json::json!([1, 2, 3]));
    assert_near(&combs[0]["fundamental_hz"], 6.1, 1e-3);
    let text = output(folder.path(), &["diagnose", "log.csv"]);
    assert!(text.contains("missing effects: sinusoids (6.1"), "{text}");
    assert!(text.contains(" Hz and 2 harmonics)"), "{text}");
}
