//! How much CPU time the program takes for a whole log, beside programs that read or average the same file and do nothing else.

use crate::peers::Python;
use anyhow::{Context as _, Result, ensure};
use serde::Serialize;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

/// The number of pairs of runs, of which the median ratio is told.
const PAIRS: usize = 5;

/// A command of the program, and what is done beside it by the script of the readers.
const WORK: [(&str, &[&str], &str); 3] = [
    (
        "fit of Parquet",
        &["fit", "--json", "log.parquet"],
        "parquet",
    ),
    ("fit of CSV", &["fit", "--json", "log.csv"], "csv"),
    (
        "measure of an array",
        &[
            "measure",
            "axis.npy",
            "--rate",
            "1000",
            "--unit",
            "deg/s",
            "--scale",
            "1",
            "--output",
            "curve.json",
        ],
        "pyramid",
    ),
];

/// What a pair of programs took.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What the program did.
    pub work: &'static str,
    /// What was done beside it.
    pub beside: &'static str,
    /// The median CPU times of both, with their children, in s.
    pub cpu_s: [f64; 2],
    /// The least, the median and the largest ratio of a pair.
    pub ratios: [f64; 3],
}

/// Runs this program and the readers in turn, in this folder.
///
/// # Errors
/// When a package cannot be installed, or a program fails.
pub fn study(program: &Path, folder: &Path) -> Result<Vec<Row>> {
    let program = program
        .canonicalize()
        .with_context(|| program.display().to_string())?;
    let python = Python::new(folder)?;
    python.install_all("readers.txt")?;
    let files = folder.join("files");
    fs::create_dir_all(&files)?;
    let reader = |task: &str| {
        let mut command = python.command("readers.py");
        command.arg(task).arg(&files);
        command
    };
    cpu_of(&mut reader("make"))?;
    let mut rows = Vec::new();
    for (work, arguments, task) in WORK {
        let ours = || {
            let mut command = Command::new(&program);
            command.current_dir(&files).args(arguments);
            command
        };
        // The first runs bring the file into memory.
        let pair = || anyhow::Ok([cpu_of(&mut ours())?, cpu_of(&mut reader(task))?]);
        pair()?;
        let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| pair()).collect::<Result<_>>()?;
        let sorted = |value: &dyn Fn(&[f64; 2]) -> f64| {
            let mut values: Vec<f64> = pairs.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            [values[0], values[PAIRS / 2], values[PAIRS - 1]]
        };
        let cpu_s = [0, 1].map(|which| sorted(&|pair| pair[which])[1]);
        rows.push(Row {
            work,
            beside: task,
            cpu_s,
            ratios: sorted(&|[ours, theirs]| ours / theirs),
        });
    }
    Ok(rows)
}

/// The CPU time that a command and its children take, in s.
fn cpu_of(command: &mut Command) -> Result<f64> {
    let before = cpu_of_children()?;
    let output = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .output();
    let output = output.context("starting a program")?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{command:?}: {errors}");
    Ok(cpu_of_children()? - before)
}

/// The CPU time of all processes that this one has waited for, and of their children, in s.
fn cpu_of_children() -> Result<f64> {
    /// The ticks of a second, which Linux fixes for all programs.
    const TICKS: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").context("only Linux tells CPU times")?;
    // The name of the program stands in brackets, and may hold blanks; `cutime` and `cstime` are the 14th and 15th fields behind it.
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let ticks = fields.split_whitespace().skip(13).take(2);
    let ticks: Vec<f64> = ticks.map(str::parse).collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<f64>() / TICKS)
}
