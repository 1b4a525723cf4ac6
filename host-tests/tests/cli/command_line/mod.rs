//! Checks what users and scripts see of the program: results, exit statuses, and one line for each
//! error.

mod fitting;
#[cfg(unix)]
mod outputs;
mod simulating;

use program::output;
use serde::Deserialize;
use std::path::Path;
use tempfile::TempDir;

/// A folder with a simulated log of 20 000 samples and three axes, and with the curves of the log.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "200s",
        "--axes",
        "3",
        "--output",
        "log.csv",
    ];
    assert_eq!(output(folder.path(), &simulate), "");
    output(
        folder.path(),
        &["measure", "log.csv", "--output", "curve.json"],
    );
    folder
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    axes: Vec<Axis>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Axis {
    axis: String,
    rate_hz: f64,
    unit: String,
    mean_rate: Option<f64>,
    octaves: Vec<Octave>,
    method: String,
    coefficients: Vec<Coefficient>,
    chi2: Option<f64>,
    dof: Option<u32>,
    deviance: Option<f64>,
    p_value: Option<f64>,
    adequate: Option<bool>,
    verdict: Option<String>,
    missing: Vec<String>,
    birge_ratio: f64,
    invalid: Option<String>,
    reason: Option<String>,
    covariates: Vec<serde_json::Value>,
    notes: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Octave {
    m: u32,
    tau_s: f64,
    differences: u64,
    variance: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Coefficient {
    effect: String,
    symbol: String,
    value: Option<f64>,
    lower: Option<f64>,
    upper: Option<f64>,
    state: String,
    unit: String,
}

fn fit(folder: &Path, arguments: &[&str]) -> Document {
    let arguments = [&["fit", "--json"], arguments].concat();
    serde_json::from_str(&output(folder, &arguments)).unwrap()
}
