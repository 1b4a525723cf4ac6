//! Format, lints and documentation.
//!
//! Checking a crate for lints takes as long as compiling it without optimisation, and cargo does both apart. So the tests of each run
//! are compiled by Clippy itself: [`linted`] makes a warning end the build. Only what no test compiles is checked apart.

use super::stages::Stages;
use crate::{
    firmware::{BOARDS, CORES, CORTEX_M4F, Precision, RISCV, Toolchain, cargo, workspace},
    step::run as command,
};
use anyhow::{Context as _, Result};
use std::{path::PathBuf, process::Command};

/// The compiler that checks lints: rustc with those of Clippy.
const CLIPPY: &str = "clippy-driver";
/// Its arguments, in the form in which `cargo clippy` passes them on.
const WARNINGS_END: &str = "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__";

/// The packages that run on a microcontroller.
const PACKAGES: [&str; 6] = [
    "--package",
    "allanite",
    "--package",
    "allanite-c",
    "--package",
    "images",
];

/// The optional parts of the program, each to be built without the others. `cargo allanite` builds none, so that code which needs one by
/// mistake would show in the first command of the README only. Two that share no code are built together.
const OPTIONAL_PARTS: [&str; 3] = ["bags,pictures", "tables", "watch"];

/// Every feature except double precision.
pub(crate) const SINGLE: [&str; 2] = ["--features", "async,defmt,storage,flash,overlap"];

/// Runs the lints of every change, or all of them.
pub(crate) fn run(stages: &mut Stages, all: bool) -> Result<()> {
    stages.run("format", format)?;
    stages.run("lints, of the program without its optional parts", || {
        part("")
    })?;
    stages.run("lints, on a Cortex-M4F in single precision", || {
        on_core(&CORTEX_M4F)
    })?;
    stages.run("documentation of the library", || {
        documentation(&["--package", "allanite"])
    })?;
    if !all {
        return Ok(());
    }
    stages.run("documentation", || documentation(&["--workspace"]))?;
    stages.run("lints, of the workspace", || {
        command(
            cargo()
                .args(["clippy", "--workspace", "--all-targets", "--all-features"])
                .args(["--", "-D", "warnings"]),
        )
    })?;
    for name in OPTIONAL_PARTS {
        stages.run(&format!("lints, of the program with {name} alone"), || {
            part(name)
        })?;
    }
    stages.run("lints, in single precision on this host", || {
        command(
            cargo()
                .args(["clippy", "--all-targets"])
                .args(PACKAGES)
                .args(SINGLE)
                .args(["--", "-D", "warnings"]),
        )
    })?;
    for core in [
        CORES[0],
        RISCV,
        CORTEX_M4F.with(Precision::Double),
        RISCV.with(Precision::Double),
    ] {
        stages.run(&format!("lints, on {core}"), || on_core(&core))?;
    }
    Ok(())
}

/// A command of cargo that compiles the crates of this workspace by Clippy: a lint ends it as an error does. The dependencies are those
/// that every other command compiles.
pub(super) fn linted() -> Command {
    let mut command = cargo();
    command
        .env("RUSTC_WORKSPACE_WRAPPER", CLIPPY)
        .env("CLIPPY_ARGS", WARNINGS_END);
    command
}

/// Builds the pages of these packages. Those of the host's need each dependency compiled once more.
fn documentation(packages: &[&str]) -> Result<()> {
    command(
        cargo()
            .args(["doc", "--no-deps", "--all-features"])
            .args(packages)
            .env("RUSTDOCFLAGS", "-D warnings"),
    )
}

fn format() -> Result<()> {
    command(
        cargo()
            .args(["fmt", "--all", "--", "--check"])
            .args(effects()?)
            // The boards are projects of their own.
            .args(BOARDS.map(|board| board.folder().join("src/main.rs"))),
    )
}

/// Checks the program with one of its optional parts, or with none.
fn part(features: &str) -> Result<()> {
    command(
        cargo()
            .args([
                "clippy",
                "--package",
                "allanite-cli",
                "--no-default-features",
            ])
            .args(["--features", features, "--", "-D", "warnings"]),
    )
}

/// Checks what runs on a core, in its precision.
fn on_core(core: &crate::firmware::Core) -> Result<()> {
    let features = match core.precision {
        Precision::Single => &SINGLE[..],
        Precision::Double => &["--all-features"],
    };
    command(
        Toolchain::find(core)?
            .cargo("clippy")?
            .args(PACKAGES)
            .args(["--lib", "--bins"])
            .args(features)
            .args(["--", "-D", "warnings"]),
    )
}

/// The source files of the effects. A macro declares these modules, and the formatter does not find
/// them.
fn effects() -> Result<Vec<PathBuf>> {
    let folder = workspace().join("src/theory/effect");
    let files =
        std::fs::read_dir(&folder).and_then(|files| files.map(|file| Ok(file?.path())).collect());
    files.with_context(|| format!("reading {}", folder.display()))
}
