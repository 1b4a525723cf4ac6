//! Tests the functions for fleets on DataFusion and Ballista. Their package is a workspace of its own, because the engine takes
//! longer to build than all else together.

use crate::{
    firmware::{cargo, host_target_directory, workspace},
    step::step,
};
use anyhow::Result;
use std::process::Command;

const MANIFEST: &str = "host-tests/fleet/Cargo.toml";

/// Builds the package and tests it, a cluster of processes on this machine included. `arguments` go to the tests.
///
/// # Errors
/// When the package does not build, or a test fails.
pub(crate) fn run(arguments: &[String]) -> Result<()> {
    println!("The engine takes half an hour to build the first time.");
    step("fleets: format", of_package("fmt").args(["--", "--check"]))?;
    let target = host_target_directory().join("fleet");
    // The optimised program is that which the tests run as a cluster.
    let built = |task: &str| {
        let mut command = of_package(task);
        command
            .args(["--release", "--locked", "--target-dir"])
            .arg(&target);
        command
    };
    step(
        "fleets: tests on DataFusion and Ballista",
        built("test").arg("--").args(arguments),
    )?;
    step(
        "fleets: lints",
        built("clippy").args(["--all-targets", "--", "-D", "warnings"]),
    )?;
    println!(
        "the program: {}",
        target.join("release/allanite-fleet").display()
    );
    Ok(())
}

fn of_package(task: &str) -> Command {
    let mut command = cargo();
    command
        .arg(task)
        .arg("--manifest-path")
        .arg(workspace().join(MANIFEST));
    command
}
