//! Tests `lot`: what it says of 500 devices follows from their certificates alone.

use allanite::{
    Accumulator, Model, Scale,
    fit::{Options, fit},
    storage::{AxisCertificate, Certificate, Conditions, RateUnit},
};
use host_tests::{
    program::{command, json, refusal},
    simulate::{Coefficients, Preset, Random, Simulator},
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde_json::Value;
use std::{collections::BTreeSet, fs, path::Path};
use tempfile::TempDir;

const DEVICES: u64 = 500;
const SAMPLES: usize = 1 << 14;
const RATE_HZ: f64 = 100.0;

/// By how much the coefficients of a lot scatter, relative to the preset `mems`: 6 % in a triangle of ±15 %.
fn spread(device: u64) -> f64 {
    let mut random = Random::seed_from_u64(device);
    let [one, other] = [(); 2].map(|()| random.random::<f64>());
    1.0 + 0.15 * (one - other)
}

/// Every 50th device is an outlier: its white noise is twice that of the others.
fn is_outlier(device: u64) -> bool {
    device % 50 == 7
}

/// Every 100th device has drifted: its white noise is a quarter larger than it was.
fn has_drifted(device: u64) -> bool {
    device % 100 == 31
}

fn white(device: u64) -> f64 {
    let factor = if is_outlier(device) {
        2.0
    } else {
        spread(device)
    };
    factor * Preset::Mems.coefficients().angle_random_walk
}

fn name(device: u64) -> String {
    format!("SN-{device:04}")
}

/// The certificate of a device whose angle random walk is this large.
fn certificate(device: u64, angle_random_walk: f64, seed: u64) -> Vec<u8> {
    let coefficients = Coefficients {
        angle_random_walk,
        ..Preset::Mems.coefficients()
    };
    let quantum = 1e-5;
    let mut accumulator = Accumulator::<17>::new();
    for rate in Simulator::new(coefficients, RATE_HZ, seed).take(SAMPLES) {
        accumulator.push((rate / quantum).round() as i32);
    }
    let curve = accumulator.curve(Scale::new(quantum, RATE_HZ).unwrap());
    let model = Model::ieee_952();
    let fit = fit(&curve, &model, Options::default()).unwrap();
    let conditions = Conditions {
        temperature_c: None,
        duration_s: SAMPLES as f64 / RATE_HZ,
        rate_hz: RATE_HZ,
        samples: SAMPLES as u64,
        gaps: 0,
    };
    let id = name(device);
    let unit = RateUnit::DegreesPerSecond;
    let mut certificate = Certificate::new(id.as_bytes(), [1, 0, 0], conditions, unit).unwrap();
    let axis = AxisCertificate::new(&curve, &model, &fit).unwrap();
    certificate.axes.push(axis).unwrap();
    let mut buffer = vec![0; Certificate::MAX_BYTES];
    certificate.encode(&mut buffer).unwrap().to_vec()
}

/// A folder with the lot, and with the earlier certificates of its first half.
fn lot() -> (TempDir, Vec<String>, Vec<String>) {
    let folder = TempDir::new().unwrap();
    let write = |file: &String, bytes: Vec<u8>| fs::write(folder.path().join(file), bytes).unwrap();
    let file = |kind: &str, device: u64| format!("{kind}-{}.bin", name(device));
    (0..DEVICES).into_par_iter().for_each(|device| {
        let drift = if has_drifted(device) { 1.25 } else { 1.0 };
        write(
            &file("now", device),
            certificate(device, white(device) * drift, 2 * device),
        );
        if device < DEVICES / 2 {
            write(
                &file("before", device),
                certificate(device, white(device), 2 * device + 1),
            );
        }
    });
    let now = (0..DEVICES).map(|device| file("now", device)).collect();
    let before = (0..DEVICES / 2)
        .map(|device| file("before", device))
        .collect();
    (folder, now, before)
}

fn devices(list: &Value, effect: &str) -> BTreeSet<String> {
    let of_effect = list
        .as_array()
        .unwrap()
        .iter()
        .filter(|one| one["effect"] == effect);
    of_effect
        .map(|one| one["device"].as_str().unwrap().to_owned())
        .collect()
}

fn count(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn five_hundred_devices_are_judged_by_three_limits() {
    let (folder, now, before) = lot();
    let usual = Preset::Mems.coefficients();
    // The limit of the white noise lies where some devices are in the guard band.
    let walk = 1.08 * usual.angle_random_walk;
    let limits = [
        format!("N={walk}"),
        format!("quantization={}", 2.0 * usual.quantization),
        format!("B={}", 4.0 * usual.bias_instability),
    ];
    let mut arguments = vec!["lot"];
    limits
        .iter()
        .for_each(|limit| arguments.extend(["--limit", limit]));
    arguments.extend(now.iter().map(String::as_str));
    arguments.push("--earlier");
    arguments.extend(before.iter().map(String::as_str));

    let text = command(folder.path(), &arguments).output().unwrap();
    assert!(text.status.success());
    let text = String::from_utf8(text.stdout).unwrap();
    println!("{text}");
    let lot = json(folder.path(), &arguments);

    // Yield and guard band: the truth is known.
    let rows = lot["limits"].as_array().unwrap();
    assert_eq!(rows.len(), 3);
    let row = rows
        .iter()
        .find(|row| row["effect"] == "angle_random_walk")
        .unwrap();
    let [passed, guarded, failed] = ["passed", "guarded", "failed"].map(|key| count(&row[key]));
    assert_eq!(passed + guarded + failed, DEVICES);
    assert_eq!(count(&row["measured"]), DEVICES);
    let drift = |device| if has_drifted(device) { 1.25 } else { 1.0 };
    let is_good = |device: &u64| white(*device) * drift(*device) <= walk;
    let good = (0..DEVICES).filter(is_good).count() as u64;
    assert!(good > 300 && guarded > 20, "{good} are good, {row}");
    // A pass is wrong for 2.5 % of the devices at the limit, and a fail too.
    assert!(
        passed <= good && failed <= DEVICES - good,
        "{good} are good, {row}"
    );
    assert!(
        passed + guarded >= good && failed + guarded >= DEVICES - good,
        "{row}"
    );
    assert_eq!(
        count(&lot["passed"]) + count(&lot["guarded"]) + count(&lot["failed"]),
        DEVICES
    );
    let number = |value: &Value| value.as_f64().unwrap();
    let share = number(&lot["yield_share"]);
    assert!((share - count(&lot["passed"]) as f64 / DEVICES as f64).abs() < 1e-12);
    let interval = &lot["yield_interval"];
    assert!(number(&interval[0]) < share && share < number(&interval[1]));

    // Cpk from the truth: the outliers widen the distribution.
    let truth: Vec<f64> = (0..DEVICES)
        .map(|device| white(device) * drift(device))
        .collect();
    let mean = truth.iter().sum::<f64>() / DEVICES as f64;
    let variance = truth.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (DEVICES - 1) as f64;
    let cpk = (walk - mean) / (3.0 * variance.sqrt());
    assert!(
        (number(&row["cpk"]) / cpk - 1.0).abs() < 0.1,
        "{row}, {cpk}"
    );
    let median = number(&row["percentiles"][1]);
    assert!(
        (median / usual.angle_random_walk - 1.0).abs() < 0.02,
        "{row}"
    );

    // Outliers and drifted devices, by name.
    let named = |is: fn(u64) -> bool, all: u64| -> BTreeSet<String> {
        (0..all).filter(|device| is(*device)).map(name).collect()
    };
    let outliers = devices(&lot["outliers"], "angle_random_walk");
    assert!(
        outliers.is_superset(&named(is_outlier, DEVICES)),
        "{outliers:?}"
    );
    assert_eq!(lot["outliers"].as_array().unwrap().len(), outliers.len());
    // A device that has drifted may have become one, and no other device is.
    let unusual = |device| is_outlier(device) || has_drifted(device);
    assert!(outliers.is_subset(&named(unusual, DEVICES)), "{outliers:?}");
    assert_eq!(
        devices(&lot["drifted"], "angle_random_walk"),
        named(has_drifted, DEVICES / 2)
    );
    assert_eq!(count(&lot["compared"]), DEVICES / 2);
    let others = lot["drifted"].as_array().unwrap().len() - 3;
    assert!(others <= 1, "{}", lot["drifted"]);

    for part in [
        "500 devices: ",
        "yield ",
        "Cpk",
        "outliers:",
        "drifted:",
        "SN-0131 x: angle random walk",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
}

#[test]
fn what_is_no_lot_is_refused_in_a_line() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    for (file, seed) in [("a.bin", 1), ("b.bin", 2)] {
        fs::write(path.join(file), certificate(5, white(5), seed)).unwrap();
    }
    fs::write(path.join("c.bin"), b"no certificate").unwrap();
    let refused = |arguments: &[&str], what: &str| {
        let refusal = refusal(path, arguments);
        assert!(refusal.contains(what), "{refusal}");
    };
    refused(&["lot", "a.bin", "--limit", "N"], "there is no value");
    refused(
        &["lot", "a.bin", "--limit", "Z=1"],
        "there is no such effect",
    );
    refused(
        &["lot", "a.bin", "--limit", "N=-1"],
        "is not a positive number",
    );
    refused(
        &[
            "lot",
            "a.bin",
            "--limit",
            "N=1",
            "--limit",
            "angle_random_walk=2",
        ],
        "angle_random_walk has two limits",
    );
    refused(
        &["lot", "a.bin", "b.bin", "--limit", "N=1"],
        "device SN-0005 is in a.bin, too",
    );
    refused(&["lot", "c.bin", "--limit", "N=1"], "c.bin");
    refused(&["lot", "missing.bin", "--limit", "N=1"], "missing.bin");
    // A file that is none does not hide the others.
    let output = command(
        Path::new(path),
        &["lot", "a.bin", "c.bin", "--limit", "N=1"],
    )
    .output()
    .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 device: 1 pass"));
}
