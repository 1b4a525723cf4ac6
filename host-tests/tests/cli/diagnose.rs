//! Tests `diagnose`: it names hidden effects, explains real gyros, and prints the same in words and
//! in JSON.

use allanite::{
    Model,
    diagnosis::{Options, Step, Verdict, alternative},
    effect::CATALOGUE,
};
use allanite_host::{
    curve_file::CurveFile, diagnosis::diagnose, number::probability, verdict::sentence,
};
use allanite_log::OCTAVES;
use program::{ADIS16405, json, number, output, refusal, rows};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

const MPU6050: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/mpu6050.json");

fn names(value: &Value) -> Vec<&str> {
    let list = value.as_array().unwrap();
    list.iter().map(|name| name.as_str().unwrap()).collect()
}

fn steps(axis: &Value) -> (&Value, &Value) {
    let steps = axis["steps"].as_array().unwrap();
    (&steps[0], &steps[steps.len() - 1])
}

/// The parameters of an effect in a step.
fn parameters<'a>(step: &'a Value, name: &str) -> Option<&'a Value> {
    let effects = step["effects"].as_array().unwrap();
    let effect = effects.iter().find(|effect| effect["name"] == name)?;
    Some(&effect["parameters"])
}

/// Writes the log of a consumer gyro, 2^16 samples at 100 Hz, with hidden effects.
fn hide(folder: &Path, seed: &str, effects: &[&str]) {
    let simulate = ["simulate", "mems", "--duration", "655.36", "--seed", seed];
    let mut arguments = [&simulate[..], &["--output", "log.csv"]].concat();
    for effect in effects {
        arguments.extend(["--effect", effect]);
    }
    output(folder, &arguments);
}

#[test]
fn hidden_effect_is_named_with_its_shape_and_size() {
    let folder = TempDir::new().unwrap();
    for (effect, strong) in [
        ("sinusoid:frequency_hz=7.7,amplitude=0.02", true),
        ("gauss_markov:correlation_time_s=1,rms=0.04", true),
        ("resonance:frequency_hz=3,quality=3,rms=0.02", true),
        ("low_pass:time_constant_s=0.02", false),
        ("decimation_filter:width_s=0.03,stages=2", true),
        ("random_telegraph:correlation_time_s=1,rms=0.03", false),
        ("power_law:exponent=0.7,deviation_at_one_second=0.03", true),
        ("power_law:exponent=1.3,deviation_at_one_second=0.1", false),
    ] {
        hide(folder.path(), "11", &[effect]);
        let document = json(folder.path(), &["diagnose", "log.csv"]);
        let axis = &document["axes"][0];
        let (first, last) = steps(axis);
        let (name, shape) = effect.split_once(':').unwrap();
        let missing = names(&axis["missing"]);
        let ambiguous = names(&axis["ambiguous"]);
        assert!(
            missing.contains(&name) || ambiguous.contains(&name),
            "{name}: {missing:?}, {ambiguous:?}"
        );
        let excess = |step: &Value| number(&step["chi2"]) - number(&step["dof"]);
        assert!(excess(last) < 0.5 * excess(first), "{name}");
        assert_eq!(first["added"].as_str(), Some(missing[0]));
        assert_eq!(axis["verdict"], Verdict::Improved.name());
        let Some(found) = parameters(last, name).filter(|_| strong) else {
            assert!(!strong, "{name}: {missing:?}");
            continue;
        };
        for pair in shape.split(',') {
            let (parameter, truth) = pair.split_once('=').unwrap();
            let (found, truth) = (number(&found[parameter]), truth.parse::<f64>().unwrap());
            // Three or more standard errors of each. If a filter spans only a few samples, its number of stages cannot be
            // determined.
            let within = match (name, parameter) {
                ("sinusoid", "frequency_hz") => 0.002,
                ("resonance", "frequency_hz") => 0.06,
                ("sinusoid", "amplitude") => 0.1,
                (_, "stages") => f64::INFINITY,
                (_, "exponent") => 0.05,
                ("decimation_filter", _) => 0.1,
                _ => 0.25,
            };
            assert!(
                (found / truth - 1.0).abs() < within,
                "{name}: {parameter} {found} instead of {truth}"
            );
        }
    }
}

