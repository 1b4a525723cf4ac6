//! Whether an image and this host compute the same bits.

use super::{
    Core, Heartbeat, Image, Precision, REMEDY, cargo, run_with,
    toolchain::{exclusive, target_directory},
};
use anyhow::{Context as _, Result, ensure};

/// The first line in which `characterise` on a core and the same here differ; `None` if every number
/// has the same bits.
///
/// # Errors
/// If the image cannot be built or run, or ends with a failure.
pub fn difference(core: &Core) -> Result<Option<String>> {
    let there = told(core, "characterise", &[])?;
    let here = told_here(core.precision, "characterise", &[])?;
    Ok(first_difference(&here, &there))
}

/// The first line in which two that should tell the same differ.
pub fn first_difference(here: &[String], there: &[String]) -> Option<String> {
    let differ = here.iter().zip(there).find(|(here, there)| here != there);
    match differ {
        Some((here, there)) => Some(format!("{here:?} here, {there:?} there")),
        None if here.len() != there.len() => {
            Some(format!("{} lines here, {} there", here.len(), there.len()))
        }
        None => None,
    }
}

/// What an image logs on a core.
///
/// # Errors
/// If the image cannot be built or run, or ends with a failure.
pub fn told(core: &Core, image: &str, arguments: &[&str]) -> Result<Vec<String>> {
    let run = run_with(&Image::build_for(image, core)?, arguments)?;
    let (status, lines) = (run.status, run.lines);
    ensure!(status.success(), "the image ended with {status}: {lines:?}");
    let message = |line: &String| line.strip_prefix("info ").unwrap_or(line).to_owned();
    Ok(lines.iter().map(message).collect())
}

/// What the same program prints on this host.
///
/// # Errors
/// If it cannot be built or run, or ends with a failure.
pub fn told_here(precision: Precision, image: &str, arguments: &[&str]) -> Result<Vec<String>> {
    let _heartbeat = Heartbeat::new(format!(
        "{image} on this host, {} precision",
        precision.name()
    ));
    // Both precisions have one path.
    let _lock = exclusive()?;
    let output = cargo()
        .args(["run", "--package", "allanite", "--bin", image])
        .args(["--features", "firmware"])
        .args(precision.arguments())
        // The cargo that runs this program may hold the lock of the usual one.
        .arg("--target-dir")
        .arg(target_directory())
        .arg("--")
        .args(arguments)
        .stderr(std::process::Stdio::inherit())
        .output()
        .with_context(|| format!("cargo did not start: {REMEDY}"))?;
    let (status, text) = (output.status, String::from_utf8(output.stdout)?);
    ensure!(status.success(), "{image} ended with {status} here: {text}");
    Ok(text.lines().map(str::to_owned).collect())
}
