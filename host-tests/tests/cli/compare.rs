//! Tests `compare`: models with and without effects are compared with the curve they were fitted
//! to, or with another.

use program::{ADIS16405, json, number, output, refusal, rows};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// A folder with a log of 2^16 samples at 100 Hz that contains a sinusoid.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let effect = "sinusoid:frequency_hz=7.7,amplitude=0.03";
    let simulate = ["simulate", "mems", "--duration", "655.36", "--seed", "2"];
    let more = ["--effect", effect, "--output", "log.csv"];
    output(folder.path(), &[&simulate[..], &more].concat());
    folder
}

#[test]
fn adding_the_missing_effect_removes_its_misfit_from_the_octaves() {
    let folder = folder();
    let without = json(folder.path(), &["compare", "log.csv"]);
    let with = "sinusoid:frequency_hz=7.7";
    let with = json(folder.path(), &["compare", "log.csv", "--with", with]);
    let (without, with) = (&without["axes"][0], &with["axes"][0]);
    assert!(number(&without["chi2"]) > 300.0);
    assert!(number(&without["p_value"]) < 1e-6);
    assert!(number(&with["p_value"]) > 0.01);
    assert!(number(&with["rms_percent"]) < number(&without["rms_percent"]));
    let worst = &without["worst"];
    assert!((0.02..0.2).contains(&number(&worst["tau_s"])), "{worst}");
    assert!(!without["stretches"].as_array().unwrap().is_empty());
    let effects = with["effects"].as_array().unwrap();
    let amplitude = number(&effects[5]["parameters"]["amplitude"]);
    assert!((amplitude / 0.03 - 1.0).abs() < 0.03, "{amplitude}");
    for octave in with["octaves"].as_array().unwrap() {
        let shares = octave["shares"].as_object().unwrap();
        let sum: f64 = shares.values().map(number).sum();
        assert!((sum - 1.0).abs() < 1e-6 && shares.len() == 6);
        let percent =
            100.0 * ((number(&octave["measured"]) / number(&octave["model"])).powi(2) - 1.0);
        assert!((percent - number(&octave["percent"])).abs() < 1e-6);
    }
}

#[test]
fn effect_takes_the_place_of_what_it_replaces() {
    let filter = "decimation_filter:width_s=0.0143,stages=2";
    let arguments = [
        "compare",
        ADIS16405,
        "--with",
        filter,
        "--without",
        "rate_ramp",
    ];
    let document = json(Path::new("."), &arguments);
    for axis in document["axes"].as_array().unwrap() {
        let names: Vec<&str> = axis["effects"]
            .as_array()
            .unwrap()
            .iter()
            .map(|effect| effect["name"].as_str().unwrap())
            .collect();
        let expected = [
            "quantization",
            "decimation_filter",
            "bias_instability",
            "rate_random_walk",
        ];
        assert_eq!(names, expected);
    }
    assert!(number(&document["axes"][0]["p_value"]) > 0.01);
}

#[test]
fn held_out_part_judges_the_fit_to_the_first_part() {
    let folder = folder();
    let arguments = ["compare", "log.csv", "--hold-out", "0.25"];
    let document = json(folder.path(), &arguments);
    let axis = &document["axes"][0];
    let held_out = &axis["held_out"];
    assert_eq!(held_out["samples"], 16_384);
    assert_eq!(held_out["fitted"]["samples"], 49_152);
    // The held-out part loses no degree of freedom, because no coefficient was fitted to it: there are two levels of
    // the spectrum, and the octaves from the 8 blocks of the longer one on.
    let long = |octave: &&Value| number(&octave["m"]) >= 64.0;
    let octaves = axis["octaves"].as_array().unwrap();
    assert_eq!(axis["dof"], 2 * 28 + octaves.iter().filter(long).count());
    assert!(number(&axis["p_value"]) < 1e-3);
    let with = ["--with", "sinusoid:frequency_hz=7.7"];
    let better = json(folder.path(), &[&arguments[..], &with].concat());
    let better = &better["axes"][0];
    assert!(number(&better["chi2"]) < 0.3 * number(&axis["chi2"]));
    assert!(number(&better["p_value"]) > 1e-3);
    let text = output(folder.path(), &arguments);
    assert!(text.contains("held out"), "{text}");
}

#[test]
fn text_and_json_agree() {
    let text = output(Path::new("."), &["compare", ADIS16405]);
    let document = json(Path::new("."), &["compare", ADIS16405]);
    for axis in document["axes"].as_array().unwrap() {
        let name = axis["axis"].as_str().unwrap();
        let words = axis["words"].as_str().unwrap();
        assert!(text.contains(&format!("\n{name}: {words}\n")), "{words}");
        let worst = &axis["worst"];
        let percent = format!("measured is {:.0} % ", number(&worst["percent"]).abs());
        assert!(words.starts_with(&percent), "{words}");
        let sigmas = format!("({:.0} σ)", number(&worst["z"]).abs());
        assert!(words.contains(&sigmas), "{words}");
        let sum = format!(
            "{name}: χ² {:.1}, {} degrees of freedom",
            number(&axis["chi2"]),
            axis["dof"]
        );
        assert!(text.contains(&sum), "{sum}");
    }
}