#[test]
fn no_effect_is_found_where_none_is_hidden() {
    let folder = TempDir::new().unwrap();
    hide(folder.path(), "3", &[]);
    let document = json(folder.path(), &["diagnose", "log.csv"]);
    let axis = &document["axes"][0];
    assert_eq!(axis["verdict"], Verdict::Adequate.name());
    assert_eq!(axis["steps"].as_array().unwrap().len(), 1);
    assert!(names(&axis["missing"]).is_empty() && names(&axis["ambiguous"]).is_empty());
    assert!(axis["steps"][0]["added"].is_null());
    let text = output(folder.path(), &["diagnose", "log.csv"]);
    let p = probability(number(&axis["steps"][0]["p_value"]));
    let said = format!("gx: {}", sentence::adequate("five terms", &p));
    assert!(text.contains(&said), "{text}");
}

#[test]
fn an_adequate_record_says_what_it_would_have_shown() {
    let folder = TempDir::new().unwrap();
    hide(folder.path(), "3", &[]);
    let document = json(folder.path(), &["diagnose", "log.csv"]);
    let limits = document["axes"][0]["detection_limits"].as_array().unwrap();
    let text = output(folder.path(), &["diagnose", "log.csv"]);
    let (_, list) = text.split_once("the record would have shown with").unwrap();
    assert_eq!(
        list.lines().filter(|line| line.starts_with("  ")).count(),
        limits.len()
    );
    let of = |name: &str| {
        let limits = limits.iter().filter(|limit| limit["effect"] == name);
        limits.collect::<Vec<_>>()
    };
    for limit in of("sinusoid") {
        assert_eq!(limit["limited"], "amplitude");
        assert_eq!(limit["unit"], "deg/s");
        let shapes = limit["shapes"].as_array().unwrap();
        let largest = shapes.iter().map(|shape| number(&shape["amplitude"]));
        assert_eq!(largest.fold(0.0, f64::max), number(&limit["limit"]));
        let ends = &limit["frequency_hz"];
        assert!(number(&ends[0]) <= number(&ends[1]));
        assert_eq!(ends[0], shapes[0]["frequency_hz"]);
    }
    // A line of 0.02 deg/s at 7.7 Hz is found, and one of 0.002 deg/s is not.
    let near = of("sinusoid")
        .into_iter()
        .find(|limit| number(&limit["frequency_hz"][1]) > 7.7);
    let near = number(&near.unwrap()["limit"]);
    assert!((0.005..0.015).contains(&near), "{near}");
    let filter = of("low_pass");
    assert_eq!(filter.len(), 1);
    assert_eq!(filter[0]["limited"], "time_constant_s");
    assert!((0.003..0.02).contains(&number(&filter[0]["limit"])));

    // An inadequate record says nothing of the kind.
    let line = "sinusoid:frequency_hz=7.7,amplitude=0.02";
    hide(folder.path(), "11", &[line]);
    let text = output(
        folder.path(),
        &["diagnose", "log.csv", "--max-effects", "0"],
    );
    assert!(!text.contains("would have shown"), "{text}");
}

#[test]
fn no_more_effects_are_added_than_allowed() {
    let folder = TempDir::new().unwrap();
    hide(
        folder.path(),
        "11",
        &["sinusoid:frequency_hz=7.7,amplitude=0.02"],
    );
    let document = json(
        folder.path(),
        &["diagnose", "log.csv", "--max-effects", "0"],
    );
    assert_eq!(document["axes"][0]["verdict"], Verdict::Unexplained.name());
    let document = json(
        folder.path(),
        &["diagnose", ADIS16405, "--max-effects", "1"],
    );
    for axis in document["axes"].as_array().unwrap() {
        assert_eq!(names(&axis["missing"]).len(), 1);
    }
}

#[test]
fn filter_of_a_real_gyro_is_found_and_an_oscillation_on_one_axis() {
    let document = json(Path::new("."), &["diagnose", ADIS16405]);
    for axis in document["axes"].as_array().unwrap() {
        let name = axis["axis"].as_str().unwrap();
        let (first, last) = steps(axis);
        let found = [names(&axis["missing"]), names(&axis["ambiguous"])].concat();
        assert!(found.contains(&"decimation_filter"), "{name}: {found:?}");
        assert!(
            number(&first["chi2"]) >= 50.0 * number(&last["chi2"]),
            "{name}"
        );
        if name == "gz" {
            // Its frequency moves while the gyro warms up.
            let line = ["drifting_sinusoid", "drifting_resonance"]
                .into_iter()
                .find_map(|effect| parameters(last, effect));
            let frequency_hz = number(&line.unwrap()["frequency_hz"]);
            assert!((19.0..=20.2).contains(&frequency_hz), "{frequency_hz}");
        } else {
            assert!(number(&last["p_value"]) >= 0.001, "{name}");
        }
    }
}

