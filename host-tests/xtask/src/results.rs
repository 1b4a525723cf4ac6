//! Everything that the command line says of many records, to compare before and after a change that should change no result.

use crate::{firmware::cargo, step::run};
use anyhow::{Context as _, Result, bail};
use rayon::prelude::*;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

const PRESETS: [&str; 6] = ["tactical", "fog", "mems", "srs2000", "vg951", "crg20"];

/// What is hidden in records of the presets [`GYROS`].
const HIDDEN: [&str; 20] = [
    "sinusoid:frequency_hz=7.7,amplitude=0.02",
    "resonance:frequency_hz=17,quality=6,rms=0.04",
    "gauss_markov:correlation_time_s=3,rms=0.02",
    "random_telegraph:correlation_time_s=1,rms=0.02",
    "low_pass:cutoff_hz=8,poles=2",
    "digital_low_pass:cutoff_hz=20,poles=4",
    "cascade:cutoff_hz=15,stages=2",
    "decimation_filter:width_s=0.03,stages=2",
    "moving_average:samples=5",
    "output_low_pass:cutoff_hz=12,poles=2",
    "power_law:exponent=1.5,deviation_at_one_second=0.004",
    "notch:frequency_hz=30,quality=2",
    "mode_split:rise_hz=10,corner_hz=30",
    "high_pass:cutoff_hz=0.05",
    "drifting_sinusoid:frequency_hz=20,drift_hz=2,amplitude=0.05",
    "drifting_resonance:frequency_hz=6,quality=30,drift_hz=0.5,rms=0.05",
    "thermal:slope=0.01,kelvin=10,time_s=600",
    "thermal:slope=0.01,kelvin=5,period_s=300",
    "sinusoid:frequency_hz=1.36,amplitude=0.2 low_pass:cutoff_hz=12,poles=4",
    "sinusoid:frequency_hz=20,amplitude=0.02 gauss_markov:correlation_time_s=60,rms=0.01",
];
const GYROS: [&str; 3] = ["mems", "tactical", "vg951"];
const SAMPLES: &str = "327.68";

/// What is asked of each record.
const QUESTIONS: [&[&str]; 5] = [
    &["fit", "--json"],
    &["compare", "--json"],
    &["diagnose", "--json"],
    &["export", "--format", "kalibr"],
    &["export", "--format", "csv"],
];

/// Asks everything of every record, writes the answers to a folder, and compares them with those in another one.
pub(crate) fn run_all(folder: &Path, against: Option<&Path>, more: &[PathBuf]) -> Result<()> {
    let mut build = cargo();
    run(build.args(["build", "--package", "allanite-cli", "--bin", "allanite"]))?;
    let program = fs::canonicalize("target/debug/allanite")?;
    let records = folder.join("records");
    let answers = folder.join("answers");
    for folder in [&records, &answers] {
        fs::create_dir_all(folder).with_context(|| format!("{}", folder.display()))?;
    }
    let mut inputs = simulated(&program, &records)?;
    for data in ["adis16405.json", "mpu6050.json"] {
        inputs.push(fs::canonicalize(Path::new("host-tests/data").join(data))?);
    }
    for file in more {
        inputs.push(fs::canonicalize(file).with_context(|| format!("{}", file.display()))?);
    }
    let asked: Vec<(String, Vec<String>)> =
        inputs.iter().flat_map(|input| questions(input)).collect();
    asked.par_iter().try_for_each(|(name, arguments)| {
        fs::write(answers.join(name), answer(&program, &records, arguments)?).context("answer")
    })?;
    println!(
        "{} records, {} answers in {}",
        inputs.len() + 1,
        asked.len(),
        answers.display()
    );
    let Some(against) = against else {
        return Ok(());
    };
    let against = against.join("answers");
    let differ = asked.iter().filter(|(name, _)| {
        let [before, after] = [&against, &answers].map(|folder| fs::read(folder.join(name)).ok());
        before.is_none() || before != after
    });
    let differ: Vec<&str> = differ.map(|(name, _)| name.as_str()).collect();
    println!(
        "{} of {} answers are equal to the bit",
        asked.len() - differ.len(),
        asked.len()
    );
    if !differ.is_empty() {
        bail!(
            "these differ from those in {}: {}",
            against.display(),
            differ.join(", ")
        );
    }
    Ok(())
}

