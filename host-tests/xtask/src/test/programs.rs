//! Builds and runs the tests that run on this host.

use super::lints::{SINGLE, linted};
use crate::{
    firmware::Heartbeat,
    python::Native,
    step::{captured, run as command},
};
use anyhow::{Context as _, Result, bail, ensure};
use serde_json::Value;
use std::{
    io::{Read as _, Seek as _},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::Instant,
};

/// The part of a test's name that keeps it for `--all`: the module that it is in.
const THOROUGH: &str = "thorough::";

/// The modules of the command line's tests that mostly wait: for a browser, for a serial port, for time to pass. They run at the same
/// time as the others.
const WAITING: [&str; 6] = [
    "dropped::",
    "explore",
    "report_layout::",
    "report_view::",
    "watch::",
    "watch_ends::",
];
/// So many of them wait at once.
const WAITING_AT_ONCE: &str = "6";
/// The native part of the package for Python.
const PYTHON: &str = "allanite_python";
/// The test program that they are in.
const COMMAND_LINE: &str = "cli";

/// Tests the library and its examples in both precisions.
pub(crate) fn library() -> Result<()> {
    for features in [&SINGLE[..], &["--all-features"]] {
        command(
            linted()
                .args(["test", "--package", "allanite"])
                .args(features)
                .args(["--", "--skip", THOROUGH]),
        )?;
    }
    Ok(())
}

/// Tests everything else, but Python: the tests of each run, or those of `--all` alone.
pub(crate) fn host(built: &Built, thorough: bool) -> Result<()> {
    let lanes = if thorough {
        vec![built.jobs(&[THOROUGH])]
    } else {
        let (waiting, others) = built.halves();
        vec![others, waiting]
    };
    thread::scope(|scope| {
        let lanes: Vec<_> = (lanes.into_iter())
            .map(|jobs| scope.spawn(|| run_all(jobs)))
            .collect();
        // Every lane ends before the first failure is passed on.
        let ends: Vec<Result<()>> = (lanes.into_iter())
            .map(|lane| {
                lane.join()
                    .unwrap_or_else(|_| bail!("a thread of the tests failed"))
            })
            .collect();
        ends.into_iter().collect::<Result<()>>()
    })?;
    if thorough {
        return Ok(());
    }
    command(linted().args(["test", "--doc", "--workspace"]).args([
        "--exclude",
        "allanite",
        "--exclude",
        "allanite-python",
    ]))
}

/// Runs each job, and then names those that failed.
fn run_all(jobs: Vec<Job>) -> Result<()> {
    let ends = jobs.into_iter().map(Job::run);
    let failed: Vec<String> = (ends.filter_map(Result::err))
        .map(|error| format!("{error:#}"))
        .collect();
    ensure!(failed.is_empty(), "{}", failed.join("; "));
    Ok(())
}

/// What cargo has built for the tests.
#[derive(Default)]
pub(crate) struct Built {
    /// Each program of tests: its name, its path and the folder of its package.
    tests: Vec<(String, PathBuf, PathBuf)>,
    /// The programs that the tests call, with the variables by which they find them.
    programs: Vec<(String, String)>,
    /// The native part of the package for Python.
    native: Option<PathBuf>,
}

impl Built {
    /// Builds the tests of every package except the library, whose tests are built in both precisions, and the native part of the
    /// package for Python. One command builds all of them, because cargo would build a dependency once more for each command that asks
    /// for other features of it.
    ///
    /// # Errors
    /// When something does not build.
    pub(crate) fn new() -> Result<Self> {
        let messages = captured(
            linted()
                .args(["build", "--workspace", "--exclude", "allanite"])
                .args(["--lib", "--bins", "--tests"])
                .arg("--message-format=json-render-diagnostics"),
        )?;
        let mut built = Self::default();
        for line in messages.lines() {
            let message: Value = serde_json::from_str(line).context("a message of cargo")?;
            built.add(&message)?;
        }
        ensure!(!built.tests.is_empty(), "cargo has built no tests");
        Ok(built)
    }