#[test]
fn second_real_gyro_has_lines_on_two_axes_and_is_adequate_on_the_third() {
    let document = json(Path::new("."), &["diagnose", MPU6050]);
    let axes = document["axes"].as_array().unwrap();
    assert_eq!(axes[1]["verdict"], Verdict::Adequate.name());
    // The octaves do not show the line of the first axis, and that of the last one no better than to 10 %.
    // Beside its line, the last axis has something broad.
    for (axis, line_hz) in [(0, 20.0), (2, 31.35)] {
        assert_eq!(axes[axis]["verdict"], Verdict::Improved.name());
        let (_, last) = steps(&axes[axis]);
        let frequency_hz = number(&parameters(last, "sinusoid").unwrap()["frequency_hz"]);
        assert!((frequency_hz - line_hz).abs() < 0.1, "{frequency_hz}");
    }
    let notes = axes[2]["notes"].to_string();
    assert!(notes.contains("alias"), "{notes}");
}

#[test]
fn text_and_json_agree() {
    let document = json(Path::new("."), &["diagnose", ADIS16405]);
    let text = output(Path::new("."), &["diagnose", ADIS16405]);
    for axis in document["axes"].as_array().unwrap() {
        let steps = axis["steps"].as_array().unwrap();
        for (number_of_step, pair) in steps.windows(2).enumerate() {
            let added = pair[0]["added"].as_str().unwrap().replace('_', " ");
            let added = added.replace("gauss markov", "Gauss–Markov");
            let line = format!(
                "{}. + {added}: χ² {:.1} → {:.1}, p",
                number_of_step + 1,
                number(&pair[0]["error"]),
                number(&pair[1]["error"])
            );
            assert!(text.contains(&line), "{line}");
        }
        for note in names(&axis["notes"]) {
            assert!(text.contains(note), "{note}");
        }
        let name = axis["axis"].as_str().unwrap();
        assert!(
            text.contains(&format!("\n{name}: missing effect")),
            "{name}"
        );
    }
    for words in ["what it is:", "where it comes from:", "what to check:"] {
        assert!(text.contains(words), "{words}");
    }
}

#[test]
fn temperature_column_of_a_record_is_not_taken_as_an_axis() {
    let folder = TempDir::new().unwrap();
    for (course, at_the_end) in [("time_s=600", 31.64), ("period_s=1200", 25.0)] {
        let effect = format!("thermal:slope=0.01,kelvin=10,{course}");
        hide(folder.path(), "5", &[&effect]);
        let log = std::fs::read_to_string(folder.path().join("log.csv")).unwrap();
        let rows: Vec<&str> = log.lines().collect();
        assert!(rows[0].starts_with("# ") && rows[0].ends_with(&format!("effect={effect}")));
        assert_eq!(rows[1], "gx,temp_C");
        let last = rows.last().unwrap().split(',').nth(1).unwrap();
        let last: f64 = last.parse().unwrap();
        assert!((last - at_the_end).abs() < 3.0, "{course}: {last}");
        let document = json(folder.path(), &["diagnose", "log.csv"]);
        let axes = document["axes"].as_array().unwrap();
        assert_eq!(axes.len(), 1);
        assert_eq!(axes[0]["axis"], "gx");
    }
}

#[test]
fn effects_that_cannot_be_hidden_are_refused() {
    let folder = TempDir::new().unwrap();
    for (effect, message) in rows! {
        "sinusiod:frequency_hz=1,amplitude=1", "no such effect; choose from gauss_markov, ";
        "rate_ramp:rate_ramp=1", "is one of the five terms; give --rate-ramp";
        "sinusoid:frequency_hz=1", "amplitude is missing";
        "gauss_markov:rms=1", "correlation_time_s is missing";
        "gauss_markov:rms=1,correlation_time_s=-1", "correlation_time_s=-1 is impossible";
        "low_pass:time_constant_s=0", "time_constant_s=0 is impossible";
        "low_pass:time_constant_s=1,rms=1", "there is no parameter \"rms\"";
        "thermal:kelvin=5,time_s=1", "slope is missing";
        "thermal:slope=1,kelvin=5", "a temperature needs either time_s or period_s";
        "thermal:slope=1,kelvin=5,time_s=1,period_s=1", "a temperature needs either time_s or period_s";
    } {
        let refused = refusal(folder.path(), &["simulate", "mems", "--effect", effect]);
        assert!(refused.contains(message), "{effect}: {refused}");
    }
    let two = ["low_pass:time_constant_s=1", "decimation_filter:width_s=1"];
    let arguments = ["simulate", "mems", "--effect", two[0], "--effect", two[1]];
    let refused = refusal(folder.path(), &arguments);
    assert!(refused.contains("two filters"), "{refused}");
    let thermal = "thermal:slope=1,kelvin=5,time_s=1";
    let array = [
        "simulate", "mems", "--effect", thermal, "--output", "log.npy",
    ];
    let refused = refusal(folder.path(), &array);
    assert!(
        refused.contains("columns of an array have no names"),
        "{refused}"
    );
    assert!(!folder.path().join("log.npy").exists());
}

