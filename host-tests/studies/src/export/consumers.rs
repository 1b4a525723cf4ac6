//! Reads back what `export` wrote, by the parsers of the programs that it is for.

use super::gyro::RATE_HZ;
use crate::peers::Python;
use allanite_cli::command::CommandLine;
use allanite_host::simulate::{Coefficients, Preset, Simulator};
use allanite_log::failure::Failure;
use anyhow::{Result, anyhow, ensure};
use clap::Parser;
use serde::Deserialize;
use std::{
    fs::{self, File},
    io::{self, BufWriter, Write},
    path::Path,
};

/// The formats that are read back, and the model that they are compared with.
const FORMATS: [&str; 14] = [
    "json",
    "kalibr",
    "openvins",
    "vins-fusion",
    "orb-slam3",
    "lio-sam",
    "fast-lio",
    "gtsam",
    "kf-gins",
    "ros",
    "px4",
    "ardupilot",
    "matlab",
    "sdf",
];

/// The samples of a record that shows white noise, bias instability and random walk.
const LONG: usize = 1 << 17;

/// The samples of a record that shows white noise alone.
const SHORT: usize = 6000;

/// The axes of a log: the gyro, of which the third axis is white, and the accelerometer.
const AXES: [&str; 6] = [
    "gx (deg/s)",
    "gy (deg/s)",
    "gz (deg/s)",
    "ax (m/s^2)",
    "ay (m/s^2)",
    "az (m/s^2)",
];

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
    /// What the model has, converted by the rule of the program, or what the program takes if the number is left out.
    pub expected: f64,
}

/// Installs the parsers into this folder, writes a model in every format and reads it. A second model has no accelerometer,
/// and a random walk that its record only bounds.
///
/// # Errors
/// When a package cannot be installed, or a file cannot be written or read.
pub fn consumers(folder: &Path) -> Result<Vec<Number>> {
    let python = Python::new(folder)?;
    python.install_all("consumers.txt")?;
    let files = folder.join("files");
    let log = files.join("log.csv");
    fs::create_dir_all(&files)?;
    for (name, axes, samples, options) in [
        ("long", &AXES[..], LONG, &["--accelerometer"][..]),
        ("short", &AXES[..1], SHORT, &[]),
    ] {
        write(&log, axes, samples)?;
        let written = files.join(name);
        fs::create_dir_all(&written)?;
        for format in FORMATS {
            export(&log, format, &written.join(format), options)?;
        }
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

/// Writes a log in which each axis has the noise of a gyro, or as much of it in m/s².
fn write(path: &Path, axes: &[&str], samples: usize) -> io::Result<()> {
    let gyro = Preset::Mems.coefficients();
    let mut noise: Vec<Simulator> = (0..axes.len())
        .map(|axis| {
            // The third axis of a log, and the only one of another, have no more than white noise.
            let gyro = match axes.len() == 1 || axis == 2 {
                true => Coefficients {
                    bias_instability: 0.0,
                    rate_random_walk: 0.0,
                    ..gyro
                },
                false => gyro,
            };
            Simulator::new(gyro, RATE_HZ, axis as u64)
        })
        .collect();
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "{}", axes.join(","))?;
    for _ in 0..samples {
        let row = noise.iter_mut().map(|axis| axis.next().unwrap_or_default());
        let row: Vec<String> = row.map(|value| format!("{value:.4}")).collect();
        writeln!(file, "{}", row.join(","))?;
    }
    file.flush()
}

/// Exports the five terms of a log in a format.
fn export(log: &Path, format: &str, output: &Path, options: &[&str]) -> Result<()> {
    let rate = RATE_HZ.to_string();
    let [log, output] = [log, output].map(|path| path.to_string_lossy().into_owned());
    let line = [
        "allanite",
        "--quiet",
        "export",
        &log,
        "--rate",
        &rate,
        "--model",
        "five-terms",
        "--despite-invalid",
        "--format",
        format,
        "--output",
        &output,
    ];
    let line = line.into_iter().chain(options.iter().copied());
    let command = CommandLine::try_parse_from(line)?;
    let failed = |failure: Failure| anyhow!("{failure}");
    command.run().map_err(failed)
}