    /// Takes what a message of cargo names.
    fn add(&mut self, message: &Value) -> Result<()> {
        let name = message["target"]["name"].as_str().unwrap_or_default();
        if name == PYTHON {
            let files = message["filenames"].as_array().into_iter().flatten();
            self.native = files.filter_map(Value::as_str).map(PathBuf::from).next();
        }
        let Some(executable) = message["executable"].as_str() else {
            return Ok(());
        };
        if message["profile"]["test"] == true {
            let manifest = Path::new(message["manifest_path"].as_str().unwrap_or_default());
            let folder = manifest.parent().context("a package without a folder")?;
            let test = (name.to_owned(), executable.into(), folder.into());
            self.tests.push(test);
        } else {
            let variable = format!("CARGO_BIN_EXE_{name}");
            self.programs.push((variable, executable.to_owned()));
        }
        Ok(())
    }

    /// The native part of the package for Python, and the program to compare it with.
    ///
    /// # Errors
    /// When cargo has named none.
    pub(crate) fn python(&self) -> Result<Native> {
        let mut programs = self.programs.iter();
        let program = programs.find(|(name, _)| name == "CARGO_BIN_EXE_allanite");
        let (_, program) = program.context("cargo has not built the program")?;
        let library = self.native.clone();
        Ok(Native {
            library: library.context("cargo has not built the package for Python")?,
            program: program.into(),
        })
    }

    /// The tests of each run: those that wait, and all others.
    fn halves(&self) -> (Vec<Job>, Vec<Job>) {
        let mut others = Vec::new();
        let mut waiting = Vec::new();
        for test in &self.tests {
            let mut job = self.job(test, &[]);
            job.command.args(["--skip", THOROUGH]);
            if test.0 == COMMAND_LINE {
                for module in WAITING {
                    job.command.args(["--skip", module]);
                }
                let mut slow = self.job(test, &WAITING);
                slow.command.args(["--skip", THOROUGH]);
                slow.command.args(["--test-threads", WAITING_AT_ONCE]);
                slow.name += ", what waits";
                waiting.push(slow);
            }
            others.push(job);
        }
        (waiting, others)
    }

    /// A job for each program of tests, of those tests whose names have one of these parts.
    fn jobs(&self, parts: &[&str]) -> Vec<Job> {
        let jobs = self.tests.iter().map(|test| self.job(test, parts));
        jobs.collect()
    }

    fn job(&self, (name, path, folder): &(String, PathBuf, PathBuf), parts: &[&str]) -> Job {
        let mut command = Command::new(path);
        command
            .args(parts)
            .current_dir(folder)
            .env("CARGO_MANIFEST_DIR", folder)
            .envs(self.programs.iter().map(|(name, path)| (name, path)));
        Job {
            name: name.clone(),
            command,
        }
    }
}

/// A program of tests with its arguments.
struct Job {
    name: String,
    command: Command,
}

impl Job {
    /// Runs the program. What it prints appears in one piece when it has ended, because another one may run at the same time.
    fn run(mut self) -> Result<()> {
        let begun = Instant::now();
        let mut printed = tempfile::tempfile()?;
        let heartbeat = Heartbeat::new(format!("the tests of {}", self.name));
        let status = (self.command)
            .stdin(Stdio::null())
            .stdout(printed.try_clone()?)
            .stderr(printed.try_clone()?)
            .status()
            .with_context(|| format!("the tests of {} did not start", self.name))?;
        drop(heartbeat);
        let mut text = String::new();
        printed.rewind()?;
        printed.read_to_string(&mut text)?;
        let text = text.trim();
        println!(
            "\n-- {}: {} s\n{text}",
            self.name,
            begun.elapsed().as_secs()
        );
        ensure!(
            status.success(),
            "the tests of {} failed ({status})",
            self.name
        );
        Ok(())
    }
}
