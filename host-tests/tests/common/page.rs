//! Pages of `report` for tests.

use crate::browser::Browser;
use program::{json, output};
use serde_json::Value;
use std::path::Path;

/// Writes the page of an input into a folder, and returns the diagnosis of the same input.
pub(crate) fn reported(folder: &Path, arguments: &[&str]) -> Value {
    // Whether the page with the program is built changes nothing here.
    let output_options = ["--plain", "--output", "report.html"];
    let report = [&["report"], arguments, &output_options].concat();
    assert!(output(folder, &report).contains("wrote report.html: "));
    json(folder, &[&["diagnose"], arguments].concat())
}

/// Writes the log of a consumer gyro, 2^16 samples at 100 Hz, with hidden effects.
pub(crate) fn simulate(folder: &Path, effects: &[&str]) {
    let simulate = ["simulate", "mems", "--duration", "655.36", "--seed", "5"];
    let effects = effects.iter().flat_map(|effect| ["--effect", *effect]);
    let effects: Vec<&str> = effects.collect();
    output(
        folder,
        &[&simulate[..], &effects, &["--output", "log.csv"]].concat(),
    );
}

pub(crate) fn opened(folder: &Path) -> Browser {
    let mut browser = Browser::start();
    browser.open(&format!("file://{}/report.html", folder.display()));
    browser
}

pub(crate) fn steps(axis: &Value) -> &[Value] {
    axis["steps"].as_array().unwrap()
}

/// The data in the page that the script reads.
pub(crate) fn embedded(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}
