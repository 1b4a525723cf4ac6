//! The peers, how they are installed and how they are run.

use super::python::{FOLDER, Python, run, text};
use crate::resources::Resources;
use anyhow::{Context as _, Result, anyhow, ensure};
use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// Which differences a peer takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// Those of every start.
    Full,
    /// Those of clusters that do not overlap.
    None,
}

/// Another program for the Allan deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Peer {
    /// Its name for the programs that run it.
    pub name: &'static str,
    /// The package with its version: of the Python package index, or else a crate that `peers/Cargo.toml` pins.
    pub package: &'static str,
    /// Whether it is a Python package.
    pub python: bool,
    /// Its differences.
    pub overlap: Overlap,
    /// Whether it estimates coefficients, or says anything of the kind of noise, without a user's hand.
    pub fits: bool,
    /// The number of channels that it always takes.
    pub channels: u32,
}

/// The peers of the study.
pub const PEERS: [Peer; 7] = [
    Peer {
        name: "allantools",
        package: "allantools==2024.6",
        python: true,
        overlap: Overlap::Full,
        fits: true,
        channels: 1,
    },
    Peer {
        name: "allantools adev",
        package: "allantools==2024.6",
        python: true,
        overlap: Overlap::None,
        fits: false,
        channels: 1,
    },
    Peer {
        name: "allan-variance",
        package: "allan-variance==1.0",
        python: true,
        overlap: Overlap::Full,
        fits: true,
        channels: 1,
    },
    Peer {
        name: "avar",
        package: "avar==1.0.4",
        python: true,
        overlap: Overlap::Full,
        fits: false,
        channels: 1,
    },
    Peer {
        name: "allan-variance-analyzer",
        package: "allan-variance-analyzer==1.0.4",
        python: true,
        overlap: Overlap::None,
        fits: true,
        channels: 6,
    },
    Peer {
        name: "allan",
        package: "allan 0.4.1",
        python: false,
        overlap: Overlap::Full,
        fits: false,
        channels: 1,
    },
    Peer {
        name: "imu-calib",
        package: "imu-calib 0.3.1",
        python: false,
        overlap: Overlap::None,
        fits: true,
        channels: 6,
    },
];

/// The installed peers.
pub struct Environment {
    python: Result<Python, String>,
    crates: PathBuf,
    /// The peers that could be installed.
    pub peers: Vec<Peer>,
    /// The packages that could not, each with the last line of the reason.
    pub missing: Vec<(&'static str, String)>,
}

impl Environment {
    /// Installs the Python packages into a virtual environment in this folder, and builds the crates there.
    pub fn new(folder: &Path) -> Result<Self> {
        let mut environment = Self {
            python: Python::new(folder).map_err(|error| last_line(&error)),
            crates: folder.join("crates/release/peers"),
            peers: Vec::new(),
            missing: Vec::new(),
        };
        let manifest = format!("{FOLDER}/Cargo.toml");
        let target = text(&folder.join("crates"));
        let build = [
            "build",
            "--release",
            "--locked",
            "--manifest-path",
            &manifest,
            "--target-dir",
            &target,
        ];
        let built = run("cargo", &build).map_err(|error| last_line(&error));
        let constraints = format!("{FOLDER}/constraints.txt");
        for peer in PEERS {
            let installed = match (peer.python, &environment.python) {
                (false, _) => built.clone(),
                (true, Err(error)) => Err(error.clone()),
                (true, Ok(python)) => {
                    let install = ["-c", &constraints, peer.package];
                    python.install(&install).map_err(|error| last_line(&error))
                }
            };
            match installed {
                Ok(()) => environment.peers.push(peer),
                Err(why) => environment.missing.push((peer.package, why)),
            }
        }
        Ok(environment)
    }

    /// Runs a task of a peer on files, at a rate in Hz and with a size of a count. Returns what it prints of each file,
    /// and what the process used.
    pub fn run(
        &self,
        peer: &Peer,
        task: &str,
        [rate_hz, scale]: [f64; 2],
        files: &[PathBuf],
    ) -> Result<(Vec<Value>, Resources)> {
        let mut command = if peer.python {
            let python = self.python.as_ref();
            let mut python = python
                .map_err(|error| anyhow!("{error}"))?
                .command("peer.py");
            // One thread, so that CPU time is that of one core, and figures without a screen.
            python
                .env("OMP_NUM_THREADS", "1")
                .env("OPENBLAS_NUM_THREADS", "1");
            python.env("MPLBACKEND", "Agg");
            python
        } else {
            Command::new(&self.crates)
        };
        command.args([peer.name, task, &rate_hz.to_string(), &scale.to_string()]);
        printed(command.args(files)).with_context(|| format!("{} {task}", peer.name))
    }
}

/// The arrays and objects of JSON that a program prints among other lines, and the last one, which tells what it used.
pub(super) fn printed(command: &mut Command) -> Result<(Vec<Value>, Resources)> {
    let output = command.output()?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{errors}");
    let lines = String::from_utf8(output.stdout)?;
    let lines = lines.lines().filter(|line| line.starts_with(['[', '{']));
    let values: Result<Vec<Value>, _> = lines.map(serde_json::from_str).collect();
    let mut values = values?;
    let used = values.pop().context("a program printed nothing")?;
    Ok((values, serde_json::from_value(used)?))
}

fn last_line(error: &anyhow::Error) -> String {
    let text = format!("{error:#}");
    let line = text.lines().rev().find(|line| !line.trim().is_empty());
    line.unwrap_or_default().to_owned()
}
