//! `export` writes the model that the diagnosis finds, and refuses what it cannot explain.

use program::{ADIS16405, json, number, output, refusal};
use saphyr::{LoadableYamlNode, Yaml};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

const RADIANS: f64 = std::f64::consts::PI / 180.0;

/// Writes the log of a gyro beside a fan, whose bias follows the temperature: 2^18 samples at 100 Hz.
fn record(folder: &Path) {
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "2621.44",
        "--axes",
        "1",
        "--seed",
        "12",
        "--effect",
        "sinusoid:frequency_hz=31,amplitude=0.03",
        "--effect",
        "gauss_markov:correlation_time_s=5,rms=0.02",
        "--effect",
        "thermal:slope=0.02,kelvin=5,period_s=800",
        "--output",
        "log.csv",
    ];
    output(folder, &simulate);
}

fn exported(folder: &Path, more: &[&str]) -> Value {
    let export = ["export", "log.csv", "--format", "json"];
    let text = output(folder, &[&export[..], more].concat());
    let mut document: Value = serde_json::from_str(&text).unwrap();
    document["axes"][0].take()
}

/// The coefficient of the last model of a diagnosis, in radians and seconds.
fn last_coefficient(folder: &Path, symbol: &str) -> [f64; 3] {
    let diagnosed = json(folder, &["diagnose", "log.csv"]);
    let steps = diagnosed["axes"][0]["steps"].as_array().unwrap().clone();
    let last = steps.last().unwrap()["coefficients"].as_array().unwrap();
    let one = last.iter().find(|one| one["symbol"] == symbol).unwrap();
    ["value", "lower", "upper"].map(|name| RADIANS * number(&one[name]))
}

fn close(value: f64, expected: f64) -> bool {
    (value / expected - 1.0).abs() < 1e-9
}

#[test]
fn filter_gets_what_the_diagnosis_finds() {
    let folder = TempDir::new().unwrap();
    record(folder.path());
    let axis = exported(folder.path(), &[]);
    let [density, lower, upper] = last_coefficient(folder.path(), "N");
    assert!(close(number(&axis["noise_density"]), density), "{axis:#}");
    // The preset's N is 0.005 °/s/√Hz.
    let truth = 0.005 * RADIANS;
    assert!((lower..=upper).contains(&truth), "{lower} {upper}");
    // The five terms have no place for any of it.
    let five = exported(folder.path(), &["--model", "five-terms"]);
    assert_eq!([&five["adequate"], &axis["adequate"]], [false, true]);
    assert_eq!(five["processes"].as_array().unwrap().len(), 0);

    let notches = axis["notches"].as_array().unwrap();
    assert_eq!(notches.len(), 1, "{axis:#}");
    assert!((number(&notches[0]["frequency_hz"]) - 31.0).abs() < 0.05);
    assert!((number(&notches[0]["value"]) / (0.03 * RADIANS) - 1.0).abs() < 0.05);
    let processes = axis["processes"].as_array().unwrap();
    assert_eq!(processes.len(), 1, "{axis:#}");
    let within = |name: [&str; 2], truth: f64| {
        let [lower, upper] = name.map(|name| number(&processes[0][name]));
        assert!((lower..=upper).contains(&truth), "{processes:?}");
    };
    within(["sigma_lower", "sigma_upper"], 0.02 * RADIANS);
    within(
        ["correlation_time_lower_s", "correlation_time_upper_s"],
        5.0,
    );
    let subtract = axis["subtract"].as_array().unwrap();
    assert!(!subtract.is_empty(), "{axis:#}");
    let slope = subtract.iter().find(|one| one["kind"] == "column").unwrap();
    assert!((number(&slope["slope"]) / (0.02 * RADIANS) - 1.0).abs() < 0.05);
    assert!(number(&slope["reference"]).is_finite());
    // A filter without a state for the process gets a walk that changes as fast.
    let [sigma, time_s] = ["sigma", "correlation_time_s"].map(|name| number(&processes[0][name]));
    let driven = sigma * (2.0 / time_s).sqrt();
    assert!(number(&axis["random_walk_alone"]) >= driven * (1.0 - 1e-12));
}

