//! The soak of the accumulator, on this machine or in QEMU.

use crate::{
    firmware::{CORTEX_M4F, Image, cargo, run_with},
    step::step,
};
use anyhow::{Result, bail};

/// Runs the soak with its number of samples, its seed and the number of samples before the first fault.
pub(crate) fn run(numbers: [u64; 3], on_target: bool) -> Result<()> {
    let numbers = numbers.map(|number| number.to_string());
    if !on_target {
        let mut soak = cargo();
        soak.args(["run", "--release", "--package", "images", "--bin", "soak"]);
        return step("the soak", soak.arg("--").args(&numbers));
    }
    let image = Image::build_for("soak", &CORTEX_M4F);
    let arguments: Vec<&str> = numbers.iter().map(String::as_str).collect();
    let run = run_with(&image?, &arguments)?;
    println!("{}", run.lines.join("\n"));
    if !run.status.success() {
        bail!("the soak failed ({}): the log above says why", run.status);
    }
    Ok(())
}