/// The questions about one record, and about the certificates of the example, each with the name of its answer.
fn questions(input: &Path) -> Vec<(String, Vec<String>)> {
    let stem = input.file_name().unwrap_or_default().to_string_lossy();
    let path = input.display().to_string();
    let mut all = Vec::new();
    for question in QUESTIONS {
        let mut arguments: Vec<String> = question.iter().map(|&word| word.to_owned()).collect();
        arguments.push(path.clone());
        all.push((
            format!("{stem}.{}", question.join("_").replace("--", "")),
            arguments,
        ));
    }
    if stem == "mpu6050.json" {
        let lot = input.with_file_name("lot");
        let [now, before] = ["now", "before"].map(|name| lot.join(name).display().to_string());
        let words = [
            "lot",
            "--json",
            "--limit",
            "N=0.02",
            "--limit",
            "B=30°/h",
            &now,
            "--earlier",
            &before,
        ];
        all.push(("lot".into(), words.map(str::to_owned).to_vec()));
    }
    all
}

/// Simulates every preset, every effect in some of them, an accelerometer, counts, several axes and a record with gaps.
fn simulated(program: &Path, folder: &Path) -> Result<Vec<PathBuf>> {
    let mut all: Vec<(String, String)> = Vec::new();
    for preset in PRESETS {
        all.push((preset.to_owned(), preset.to_owned()));
    }
    for preset in GYROS {
        for (number, hidden) in HIDDEN.iter().enumerate() {
            let effects: Vec<String> = hidden
                .split(' ')
                .map(|one| format!(" --effect {one}"))
                .collect();
            all.push((
                format!("{preset}-{number}"),
                format!("{preset}{}", effects.concat()),
            ));
        }
    }
    all.push((
        "accelerometer".into(),
        "--unit m/s^2 --angle-random-walk 0.001 --bias-instability 0.0005".into(),
    ));
    all.push(("counts".into(), "mems --scale 0.01 --axes 3".into()));
    let write = |(seed, (name, words)): (usize, &(String, String))| {
        let file = PathBuf::from(format!("{name}.csv"));
        let mut simulate = Command::new(program);
        simulate.args([
            "simulate",
            "--quiet",
            "--duration",
            SAMPLES,
            "--seed",
            &seed.to_string(),
        ]);
        simulate.args(words.split(' ')).arg("--output").arg(&file);
        simulate.current_dir(folder);
        let done = simulate.status()?;
        if !done.success() {
            bail!("simulate {words}: {done}");
        }
        Ok(file)
    };
    let mut files = all
        .par_iter()
        .enumerate()
        .map(write)
        .collect::<Result<Vec<PathBuf>>>()?;
    files.push(with_gaps(&files[2], folder)?);
    Ok(files)
}

/// The record with a column of time, in which some rows are missing.
fn with_gaps(log: &Path, folder: &Path) -> Result<PathBuf> {
    let text = fs::read_to_string(folder.join(log))?;
    let rows = text
        .lines()
        .filter(|line| !line.starts_with(['#', 'g']))
        .enumerate();
    let kept = rows.filter(|(row, _)| row % 5000 > 20 && row % 997 != 0);
    let rows: Vec<String> = kept
        .map(|(row, line)| format!("{:.2},{line}\n", row as f64 * 0.01))
        .collect();
    let file = PathBuf::from("gaps.csv");
    fs::write(
        folder.join(&file),
        format!("# unit=deg/s\ntime_s,gx\n{}", rows.concat()),
    )?;
    Ok(file)
}

/// What the program says in a folder, on both streams, and how it ends.
fn answer(program: &Path, folder: &Path, arguments: &[String]) -> Result<Vec<u8>> {
    let mut ask = Command::new(program);
    ask.current_dir(folder).args(arguments).stdin(Stdio::null());
    let output = ask.output()?;
    let status = format!("\n{}\n", output.status);
    Ok([output.stdout, output.stderr, status.into_bytes()].concat())
}
