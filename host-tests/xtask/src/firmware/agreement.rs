//! Checks that an image and this host compute the same bits.

use super::{Core, Heartbeat, Image, Precision, REMEDY, cargo, run_with, toolchain::artefacts};
use anyhow::{Context as _, Result, ensure};

/// The first line in which the program `characterise` prints different things on a core and on this
/// host. Returns `None` if every number has the same bits.
///
/// # Errors
/// Fails if the image cannot be built or run, or if it ends with a failure.
pub fn difference(core: &Core) -> Result<Option<String>> {
    let there = told(core, "characterise", &[])?;
    let here = told_here(core.precision, "characterise", &[])?;
    Ok(first_difference(&here, &there))
}

/// The first difference between the lines of this host and those of a core.
pub fn first_difference(here: &[String], there: &[String]) -> Option<String> {
    let differ = here.iter().zip(there).find(|(here, there)| here != there);
    match differ {
        Some((here, there)) => Some(format!("{here:?} on this host, {there:?} on the core")),
        None if here.len() != there.len() => Some(format!(
            "{} lines on this host, {} on the core",
            here.len(),
            there.len()
        )),
        None => None,
    }
}

/// The lines that an image logs on a core.
///
/// # Errors
/// Fails if the image cannot be built or run, or if it ends with a failure.
pub fn told(core: &Core, image: &str, arguments: &[&str]) -> Result<Vec<String>> {
    let run = run_with(&Image::build_for(image, core)?, arguments)?;
    let (status, lines) = (run.status, run.lines);
    ensure!(status.success(), "the image ended with {status}: {lines:?}");
    let message = |line: &String| line.strip_prefix("info ").unwrap_or(line).to_owned();
    Ok(lines.iter().map(message).collect())
}

/// The lines that the same program prints on this host.
///
/// # Errors
/// Fails if the program cannot be built or run, or if it ends with a failure.
pub fn told_here(precision: Precision, image: &str, arguments: &[&str]) -> Result<Vec<String>> {
    let _heartbeat = Heartbeat::new(format!(
        "{image} on this host, {} precision",
        precision.name()
    ));
    let output = cargo()
        .args(["run", "--package", "images", "--bin", image])
        .args(precision.arguments())
        .arg("--target-dir")
        .arg(artefacts(precision))
        .arg("--")
        .args(arguments)
        .stderr(std::process::Stdio::inherit())
        .output()
        .with_context(|| format!("cargo did not start: {REMEDY}"))?;
    let (status, text) = (output.status, String::from_utf8(output.stdout)?);
    ensure!(status.success(), "{image} ended with {status} here: {text}");
    Ok(text.lines().map(str::to_owned).collect())
}
