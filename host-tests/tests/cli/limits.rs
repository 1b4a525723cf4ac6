//! `fit --limit`: the verdicts of a station, and the exit status that tells them.

use allanite_host::verdict::{UNDECIDED, UNDECIDED_INVALID};
use program::{ADIS16405, json, number, output, refusal, run};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

/// A record whose white noise is 0.005 °/s/√Hz, and whose random walk is too small to be seen.
fn record(folder: &Path) {
    output(
        folder,
        &[
            "simulate",
            "mems",
            "--seed",
            "3",
            "--duration",
            "300",
            "--output",
            "log.csv",
        ],
    );
}

/// The exit status and the lines on standard output that tell of limits.
fn judged(folder: &Path, arguments: &[&str]) -> (Option<i32>, Vec<String>) {
    let run = run(folder, arguments);
    assert!(
        run.status.code() == Some(2) || run.stderr.is_empty(),
        "{run:?}"
    );
    let text = String::from_utf8(run.stdout).unwrap();
    let lines = text
        .lines()
        .filter(|line| line.contains("limit ") && line.contains('≤'));
    (run.status.code(), lines.map(str::to_owned).collect())
}

#[test]
fn a_mean_rate_is_that_of_the_log_and_keeps_a_limit_or_not() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    // Counts, decimals, and decimals in another unit and far from zero, whose readers take counts from the middle of their range.
    let noise = |n: u32| f64::from(n.wrapping_mul(0x9E37_79B1) >> 24) / 128.0 - 1.0;
    let rows = |value: &dyn Fn(f64) -> String| -> String {
        let lines = (0..4000).map(|n| format!("{}\n", value(noise(n))));
        std::iter::once("gx\n".to_owned()).chain(lines).collect()
    };
    let mean = (0..4000).map(noise).sum::<f64>() / 4000.0;
    let cases: [(String, &[&str], f64); 3] = [
        (
            rows(&|x| format!("{}", (1500.0 + 8.0 * x).round())),
            &["--scale=0.01", "--unit=deg/s"],
            15.0 + 0.08 * mean,
        ),
        (
            rows(&|x| format!("{:.6}", 15.0 + x)),
            &["--unit=deg/s"],
            15.0 + mean,
        ),
        (
            rows(&|x| format!("{:.6}", -0.75 + 0.01 * x)),
            &["--unit=rad/s"],
            -0.75 + 0.01 * mean,
        ),
    ];
    for (text, unit, expected) in cases {
        std::fs::write(folder.join("log.csv"), text).unwrap();
        let about = [&["-q", "fit", "log.csv", "--rate=100"], unit].concat();
        let found = number(&json(folder, &about)["axes"][0]["mean_rate"]);
        assert!((found - expected).abs() < 1e-3, "{found} {expected}");
        for (most, status, word) in [
            (0.9 * expected.abs(), 1, "fail"),
            (1.2 * expected.abs(), 0, "pass"),
        ] {
            let limit = format!("--limit=bias={most}");
            let (found, lines) = judged(folder, &[&about[..], &[&limit]].concat());
            assert_eq!(found, Some(status), "{lines:?}");
            assert!(lines[0].ends_with(word), "{lines:?}");
        }
        // A curve file keeps the mean.
        output(
            folder,
            &[
                &[
                    "-q",
                    "measure",
                    "log.csv",
                    "--rate=100",
                    "--output=curve.json",
                ],
                unit,
            ]
            .concat(),
        );
        let kept = number(&json(folder, &["fit", "curve.json"])["axes"][0]["mean_rate"]);
        assert_eq!(kept.to_bits(), found.to_bits());
    }
    let refused = refusal(folder, &["-q", "lot", "curve.json", "--limit=bias=1"]);
    assert!(
        refused.contains("judge each log by `fit --limit bias=VALUE`"),
        "{refused}"
    );
}

#[test]
fn limits_pass_fail_or_stay_open_and_the_status_says_so() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    record(folder);
    for (limits, status, words) in [
        (&["N=0.4°/√h"][..], 0, &["pass"][..]),
        (&["N=0.006", "B=0.1"], 0, &["pass", "pass"]),
        (&["angle_random_walk=0.2°/√h"], 1, &["fail"]),
        // The customary unit of every keyboard, and a limit that the record cannot show.
        (&["N=0.4deg/sqrth", "K=1e-9"], 3, &["pass", "guard band"]),
        // One limit that is exceeded counts more than one that is open.
        (&["K=1e-9", "N=0.004"], 1, &["guard band", "fail"]),
    ] {
        let mut arguments = vec!["-q", "fit", "log.csv"];
        arguments.extend(limits.iter().flat_map(|limit| ["--limit", limit]));
        let (found, lines) = judged(folder, &arguments);
        assert_eq!(found, Some(status), "{limits:?}: {lines:?}");
        assert_eq!(lines.len(), words.len());
        for (line, word) in lines.iter().zip(words) {
            let (_, verdict) = line.split_once(": ").unwrap();
            assert!(verdict.starts_with(word), "{limits:?}: {line}");
        }
    }
    // The JSON says the same.
    let run = run(
        folder,
        &["-q", "fit", "log.csv", "--json", "--limit", "N=0.2°/√h"],
    );
    assert_eq!(run.status.code(), Some(1));
    let document: Value = serde_json::from_slice(&run.stdout).unwrap();
    let axis = &document["axes"][0];
    assert_eq!(axis["adequate"], true);
    let limit = &axis["limits"][0];
    assert_eq!(limit["verdict"], "fail");
    assert_eq!(limit["unit"], "deg/s/√Hz");
    assert!((limit["most"].as_f64().unwrap() * 60.0 - 0.2).abs() < 1e-9);
}

