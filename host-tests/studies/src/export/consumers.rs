//! Reads back what `export` wrote, by the parsers of the programs that it is for.

use super::{SAMPLES, export_as, exported, gyro::Gyro};
use crate::peers::Python;
use allanite_host::simulate::Preset;
use allanite_log::failure::Failure;
use anyhow::{Result, anyhow, ensure};
use serde::Deserialize;
use std::{fs, path::Path};

/// The formats that are read back, and the model that they are compared with.
const FORMATS: [&str; 10] = [
    "json",
    "kalibr",
    "openvins",
    "vins-fusion",
    "lio-sam",
    "gtsam",
    "kf-gins",
    "ros",
    "px4",
    "ardupilot",
];

/// The first seed that is tried: the first gyro is taken in which the diagnosis finds a process, which KF-GINS is given.
const SEED: u64 = 9000;

/// A number that a program reads, in its own units.
#[derive(Debug, Deserialize)]
pub struct Number {
    /// The format of the file.
    pub format: String,
    /// The package that read it.
    pub parser: String,
    /// The name of the number in the file.
    pub name: String,
    /// What the parser read.
    pub read: f64,
    /// What the model has, converted by the rule of the program.
    pub expected: f64,
}

/// Installs the parsers into this folder, writes a model in every format and reads it.
///
/// # Errors
/// When a package cannot be installed, or a file cannot be written or read.
pub fn consumers(folder: &Path) -> Result<Vec<Number>> {
    let python = Python::new(folder)?;
    python.install_all("consumers.txt")?;
    let files = folder.join("files");
    fs::create_dir_all(&files)?;
    let log = files.join("log.csv");
    let despite = ["--despite-invalid", "--despite-unexplained"];
    let failed = |failure: Failure| anyhow!("{failure}");
    for seed in SEED.. {
        let base = Preset::Mems.coefficients();
        Gyro::drawn(base, seed).write(&log, SAMPLES, seed)?;
        let axis = exported(&log, &files, &despite).map_err(failed)?;
        if axis["processes"]
            .as_array()
            .is_some_and(|all| !all.is_empty())
        {
            break;
        }
    }
    for format in FORMATS {
        export_as(format, &log, &files.join(format), &despite).map_err(failed)?;
    }
    let output = python.command("consumers.py").arg(&files).output()?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{errors}");
    let lines = String::from_utf8(output.stdout)?;
    let numbers = lines.lines().filter(|line| line.starts_with('{'));
    Ok(numbers
        .map(serde_json::from_str)
        .collect::<Result<_, _>>()?)
}
