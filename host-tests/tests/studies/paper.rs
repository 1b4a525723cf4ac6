//! A short run of the study of Lv, Liu, Lai & Huang 2015, and the gyros that it simulates. The figures of the
//! manual come from `cargo xtask study paper`.

use allanite_host::simulate::Preset;
use allanite_studies::paper::{self, Estimates, Gyro};
use program::output;
use roxmltree::Document;
use serde_json::Value;
use std::{fs, process::Command};

/// The gyros with Q, N, B, K and R in arcsec, °/√h, °/h, °/h^1.5 and °/h².
const GYROS: [(&str, [f64; 5]); 3] = [
    ("srs2000", [0.01, 0.001, 0.005, 0.01, 0.02]),
    ("vg951", [0.2, 0.015, 0.1, 0.3, 0.5]),
    ("crg20", [5.0, 0.28, 5.0, 20.0, 30.0]),
];

const METHODS: [&str; 5] = [
    "ordinary",
    "accurate part",
    "cluster count",
    "relative accuracy",
    "covariance",
];

fn estimates<'a>(gyro: &'a Gyro, symbol: &str, method: &str) -> &'a Estimates {
    let mut coefficients = gyro.coefficients.iter();
    let coefficient = coefficients
        .find(|one| one.symbol == symbol)
        .expect("known");
    let mut methods = coefficient.methods.iter();
    methods.find(|one| one.method == method).expect("known")
}

/// The means of 40 records lie within 5 standard errors of the truth. Ordinary least squares errs by a
/// multiple of what weighted least squares does, where it is the weight of the values and not the number
/// of clusters that makes the difference.
#[test]
fn weighted_least_squares_beats_ordinary() {
    const RECORDS: u64 = 40;
    let gyro = paper::gyro(Preset::Crg20, RECORDS);
    let rms = |symbol, method| estimates(&gyro, symbol, method).rms_error;
    // In 1000 records, the errors differ by factors of five and more.
    for symbol in ["Q", "N", "B", "K"] {
        let least = 0.5 * rms(symbol, "ordinary");
        assert!(rms(symbol, "covariance") < least, "{symbol}");
        assert!(rms(symbol, "relative accuracy") < least, "{symbol}");
    }
    for symbol in ["B", "K"] {
        let [clusters, values] = ["cluster count", "relative accuracy"].map(|m| rms(symbol, m));
        assert!(values < 0.7 * clusters, "{symbol}");
    }
    assert!(estimates(&gyro, "K", "ordinary").negative > 0.05);
    for coefficient in &gyro.coefficients {
        let covariance = coefficient.methods.last().expect("five methods");
        assert_eq!((covariance.fits, covariance.negative), (40, 0.0));
        let error = covariance.deviation / (RECORDS as f64).sqrt();
        let off = (covariance.mean - coefficient.truth).abs() / error;
        assert!(off < 5.0, "{}: {off} standard errors", coefficient.symbol);
    }
}

#[test]
fn study_prints_every_coefficient_of_every_method_and_draws_a_figure() {
    let folder = tempfile::tempdir().unwrap();
    let figure = folder.path().join("figure.svg");
    let run = Command::new(env!("CARGO_BIN_EXE_study"))
        .args(["paper", "--records", "2", "--json", "--figure"])
        .arg(&figure)
        .output()
        .unwrap();
    assert!(run.status.success(), "{run:?}");
    let document: Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(document["records"], 2);
    assert!(document["truth"].as_str().unwrap().starts_with("assumed "));
    let list = |value: &Value| value.as_array().unwrap().clone();
    let gyros = list(&document["gyros"]);
    assert_eq!(gyros.len(), GYROS.len());
    for (gyro, (name, truths)) in gyros.iter().zip(GYROS) {
        assert_eq!(gyro["name"], name);
        let coefficients = list(&gyro["coefficients"]);
        assert_eq!(coefficients.len(), 5);
        for (coefficient, truth) in coefficients.iter().zip(truths) {
            let found = coefficient["truth"].as_f64().unwrap();
            assert!((found / truth - 1.0).abs() < 1e-12, "{name}: {found}");
            let methods = list(&coefficient["methods"]);
            let names: Vec<&str> = methods
                .iter()
                .map(|m| m["method"].as_str().unwrap())
                .collect();
            assert_eq!(names, METHODS);
            for method in &methods {
                for key in [
                    "mean",
                    "deviation",
                    "rms_error",
                    "rms_error_error",
                    "negative",
                ] {
                    assert!(method[key].as_f64().unwrap() >= 0.0, "{key}: {method}");
                }
                assert_eq!(method["fits"], 2);
            }
        }
    }
    let drawing = fs::read_to_string(&figure).unwrap();
    let drawing = Document::parse(&drawing).unwrap();
    let texts = drawing.descendants().filter(|node| node.is_text());
    let words: Vec<&str> = texts
        .filter_map(|node| node.text())
        .map(str::trim)
        .collect();
    for (name, _) in GYROS {
        let title = format!("{name}: Allan deviation of one record");
        assert!(words.contains(&&*title), "{words:?}");
    }
    for name in METHODS.into_iter().chain(["true"]) {
        assert_eq!(
            words.iter().filter(|word| **word == name).count(),
            3,
            "{name}"
        );
    }
}

#[test]
fn presets_have_the_coefficients_of_their_class() {
    let folder = tempfile::tempdir().unwrap();
    for (name, truths) in GYROS {
        let log = output(folder.path(), &["simulate", name, "--duration", "1s"]);
        let comment = log.lines().next().unwrap();
        // Degrees and seconds in the customary units.
        let factors = [3600.0, 60.0, 3600.0, 216e3, 1296e4];
        let keys = [
            "quantization",
            "angle_random_walk",
            "bias_instability",
            "rate_random_walk",
            "rate_ramp",
        ];
        for ((key, factor), truth) in keys.into_iter().zip(factors).zip(truths) {
            let start = format!("{key}=");
            let found = comment
                .split(' ')
                .find_map(|word| word.strip_prefix(&start));
            let found: f64 = found.unwrap().parse().unwrap();
            assert!(
                (found * factor / truth - 1.0).abs() < 1e-12,
                "{name}: {comment}"
            );
        }
    }
}
