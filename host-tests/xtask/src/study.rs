//! Runs a study behind the figures of the pages.

use crate::{firmware::cargo, step::step};
use anyhow::Result;

/// Runs a study with its options.
///
/// # Errors
/// When the study does not build, or fails.
pub(crate) fn run(arguments: &[impl AsRef<std::ffi::OsStr>]) -> Result<()> {
    let mut study = cargo();
    study.args(["run", "--release", "--package", "host-tests"]);
    study.args(["--no-default-features", "--features", "study"]);
    study.args(["--bin", "study", "--"]).args(arguments);
    step("the study", &mut study)
}
