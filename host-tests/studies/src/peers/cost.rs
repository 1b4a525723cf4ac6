//! CPU time and memory of each program for one long record.

use super::{
    environment::{Environment, printed},
    record,
};
use crate::{long::Program, resources::Resources};
use allanite_host::simulate::Preset;
use anyhow::{Context as _, Result};
use serde::Serialize;
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// The number of samples of the short record, which shows what a program needs before it computes.
pub const SHORT: u64 = 1 << 12;

/// How often each program runs.
pub const RUNS: usize = 3;

/// The seed of the records.
const SEED: u64 = 1;

/// What one program takes for the record beyond what it takes for the short one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// The program.
    pub program: String,
    /// The number of channels that it computed.
    pub channels: u32,
    /// The number of averaging times that it computed.
    pub taus: usize,
    /// CPU time in s, all channels: the median of the runs, the least and the largest.
    pub cpu_s: [f64; 3],
    /// The largest resident memory, all channels, in bytes: the median of the runs, the least and the largest. It may
    /// be negative where the system's part of the memory varies by more than the program takes.
    pub bytes: [f64; 3],
    /// The CPU time for the short record, in s.
    pub start_s: f64,
    /// The memory for the short record, in bytes.
    pub start_bytes: f64,
}

impl Cost {
    /// The CPU time of a channel.
    pub fn channel_s(&self) -> f64 {
        self.cpu_s[0] / f64::from(self.channels)
    }

    /// The memory of a channel.
    pub fn channel_bytes(&self) -> f64 {
        self.bytes[0] / f64::from(self.channels)
    }

    /// How many times the memory another program takes, at least: by its least, and by the largest of this program,
    /// which counts for a page of 4 KiB or more.
    pub fn times_the_memory(&self, other: &Self) -> f64 {
        let least = other.bytes[1] / f64::from(other.channels);
        least / self.bytes[2].max(4096.0) * f64::from(self.channels)
    }
}

/// The costs of our programs and of every peer.
pub fn costs(
    environment: &Environment,
    program: &Program,
    folder: &Path,
    samples: u64,
) -> Result<Vec<Cost>> {
    let gyro = Preset::Mems.coefficients();
    let long = folder.join("long.npy");
    let short = folder.join("short.npy");
    record::write(&long, gyro, &[], [samples, SEED], |_| ())?;
    record::write(&short, gyro, &[], [SHORT, SEED], |_| ())?;
    let mut costs = Vec::new();
    for task in ["accumulate", "measure"] {
        let run = |file: &Path| {
            let mut command = Command::new(&program.file);
            printed(command.arg("own").arg(task).arg(file))
        };
        costs.push(cost(format!("allanite, {task}"), 1, &run, [&long, &short])?);
    }
    for peer in &environment.peers {
        let run = |file: &Path| environment.run(peer, "octaves", [1.0, 1.0], &[file.to_owned()]);
        costs.push(cost(
            peer.name.to_owned(),
            peer.channels,
            &run,
            [&long, &short],
        )?);
    }
    Ok(costs)
}

type Printed = (Vec<serde_json::Value>, Resources);

fn cost(
    program: String,
    channels: u32,
    run: &dyn Fn(&Path) -> Result<Printed>,
    [long, short]: [&PathBuf; 2],
) -> Result<Cost> {
    let mut taus = 0;
    let mut runs = |file: &Path| -> Result<[Vec<f64>; 2]> {
        let (mut cpu, mut peak) = (Vec::new(), Vec::new());
        for _ in 0..RUNS {
            let (found, used) = run(file)?;
            let found = found.first().context("a program printed nothing")?;
            taus = found.as_array().map_or(0, Vec::len);
            cpu.push(used.cpu_s);
            peak.push(used.peak_bytes);
        }
        cpu.sort_by(f64::total_cmp);
        peak.sort_by(f64::total_cmp);
        Ok([cpu, peak])
    };
    let [start_s, start_bytes] = runs(short)?.map(|sorted| sorted[RUNS / 2]);
    let [cpu, peak] = runs(long)?;
    Ok(Cost {
        program,
        channels,
        taus,
        cpu_s: [cpu[RUNS / 2], cpu[0], cpu[RUNS - 1]].map(|cpu| cpu - start_s),
        bytes: [peak[RUNS / 2], peak[0], peak[RUNS - 1]].map(|peak| peak - start_bytes),
        start_s,
        start_bytes,
    })
}
