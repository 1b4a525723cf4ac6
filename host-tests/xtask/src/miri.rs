//! Miri, which interprets tests and reports races and undefined behaviour.

use crate::{
    fuzz::{NIGHTLY, cargo},
    setup::has_toolchain,
    step::step,
};
use anyhow::{Result, ensure};
use std::process::Command;

/// The tests of the library that Miri runs: those in integers, because it knows no assembly and the square root of a
/// processor is one.
const TESTS: [&str; 4] = [
    "kurtosis::tests::sums",
    "kurtosis::tests::a_sum",
    "list",
    "course::tests::slices",
];

/// The examples of accumulators and snapshots.
const EXAMPLES: [&str; 2] = ["octave", "storage::snapshot"];

/// Runs the queue between two threads with so many orders of their steps, then the other tests once.
pub(crate) fn miri(seeds: u32) -> Result<()> {
    ensure!(
        has_toolchain(NIGHTLY),
        "rustup has no {NIGHTLY}: `rustup toolchain install {NIGHTLY}`"
    );
    let mut install = Command::new("rustup");
    install.args([
        "component",
        "add",
        "miri",
        "rust-src",
        "--toolchain",
        NIGHTLY,
    ]);
    step("installing Miri", &mut install)?;
    let test = |what: &[&str]| {
        let mut command = cargo(&["miri", "test", "--package", "allanite"]);
        command.args(what);
        command
    };
    let mut queue = test(&["--lib", "queue"]);
    queue.env("MIRIFLAGS", format!("-Zmiri-many-seeds=0..{seeds}"));
    step("the queue between two threads", &mut queue)?;
    step("sums in integers", test(&["--lib", "--"]).args(TESTS))?;
    for example in EXAMPLES {
        step(
            example,
            test(&["--features", "storage", "--doc", "--"]).arg(example),
        )?;
    }
    println!("\n{seeds} orders of the threads' steps, and no fault");
    Ok(())
}