#[test]
fn every_format_has_the_same_numbers_first_and_where_they_come_from_below() {
    let folder = TempDir::new().unwrap();
    record(folder.path());
    let axis = exported(folder.path(), &[]);
    let (density, walk) = (
        number(&axis["noise_density"]),
        number(&axis["random_walk_alone"]),
    );
    let export = |format: &str| {
        let text = output(folder.path(), &["export", "log.csv", "--format", format]);
        let lines: Vec<&str> = text.lines().collect();
        let about = lines
            .iter()
            .position(|line| line.contains("Noise of a gyro"))
            .unwrap();
        let is_number = |line: &&str| line.contains("best fit") || line.contains("_RATE_HZ");
        let first = lines.iter().position(is_number).unwrap();
        assert!(first < about, "{text}");
        assert!(text.contains("notch at 31.0"), "{text}");
        assert!(text.contains("subtract "), "{text}");
        text
    };
    let rest = |text: &str| text.strip_prefix("%YAML:1.0\n").unwrap_or(text).to_owned();
    let float = |node: &Yaml<'_>| {
        node.as_floating_point()
            .unwrap_or_else(|| panic!("{node:?}"))
    };

    let text = rest(&export("vins-fusion"));
    let file = &Yaml::load_from_str(&text).unwrap()[0];
    assert!(close(float(&file["gyr_n"]), density * 200_f64.sqrt()));
    assert!(close(float(&file["gyr_w"]), walk * 10.0));

    let text = export("lio-sam");
    let file = &Yaml::load_from_str(&text).unwrap()[0]["lio_sam"];
    assert!(close(float(&file["imuGyrNoise"]), density));
    assert!(close(float(&file["imuGyrBiasN"]), walk));

    let text = export("kf-gins");
    let file = &Yaml::load_from_str(&text).unwrap()[0]["imunoise"];
    // The bias follows a process and more: one process as long as the record changes as fast as all of them.
    let length_s = 2621.44_f64;
    for place in 0..3 {
        assert!(close(float(&file["arw"][place]), density * 60.0 / RADIANS));
        let sigma = walk * (length_s / 2.0).sqrt() * 3600.0 / RADIANS;
        assert!(close(float(&file["gbstd"][place]), sigma));
    }
    assert!(close(float(&file["corrtime"]), length_s / 3600.0));

    let text = export("ros");
    let file = &Yaml::load_from_str(&text).unwrap()[0]["angular_velocity_covariance"];
    for place in 0..9 {
        let expected = if place % 4 == 0 {
            density * density * 100.0
        } else {
            0.0
        };
        assert!((float(&file[place]) - expected).abs() <= 1e-9 * density * density);
    }

    let text = export("gtsam");
    let set = |member: &str| -> f64 {
        let start = format!("    params.{member}(");
        let line = text.lines().find_map(|line| line.strip_prefix(&start));
        let line = line.unwrap_or_else(|| panic!("{member}: {text}"));
        line.split_once(" * np.eye(3))").unwrap().0.parse().unwrap()
    };
    assert!(close(set("setGyroscopeCovariance"), density * density));
    assert!(close(set("setBiasOmegaCovariance"), walk * walk));
    for format in ["kalibr", "openvins", "px4", "ardupilot", "c"] {
        export(format);
    }
}

#[test]
fn what_no_model_explains_is_refused_unless_it_is_told() {
    let folder = Path::new(".");
    let export = ["export", ADIS16405, "--format", "kalibr"];
    let refused = refusal(folder, &export);
    assert!(
        refused.contains("axis gz: the diagnosis leaves something unexplained: the spectrum is"),
        "{refused}"
    );
    for remedy in ["--despite-unexplained", "--model five-terms"] {
        assert!(refused.contains(remedy), "{refused}");
        let told: Vec<&str> = remedy.split(' ').collect();
        let text = output(folder, &[&export[..], &told].concat());
        assert!(text.contains("gyroscope_noise_density: "), "{text}");
    }
}

#[test]
fn a_model_of_ones_own_is_exported_and_contradicting_options_are_refused() {
    let folder = TempDir::new().unwrap();
    record(folder.path());
    let with = ["--with", "sinusoid", "--without", "rate_ramp"];
    let axis = exported(folder.path(), &with);
    assert_eq!(axis["notches"].as_array().unwrap().len(), 1, "{axis:#}");
    assert_eq!(axis["processes"].as_array().unwrap().len(), 0);
    let symbols = axis["coefficients"].as_array().unwrap().iter();
    assert!(!symbols.map(|one| &one["symbol"]).any(|one| one == "R"));
    let export = ["export", "log.csv", "--format", "json"];
    let both = [&export[..], &with, &["--model", "diagnosed"]].concat();
    assert_eq!(
        refusal(folder.path(), &both),
        "--model names another model than --with and --without; drop --model, or the others"
    );
}
