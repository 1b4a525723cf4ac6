//! What somebody gets who depends on the published library.

use super::stages::Stages;
use crate::{
    firmware::{cargo, target_directory, workspace},
    setup,
    step::run as command,
};
use anyhow::{Context as _, Result};
use std::process::Command;

/// Every feature of the library. A user may combine them at will.
const FEATURES: [&str; 6] = ["async", "defmt", "double", "flash", "overlap", "storage"];

/// Checks that each feature builds alone, that the package has every file that it needs, and that the oldest supported compiler
/// builds it.
pub(crate) fn run(stages: &mut Stages) -> Result<()> {
    stages.run("the library with each feature alone", || {
        FEATURES.iter().try_for_each(|feature| {
            command(cargo().args(["check", "--package", "allanite", "--features", feature]))
        })
    })?;
    stages.run("the library as a package", || {
        command(cargo().args([
            "package",
            "--package",
            "allanite",
            "--allow-dirty",
            "--quiet",
        ]))
    })?;
    stages.run("the library by the oldest compiler", oldest)
}

/// Builds the library with the compiler that `rust-version` names.
fn oldest() -> Result<()> {
    let manifest = std::fs::read_to_string(workspace().join("Cargo.toml"))?;
    let oldest = manifest
        .lines()
        .find_map(|line| line.strip_prefix("rust-version = "));
    let oldest = oldest
        .context("Cargo.toml names no rust-version")?
        .trim_matches('"');
    if !setup::has_toolchain(oldest) {
        println!("skipped: rustup cannot get Rust {oldest} here");
        return Ok(());
    }
    command(
        Command::new("rustup")
            .args(["run", oldest, "cargo", "check", "--package", "allanite"])
            .args(["--features", "async,defmt,flash,overlap"])
            .args(["--target-dir"])
            .arg(target_directory().join("oldest"))
            .current_dir(workspace()),
    )
}
