//! The README's figures of the target, from the budgets that the tests hold the library to.

use anyhow::{Context as _, Result};
use serde_json::Value;
use std::fmt::Write as _;

/// Samples a second of three axes, and instructions a second of a core that takes them.
const SAMPLES_PER_S: f64 = 3.0 * 8000.0;
const INSTRUCTIONS_PER_S: f64 = 64e6;

/// The tables as the README has them.
///
/// # Errors
/// If a figure is missing.
pub fn readme(budgets: &Value) -> Result<String> {
    Ok(format!("{}\n{}", detail(budgets)?, cores(budgets)?))
}

/// Figures of a Cortex-M4F.
fn detail(budgets: &Value) -> Result<String> {
    let target = Figures("Cortex-M4F", &budgets["target"]);
    let mean = target.of("instructions_per_sample")?;
    let fit = target.million("instructions_fit_20")?;
    let diagnosis = target.million("instructions_diagnosis_20")?;
    let of = |name| target.of(name);
    let mut table = String::from("| figure | value |\n|---|---|\n");
    let mut row = |figure: &str, value: String| writeln!(table, "| {figure} | {value} |");
    row(
        "instructions a sample, mean, m = 1 and 2 included",
        format!("{mean:.0}"),
    )?;
    row(
        "the same through `push_slice`",
        format!("{:.0}", of("instructions_per_sample_slice")?),
    )?;
    row(
        "instructions a sample, worst, 12 to 30 octaves alike",
        format!("{:.0}", of("instructions_worst_sample")?),
    )?;
    row(
        "three axes at 8 kHz, of 64 million instructions a second",
        format!("{:.1} %", 100.0 * mean * SAMPLES_PER_S / INSTRUCTIONS_PER_S),
    )?;
    row(
        "RAM an axis, 24 octaves",
        format!("{} bytes", of("ram_bytes_per_axis_24")?),
    )?;
    row(
        "flash of the accumulator",
        format!("{} bytes", of("flash_bytes_accumulator")?),
    )?;
    row(
        "with curve and fit, with the whole diagnosis",
        format!(
            "{} and {} bytes",
            of("flash_bytes_with_fit")?,
            of("flash_bytes_with_diagnosis")?
        ),
    )?;
    row(
        "fit of 20 octaves",
        format!(
            "{fit} million instructions, {} bytes of stack",
            of("stack_bytes_fit_20")?
        ),
    )?;
    row(
        "diagnosis of 20 octaves with one hidden effect",
        format!(
            "{diagnosis} million instructions, {} bytes of stack",
            of("stack_bytes_diagnosis_20")?
        ),
    )?;
    row(
        "RAM of three axes of 20 octaves, stack of a diagnosis included",
        format!("{} bytes", of("ram_bytes_three_axes_20_with_diagnosis")?),
    )?;
    Ok(table)
}

/// A row a core. What a core has no room for is a dash.
fn cores(budgets: &Value) -> Result<String> {
    let mut table = String::from(
        "| core | instructions a sample | worst | fit, million | diagnosis, million | flash | stack | RAM, stack included |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for core in budgets["cores"].as_array().context("no cores")? {
        let name = core["core"].as_str().context("a core without a name")?;
        let core = Figures(name, core);
        let diagnosis = match core.1["instructions_diagnosis"] {
            Value::Null => "–".into(),
            _ => core.million("instructions_diagnosis")?,
        };
        writeln!(
            table,
            "| {name} | {:.0} | {} | {} | {diagnosis} | {} | {} | {} |",
            core.of("instructions_per_sample")?,
            core.of("instructions_worst_sample")?,
            core.million("instructions_fit")?,
            core.of("flash_bytes")?,
            core.of("stack_bytes")?,
            core.of("ram_bytes")?,
        )?;
    }
    Ok(table)
}

/// Figures of one core.
struct Figures<'a>(&'a str, &'a Value);

impl Figures<'_> {
    fn of(&self, name: &str) -> Result<f64> {
        let value = self.1[name].as_f64();
        value.with_context(|| format!("{} has no {name}", self.0))
    }

    fn million(&self, name: &str) -> Result<String> {
        Ok(format!("{:.1}", self.of(name)? / 1e6))
    }
}