#[test]
fn the_worst_of_several_files_counts_and_a_bad_file_more() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    record(folder);
    // The model of two axes of the real gyro has other effects as well; no model explains the third.
    let (status, lines) = judged(
        folder,
        &["-q", "fit", "log.csv", ADIS16405, "--limit", "N=1"],
    );
    assert_eq!(status, Some(3), "{lines:?}");
    assert!(
        lines[0].starts_with("log.csv, ") && lines[0].ends_with("pass"),
        "{lines:?}"
    );
    let in_a_model = lines[1..3]
        .iter()
        .all(|line| line.contains("pass (in the model with a "));
    assert!(in_a_model && lines[3].contains(UNDECIDED), "{lines:?}");
    let (status, _) = judged(
        folder,
        &["-q", "fit", "log.csv", "missing.csv", "--limit", "N=1e-9"],
    );
    assert_eq!(status, Some(2));
}

#[test]
fn limits_that_cannot_be_are_refused() {
    let folder = TempDir::new().unwrap();
    let refusal = |limits: &[&str]| {
        let mut arguments = vec!["fit", ADIS16405];
        arguments.extend(limits.iter().flat_map(|limit| ["--limit", limit]));
        refusal(folder.path(), &arguments)
    };
    assert!(refusal(&["N"]).contains("there is no value"));
    assert!(refusal(&["N=1", "angle_random_walk=2"]).contains("has two limits"));
    assert!(refusal(&["sinusoid=1"]).contains("limit Q, N, B, K or R"));
    assert!(refusal(&["N=1 °/h"]).contains("has no such unit"));
}

#[test]
fn a_record_that_is_not_valid_passes_no_limit() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    record(folder);
    // Steps of three times the noise of a sample, which rounding hides.
    let log = std::fs::read_to_string(folder.join("log.csv")).unwrap();
    let rounded = log.lines().map(|line| match line.parse::<f64>() {
        Ok(rate) => format!("{}\n", ((rate + 0.04) / 0.15).round() * 0.15),
        Err(_) => format!("{line}\n"),
    });
    std::fs::write(folder.join("log.csv"), rounded.collect::<String>()).unwrap();
    let arguments = ["-q", "fit", "log.csv", "--limit", "N=1"];
    let (status, lines) = judged(folder, &arguments);
    assert_eq!(status, Some(3), "{lines:?}");
    assert!(lines[0].ends_with(UNDECIDED_INVALID), "{lines:?}");
    let run = run(folder, &[&arguments[..], &["--json"]].concat());
    let document: Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(document["axes"][0]["adequate"], false);
    assert_eq!(document["axes"][0]["limits"][0]["verdict"], "invalid");
}

/// Weak slow noise hides in the five terms: they fit the curve with a p-value of 0.66 and take it for bias instability. A limit
/// is held against the model that has the slow noise.
#[test]
fn a_limit_is_held_against_the_model_that_a_diagnosis_finds() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let simulate = "simulate mems --duration 655.36 --seed 6 --output log.csv";
    let arguments: Vec<&str> = simulate.split(' ').collect();
    let hidden = "gauss_markov:correlation_time_s=1,rms=0.008";
    output(folder, &[&arguments[..], &["--effect", hidden]].concat());
    let limits = ["--limit", "B=0.0065", "--limit", "N=0.006"];
    let fitted = output(
        folder,
        &[&["fit", "--json", "log.csv"][..], &limits].concat(),
    );
    let document: Value = serde_json::from_str(&fitted).unwrap();
    let axis = &document["axes"][0];
    assert!(axis["p_value"].as_f64().unwrap() > 0.5, "{axis}");
    assert_eq!(axis["adequate"], false);
    assert_eq!(axis["missing"], serde_json::json!(["gauss_markov"]));
    // The five terms alone would exceed the limit of B.
    assert!(axis["coefficients"][2]["lower"].as_f64().unwrap() > 0.0065);
    for limit in axis["limits"].as_array().unwrap() {
        assert_eq!(limit["verdict"], "pass", "{limit}");
        assert_eq!(limit["beside"], axis["missing"]);
    }
}
