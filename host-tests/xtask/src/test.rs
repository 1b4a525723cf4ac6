//! Runs all checks that must pass before a change is merged.

use crate::{
    bench,
    firmware::{BOARDS, CORTEX_M4F, RISCV, Toolchain, cargo, target_directory, workspace},
    python, setup,
    step::step,
    study,
};
use anyhow::{Context as _, Result};
use std::{path::PathBuf, process::Command};

/// The packages that run on a microcontroller.
const PACKAGES: [&str; 6] = [
    "--package",
    "allanite",
    "--package",
    "allanite-c",
    "--package",
    "images",
];

/// The optional parts of the program, to be built without the others, after none of them. `cargo allanite` builds none, so that
/// code which needs one by mistake would show in the first command of the README only. Two that share no code are built together.
const OPTIONAL_PARTS: [&str; 4] = ["", "bags,pictures", "tables", "watch"];

/// Every feature except double precision.
const SINGLE: [&str; 2] = ["--features", "async,defmt,storage,flash,overlap"];

pub(crate) fn run() -> Result<()> {
    println!("== set-up");
    setup::run()?;
    step(
        "format",
        cargo()
            .args(["fmt", "--all", "--", "--check"])
            .args(effects()?)
            // The boards are projects of their own.
            .args(BOARDS.map(|board| board.folder().join("src/main.rs"))),
    )?;
    step(
        "lints, on the host",
        cargo()
            .args(["clippy", "--workspace", "--all-targets", "--all-features"])
            .args(["--", "-D", "warnings"]),
    )?;
    for part in OPTIONAL_PARTS {
        step(
            &match part {
                "" => "lints, of the program without its optional parts".to_string(),
                part => format!("lints, of the program with {part} alone"),
            },
            cargo()
                .args([
                    "clippy",
                    "--package",
                    "allanite-cli",
                    "--no-default-features",
                ])
                .args(["--features", part, "--", "-D", "warnings"]),
        )?;
    }
    step(
        "lints, in single precision",
        cargo()
            .args(["clippy", "--all-targets"])
            .args(PACKAGES)
            .args(SINGLE)
            .args(["--", "-D", "warnings"]),
    )?;
    for core in [&CORTEX_M4F, &RISCV] {
        let toolchain = Toolchain::find(core)?;
        for (precision, features) in [("single", &SINGLE[..]), ("double", &["--all-features"])] {
            step(
                &format!("lints, on {}, {precision} precision", core.name),
                toolchain
                    .cargo("clippy")?
                    .args(PACKAGES)
                    .args(["--lib", "--bins"])
                    .args(features)
                    .args(["--", "-D", "warnings"]),
            )?;
        }
    }
    step(
        "documentation",
        cargo()
            .args(["doc", "--workspace", "--no-deps", "--all-features"])
            .env("RUSTDOCFLAGS", "-D warnings"),
    )?;
    for (precision, features) in [("single", &SINGLE[..]), ("double", &["--all-features"])] {
        step(
            &format!("the library and its examples in {precision} precision, on the host"),
            cargo()
                .args(["test", "--package", "allanite"])
                .args(features),
        )?;
    }
    publishing()?;
    step(
        "the images on every core, in QEMU",
        cargo()
            .args(["test", "--package", "allanite-cli", "--test", "images"])
            .arg("every_core::"),
    )?;
    bench::check_budgets()?;
    step(
        "tests of the programs on the host",
        // The library's own tests have run, in both precisions, and so have the images.
        cargo()
            .args(["test", "--workspace", "--exclude", "allanite"])
            // It has none in Rust, and those in Python follow.
            .args(["--exclude", "allanite-python"])
            .args(["--", "--skip", "every_core::"]),
    )?;
    study::test()?;
    python::run(&[])?;
    println!("\nall passed");
    Ok(())
}

/// Every feature of the library. A user may combine them at will.
const FEATURES: [&str; 6] = ["async", "defmt", "double", "flash", "overlap", "storage"];

/// Checks what somebody gets who depends on the published library: each feature builds alone, the package has every
/// file that it needs, and the oldest supported compiler builds it.
fn publishing() -> Result<()> {
    for feature in FEATURES {
        step(
            &format!("the library with the feature {feature} alone"),
            cargo().args(["check", "--package", "allanite", "--features", feature]),
        )?;
    }
    step(
        "the library as a package",
        cargo().args([
            "package",
            "--package",
            "allanite",
            "--allow-dirty",
            "--quiet",
        ]),
    )?;
    let manifest = std::fs::read_to_string(workspace().join("Cargo.toml"))?;
    let oldest = manifest
        .lines()
        .find_map(|line| line.strip_prefix("rust-version = "));
    let oldest = oldest
        .context("Cargo.toml names no rust-version")?
        .trim_matches('"');
    let heading = format!("the library by Rust {oldest}, the oldest that it supports");
    if !setup::has_toolchain(oldest) {
        println!("\n== {heading}\nskipped: rustup cannot get Rust {oldest} here");
        return Ok(());
    }
    step(
        &heading,
        Command::new("rustup")
            .args(["run", oldest, "cargo", "check", "--package", "allanite"])
            .args(["--features", "async,defmt,flash,overlap"])
            .args(["--target-dir"])
            .arg(target_directory().join("oldest"))
            .current_dir(workspace()),
    )
}

/// The source files of the effects. A macro declares these modules, so the formatter does not find
/// them.
fn effects() -> Result<Vec<PathBuf>> {
    let folder = workspace().join("src/theory/effect");
    let files =
        std::fs::read_dir(&folder).and_then(|files| files.map(|file| Ok(file?.path())).collect());
    files.with_context(|| format!("reading {}", folder.display()))
}