#[test]
fn alternatives_fitted_in_full_agree_with_the_candidates_of_the_search() {
    let curves = CurveFile::read(Path::new(ADIS16405)).unwrap();
    let (mut compared, mut others) = (0, 0);
    for axis in &curves.axes {
        let curve = axis.curve().unwrap();
        let mut steps: Vec<Step<OCTAVES>> = Vec::new();
        let (model, options) = (Model::ieee_952(), Options::default());
        diagnose(&curve, &model, &CATALOGUE, options, |step| {
            steps.push(step.clone());
        })
        .unwrap();
        for (at, step) in steps.iter().enumerate() {
            for (place, candidate) in step.candidates.iter().enumerate() {
                let other = alternative(&curve, step, candidate).unwrap();
                let chi_squared = other.fit.chi_squared;
                // The shapes of a candidate are those of the last model, or of another model of the whole record. Fitted
                // beside the step's model alone, they come no further from the record.
                let most = candidate.chi_squared + 1.0;
                assert!(chi_squared < most, "{chi_squared} above {most}");
                compared += 1;
                if place > 0 {
                    others += 1;
                    continue;
                }
                let next = &steps[at + 1].fit;
                assert!(chi_squared < next.chi_squared + 1.0, "{chi_squared}");
                let names = |step: &Step<OCTAVES>| -> Vec<&str> {
                    let terms = step.model.terms().iter();
                    terms.map(|term| term.effect.name()).collect()
                };
                assert_eq!(names(&other), names(&steps[at + 1]));
            }
        }
    }
    assert!(compared >= 3 && others >= 1, "{compared}, {others}");
}

/// A gyro that stood in four positions, each with its own part of the earth's rate: the random walk that follows it is 25 times
/// too high at the longest averaging times. χ² of the residuals says nothing of that (77, p = 0.83), and would rise to 148 with
/// Gauss–Markov noise; the deviance falls.
#[test]
fn a_model_that_is_too_high_is_not_adequate_and_what_is_added_lowers_the_error() {
    let four = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/fixtures/four-positions.json"
    );
    let document = json(Path::new("."), &["diagnose", four]);
    let axis = &document["axes"][0];
    let steps = axis["steps"].as_array().unwrap();
    let errors: Vec<f64> = steps.iter().map(|step| number(&step["chi2"])).collect();
    assert_eq!(errors[0], number(&steps[0]["deviance"]), "{axis}");
    assert!(
        errors[0] > 250.0 && number(&steps[0]["p_value"]) < 1e-15,
        "{axis}"
    );
    assert!(
        errors.len() > 1 && errors.is_sorted_by(|one, next| one > next),
        "{axis}"
    );
    assert_eq!(axis["verdict"], Verdict::Incomplete.name());
}

/// Gauss–Markov noise of 3 s and 0.018 deg/s behind a filter of three poles and a line of 7.1 Hz, without a random walk. The filter
/// is found behind another one by crossing; what the white noise behind it still hides has to be looked for as well.
#[test]
fn slow_noise_behind_a_filter_and_a_line_is_not_taken_for_a_random_walk() {
    let three = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/fixtures/low-pass-line-gauss-markov.json"
    );
    let document = json(Path::new("."), &["diagnose", three]);
    let axis = &document["axes"][0];
    assert_eq!(
        names(&axis["missing"]),
        ["digital_low_pass", "sinusoid", "gauss_markov"]
    );
    assert_eq!(axis["verdict"], Verdict::Improved.name());
    let (_, last) = steps(axis);
    let time_s = number(&parameters(last, "gauss_markov").unwrap()["correlation_time_s"]);
    assert!((2.2..4.5).contains(&time_s), "{time_s}");
    let coefficients = last["coefficients"].as_array().unwrap();
    let walk = coefficients
        .iter()
        .find(|one| one["symbol"] == "K")
        .unwrap();
    assert_ne!(walk["state"], "measured", "{walk}");
}
