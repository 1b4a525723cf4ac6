//! A long record that is cut into files, which separate processes simulate and measure, and `allanite merge` joins.

use allanite_host::{
    curve_file::{AxisCurve, CurveFile},
    simulate::Random,
};
use allanite_log::OCTAVES;
use anyhow::{Context as _, Result, ensure};
use rand::{SeedableRng, seq::SliceRandom};
use rayon::prelude::*;
use serde::Serialize;
use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The sampling rate, in Hz.
pub const RATE_HZ: u64 = 1000;

/// The simulated gyro, and the size of a count in deg/s.
const GYRO: [&str; 2] = ["mems", "0.0005"];

/// How the program `allanite` is started.
#[derive(Clone, Debug)]
pub struct Program {
    /// The file.
    pub file: PathBuf,
    /// The arguments before those of a command.
    pub first: Vec<OsString>,
}

impl Program {
    /// Runs a command in a folder.
    ///
    /// # Errors
    /// When the command fails.
    pub fn run(&self, folder: &Path, arguments: &[&str]) -> Result<()> {
        let mut command = Command::new(&self.file);
        command.current_dir(folder).args(&self.first).arg("--quiet");
        let output = command.args(arguments).output().context("allanite")?;
        let errors = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "allanite {arguments:?}: {errors}");
        Ok(())
    }
}

/// What cuts cost one octave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// The averaging time, in s.
    pub tau_s: f64,
    /// The number of differences in the merged curve.
    pub merged: u64,
    /// The number of differences in a record without cuts.
    pub whole: u64,
}

/// The files and what came of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distributed {
    /// The number of files.
    pub files: u64,
    /// The length of a file, in s.
    pub file_s: u64,
    /// The number of samples of all files.
    pub samples: u64,
    /// The seeds of the files are 1 to the number of files.
    pub seeds: [u64; 2],
    /// The names of the orders of merging.
    pub orders: Vec<&'static str>,
    /// The number of orders whose merged file has the bytes of the first one.
    pub same_bytes: usize,
    /// The size of the merged file, in bytes.
    pub bytes: usize,
    /// Whether the sums are the same if halves are merged first.
    pub same_sums_in_groups: bool,
    /// The largest relative difference of a density then. Densities are floats, whose sum depends on the order.
    pub density_in_groups: f64,
    /// Octaves with a difference in a record without cuts.
    pub octaves: Vec<Cost>,
}

/// Simulates, measures and merges files of a gyro.
pub fn distributed(program: &Program, files: u64, file_s: u64) -> Result<Distributed> {
    let folder = tempfile::tempdir()?;
    let folder = folder.path();
    (1..=files)
        .into_par_iter()
        .try_for_each(|seed| part(program, folder, seed, file_s))?;
    let names: Vec<String> = (1..=files).map(curve_name).collect();
    let mut shuffled = names.clone();
    shuffled.shuffle(&mut Random::seed_from_u64(files));
    let reversed: Vec<String> = names.iter().rev().cloned().collect();
    let orders = [
        ("in order", &names),
        ("reversed", &reversed),
        ("shuffled", &shuffled),
    ];
    let mut all = Vec::new();
    for (_, parts) in orders {
        all.push(merge(program, folder, parts, "all.json")?);
    }
    let same_bytes = all.iter().filter(|&one| *one == all[0]).count();
    // The parts of a half are merged first, and then the halves.
    let (left, right) = shuffled.split_at(shuffled.len() / 2);
    let mut halves = Vec::new();
    for (name, half) in [("right.json", right), ("left.json", left)] {
        if !half.is_empty() {
            merge(program, folder, half, name)?;
            halves.push(name.to_owned());
        }
    }
    let halves = merge(program, folder, &halves, "halves.json")?;
    let [one, grouped] = [&all[0], &halves].map(|bytes| axis(bytes));
    let (one, grouped) = (one?, grouped?);
    let samples = files * file_s * RATE_HZ;
    Ok(Distributed {
        files,
        file_s,
        samples,
        seeds: [1, files],
        orders: orders.map(|(name, _)| name).to_vec(),
        same_bytes,
        bytes: all[0].len(),
        same_sums_in_groups: one.octaves == grouped.octaves && one.short == grouped.short,
        density_in_groups: density_difference(&one, &grouped),
        octaves: costs(&one, samples),
    })
}

fn curve_name(seed: u64) -> String {
    format!("{seed}.json")
}

/// Writes a log, measures it in another process, and removes the log.
fn part(program: &Program, folder: &Path, seed: u64, file_s: u64) -> Result<()> {
    let (log, curve) = (format!("{seed}.npy"), curve_name(seed));
    let (rate, length, seed) = (RATE_HZ.to_string(), format!("{file_s}s"), seed.to_string());
    let [preset, scale] = GYRO;
    let simulate = [
        "simulate",
        preset,
        "--rate",
        &rate,
        "--duration",
        &length,
        "--scale",
        scale,
        "--seed",
        &seed,
        "--output",
        &log,
    ];
    program.run(folder, &simulate)?;
    program.run(folder, &["measure", &log, "--output", &curve])?;
    fs::remove_file(folder.join(log))?;
    Ok(())
}

/// The bytes of the file that merges the curves.
fn merge(program: &Program, folder: &Path, curves: &[String], name: &str) -> Result<Vec<u8>> {
    let mut arguments = vec!["merge"];
    arguments.extend(curves.iter().map(String::as_str));
    arguments.extend(["--output", name]);
    program.run(folder, &arguments)?;
    Ok(fs::read(folder.join(name))?)
}

/// The only axis of a curve file.
fn axis(curve: &[u8]) -> Result<AxisCurve> {
    let curve: CurveFile = serde_json::from_slice(curve)?;
    let axis = curve.axes.into_iter().next();
    axis.context("a curve file has no axis")
}

/// The largest relative difference between the densities of two curves.
fn density_difference(one: &AxisCurve, other: &AxisCurve) -> f64 {
    let densities = |axis: &AxisCurve| -> Vec<f64> {
        let levels = axis.spectrum.iter().flat_map(|spectrum| &spectrum.levels);
        levels.flat_map(|level| level.density.clone()).collect()
    };
    let pairs = densities(one).into_iter().zip(densities(other));
    let differences = pairs.map(|(one, other)| (one / other - 1.0).abs());
    differences.fold(0.0, f64::max)
}

/// The differences of the merged curve beside those of a record without cuts.
fn costs(axis: &AxisCurve, samples: u64) -> Vec<Cost> {
    let measured = axis
        .octaves
        .iter()
        .map(|octave| (octave.m, octave.differences));
    let short = axis
        .short
        .iter()
        .map(|octave| (octave.m, octave.differences));
    let merged: Vec<(u32, u64)> = measured.chain(short).collect();
    let costs = (0..OCTAVES as u32).map(|k| {
        let (m, step) = (1_u32 << k, u64::from((1_u32 << k) / 4).max(1));
        let octave = merged.iter().find(|(of, _)| *of == m);
        Cost {
            tau_s: f64::from(m) / RATE_HZ as f64,
            merged: octave.map_or(0, |(_, differences)| *differences),
            whole: (samples / step + 1).saturating_sub(2 * u64::from(m) / step),
        }
    });
    costs.filter(|cost| cost.whole > 0).collect()
}
