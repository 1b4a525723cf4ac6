//! Fuzzing of one target with rustup's nightly and cargo-fuzz.

use crate::{
    firmware::workspace,
    setup::has_toolchain,
    step::{run, step},
};
use anyhow::{Context as _, Result, bail, ensure};
use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::Path,
    process::{Command, Stdio},
};
use tempfile::TempDir;

/// The compiler that the fuzzer needs.
pub(crate) const NIGHTLY: &str = "nightly";

/// The target of the interface for C, which is built in single precision. All others are built with the tools.
const SINGLE: &str = "c";

/// An input may take this much memory and this many seconds.
const LIMITS: [&str; 2] = ["-rss_limit_mb=128", "-timeout=5"];

/// Fuzzes a target for so many seconds. It begins with the committed corpus, which it does not change.
pub(crate) fn fuzz(target: &str, seconds: u64, seed: u32) -> Result<()> {
    let folder = workspace().join("host-tests/fuzz");
    let targets = targets(&folder)?;
    ensure!(
        targets.iter().any(|name| name == target),
        "{target} is not a fuzz target: give one of {}",
        targets.join(", ")
    );
    ensure!(
        seed > 0,
        "the seed 0 lets the fuzzer choose one: give another"
    );
    ensure!(
        has_toolchain(NIGHTLY),
        "rustup has no {NIGHTLY}: `rustup toolchain install {NIGHTLY}`"
    );
    if run(cargo(&["fuzz", "--version"])
        .stdout(Stdio::null())
        .stderr(Stdio::null()))
    .is_err()
    {
        step(
            "installing cargo-fuzz",
            &mut cargo(&["install", "--locked", "cargo-fuzz"]),
        )?;
    }
    let built = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| workspace().join("target/fuzz"), Into::into);
    let cargo_fuzz = |task: &str| {
        let mut command = cargo(&["fuzz", task, target, "-s", "none"]);
        command.arg("--fuzz-dir").arg(&folder);
        if target == SINGLE {
            command.args(["--no-default-features", "--features", SINGLE]);
        }
        command.arg("--target-dir").arg(&built);
        command
    };
    step(&format!("building {target}"), &mut cargo_fuzz("build"))?;
    let found = TempDir::new()?;
    let mut fuzzer = cargo_fuzz("run");
    fuzzer
        .arg(found.path())
        .arg(folder.join("corpus").join(target));
    fuzzer.arg("--").args(LIMITS);
    fuzzer.args([
        format!("-seed={seed}"),
        format!("-max_total_time={seconds}"),
    ]);
    fuzzer.arg("-print_final_stats=1");
    println!("\n== {target}, {seconds} s, seed {seed}");
    let executions = watched(&mut fuzzer)?;
    println!("{target}: {executions} executions in {seconds} s with seed {seed}, none failed");
    Ok(())
}

/// The targets, which are the files of a folder.
pub(crate) fn targets(folder: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder.join("targets")).context("reading host-tests/fuzz/targets")? {
        let path = entry?.path();
        let name = path.file_stem().context("a target without a name")?;
        names.push(name.to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// Runs the fuzzer and passes on what it prints. Returns the number of its executions.
fn watched(fuzzer: &mut Command) -> Result<u64> {
    let mut child = fuzzer.stderr(Stdio::piped()).spawn()?;
    let mut executions = None;
    if let Some(stderr) = child.stderr.take() {
        for line in BufReader::new(stderr).split(b'\n') {
            let line = line?;
            let line = String::from_utf8_lossy(&line);
            if let Some(number) = line.strip_prefix("stat::number_of_executed_units:") {
                executions = number.trim().parse().ok();
            }
            eprintln!("{line}");
        }
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("the fuzzer found a failure ({status}): the log above names the input");
    }
    executions.context("the fuzzer told no number of executions")
}

/// The cargo of nightly.
pub(crate) fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new("rustup");
    command.args(["run", NIGHTLY, "cargo"]).args(arguments);
    // Variables of the cargo that runs this program would select its compiler.
    command.env_remove("CARGO").env_remove("RUSTUP_TOOLCHAIN");
    command
}