#[test]
fn effects_without_parameters_are_fitted() {
    let folder = folder();
    let compared = |with: &[&str]| {
        let with = with.iter().flat_map(|with| ["--with", *with]);
        let arguments: Vec<&str> = ["compare", "log.csv"].into_iter().chain(with).collect();
        json(folder.path(), &arguments)["axes"][0].clone()
    };
    let frequency_hz = |axis: &Value| number(&axis["effects"][5]["parameters"]["frequency_hz"]);
    let known = compared(&["sinusoid:frequency_hz=7.7"]);
    let fitted = compared(&["sinusoid"]);
    assert!((frequency_hz(&fitted) / 7.7 - 1.0).abs() < 1e-3);
    // A shape that is fitted costs a degree of freedom. Its χ² is the least, up to what the search calls settled.
    assert_eq!(number(&fitted["dof"]), number(&known["dof"]) - 1.0);
    assert!(number(&fitted["chi2"]) < number(&known["chi2"]) + 0.5);
    for factor in [0.999, 0.9997, 1.0003, 1.001] {
        let near = format!("sinusoid:frequency_hz={}", factor * frequency_hz(&fitted));
        let near = number(&compared(&[&near])["chi2"]);
        assert!(near > number(&fitted["chi2"]) - 0.5, "{factor}: {near}");
    }
    // From a start nearby, the same minimum is found.
    let from = compared(&["sinusoid:frequency_hz~7.6"]);
    assert!((frequency_hz(&from) / frequency_hz(&fitted) - 1.0).abs() < 1e-4);
    // The diagnosis finds the same line.
    let diagnosis = json(folder.path(), &["diagnose", "log.csv"]);
    let steps = diagnosis["axes"][0]["steps"].as_array().unwrap();
    let found = frequency_hz(&steps[steps.len() - 1]);
    assert!(
        (frequency_hz(&fitted) / found - 1.0).abs() < 5e-4,
        "{found}"
    );
    // Two lines, and a filter of which the poles are known.
    let both = compared(&["sinusoid", "sinusoid:frequency_hz=1", "low_pass:poles=2"]);
    let names = both["effects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|effect| &effect["name"]);
    let names: Vec<&str> = names.map(|name| name.as_str().unwrap()).collect();
    assert_eq!(names[1], "low_pass");
    assert_eq!(names[5..], ["sinusoid"; 2]);
    assert_eq!(both["effects"][1]["parameters"]["poles"], 2.0);
    for octave in both["octaves"].as_array().unwrap() {
        let shares: f64 = octave["shares"]
            .as_object()
            .unwrap()
            .values()
            .map(number)
            .sum();
        assert!((shares - 1.0).abs() < 1e-6);
    }
    let text = output(folder.path(), &["compare", "log.csv", "--with", "sinusoid"]);
    assert!(
        text.contains("with sinusoid: frequency 7.7") && text.contains(" … "),
        "{text}"
    );
}

#[test]
fn impossible_questions_are_refused() {
    let folder = folder();
    for (arguments, message) in rows! {
        &["--with", "sinusiod"][..], "no such effect; did you mean sinusoid? choose from quantization, ";
        &["--with", "sinusoid:frequency=1"],
            "there is no parameter \"frequency\"; did you mean frequency_hz? choose from frequency_hz";
        &["--with", "resonance:frequency_hz~1,quality=2"], "frequency_hz is to be fitted, and quality is not";
        &["--with", "low_pass:cutoff_hz~20,poles~2"], "poles is a whole number, which is not fitted";
        &["--filter", "low_pass:cutoff_hz~20"], "cutoff_hz is not fitted here; write cutoff_hz=VALUE";
        &["--with", "sinusoid:frequency_hz=0"], "frequency_hz=0 is impossible";
        &["--with", "sinusoid:frequency_hz=1,amplitude=1"], "amplitude is fitted, not given";
        &["--with", "sinusoid:frequency_hz=100"], "the effect is invisible at a sample rate of 100 Hz";
        &["--with", "resonance:frequency_hz=1"], "quality is missing";
        &["--with", "rate_ramp"], "is in the model already";
        &["--without", "sinusoid"], "not in the model; choose from quantization, ";
        &["--hold-out", "1"], "--hold-out 1 is impossible";
        &["--hold-out", "-0.5"], "--hold-out -0.5 is impossible";
        &["--hold-out", "0.99999"], "1 sample is too few: two octaves need 9";
    } {
        let arguments = [&["compare", "log.csv"], arguments].concat();
        let refused = refusal(folder.path(), &arguments);
        assert!(refused.contains(message), "{arguments:?}: {refused}");
    }
    let refused = refusal(folder.path(), &["compare", ADIS16405, "--hold-out", "0.5"]);
    assert!(
        refused.contains("a curve file cannot be divided"),
        "{refused}"
    );
    let without = [
        "quantization",
        "angle_random_walk",
        "bias_instability",
        "rate_random_walk",
        "rate_ramp",
    ]
    .map(|name| ["--without", name])
    .concat();
    let refused = refusal(
        folder.path(),
        &[&["compare", "log.csv"], &without[..]].concat(),
    );
    assert!(
        refused.contains("the model has no effects left"),
        "{refused}"
    );
}
