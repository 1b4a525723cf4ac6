//! Runs and tests the studies. Their package is a workspace of its own, because they are no part of the product.

use crate::{
    firmware::{cargo, host_target_directory, workspace},
    step::step,
};
use anyhow::Result;
use std::{ffi::OsStr, process::Command};

const MANIFEST: &str = "host-tests/studies/Cargo.toml";

/// Runs a study with its options.
///
/// # Errors
/// When the studies do not build, or the study fails.
pub(crate) fn run(arguments: &[impl AsRef<OsStr>]) -> Result<()> {
    step(
        "the study",
        built("run")
            .args(["--release", "--bin", "study", "--"])
            .args(arguments),
    )
}

/// Runs a study in small, by the program that the studies' own tests have built.
pub(crate) fn in_small(arguments: &[impl AsRef<OsStr>]) -> Result<()> {
    step(
        "the study",
        built("run").args(["--bin", "study", "--"]).args(arguments),
    )
}

/// Checks the studies, and runs those that are small enough for a test.
///
/// # Errors
/// When the studies do not build, or a test fails.
pub(crate) fn test() -> Result<()> {
    step("studies: format", of_package("fmt").args(["--", "--check"]))?;
    step(
        "studies: lints",
        built("clippy").args(["--all-targets", "--", "-D", "warnings"]),
    )?;
    step("studies: tests", &mut built("test"))
}

/// A command that builds the package into a folder of its own.
fn built(task: &str) -> Command {
    let mut command = of_package(task);
    command
        .args(["--locked", "--target-dir"])
        .arg(host_target_directory().join("studies"));
    command
}

fn of_package(task: &str) -> Command {
    let mut command = cargo();
    command
        .arg(task)
        .arg("--manifest-path")
        .arg(workspace().join(MANIFEST));
    command
}
