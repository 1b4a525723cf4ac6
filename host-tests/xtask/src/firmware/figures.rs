//! The README's tables of the cost on the target. They follow from the budgets that the tests
//! check.

use super::{Precision, budgets::target};
use anyhow::{Context as _, Result};
use serde_json::Value;
use std::fmt::Write as _;

/// The number of samples per second of three axes, and the number of instructions per second of the
/// core that takes them.
const SAMPLES_PER_S: f64 = 3.0 * 8000.0;
const INSTRUCTIONS_PER_S: f64 = 64e6;

/// The tables as they stand in the README.
///
/// # Errors
/// Fails if a figure is missing.
pub fn readme(budgets: &Value) -> Result<String> {
    Ok(format!("{}\n{}", detail(budgets)?, cores(budgets)?))
}

/// The table of a Cortex-M4F, with a row for each figure and a column for each precision.
fn detail(budgets: &Value) -> Result<String> {
    let [single, double] = Precision::ALL.map(|precision| {
        let figures = &budgets[target(precision)];
        rows(&Figures("Cortex-M4F", figures))
    });
    let mut table =
        String::from("| figure | single precision | double precision |\n|---|---|---|\n");
    for ((figure, single), (_, double)) in single?.into_iter().zip(double?) {
        writeln!(table, "| {figure} | {single} | {double} |")?;
    }
    Ok(table)
}

fn rows(target: &Figures<'_>) -> Result<Vec<(&'static str, String)>> {
    let mean = target.of("instructions_per_sample")?;
    let of = |name| target.of(name);
    let bytes = |name| Ok::<_, anyhow::Error>(format!("{} bytes", of(name)?));
    let whole = |name| Ok::<_, anyhow::Error>(format!("{:.0}", of(name)?));
    let run = |of: &str| -> Result<String> {
        let instructions = target.million(&format!("instructions_{of}"))?;
        let stack = target.of(&format!("stack_bytes_{of}"))?;
        Ok(format!(
            "{instructions} million instructions, {stack} bytes of stack"
        ))
    };
    Ok(vec![
        (
            "instructions a sample, mean, m = 1 and 2 included",
            format!("{mean:.0}"),
        ),
        (
            "the same through `push_slice`",
            format!("{:.0}", of("instructions_per_sample_slice")?),
        ),
        (
            "instructions a sample, worst, 12 to 30 octaves alike",
            format!("{:.0}", of("instructions_worst_sample")?),
        ),
        (
            "three axes at 8 kHz, of 64 million instructions a second",
            format!("{:.1} %", 100.0 * mean * SAMPLES_PER_S / INSTRUCTIONS_PER_S),
        ),
        ("RAM an axis, 24 octaves", bytes("ram_bytes_per_axis_24")?),
        (
            "flash of the accumulator",
            bytes("flash_bytes_accumulator")?,
        ),
        (
            "flash with curve and the fit of the five terms alone",
            bytes("flash_bytes_with_five_terms")?,
        ),
        ("flash with curve and fit", bytes("flash_bytes_with_fit")?),
        (
            "flash with the whole diagnosis",
            bytes("flash_bytes_with_diagnosis")?,
        ),
        ("fit of 20 octaves", run("fit_20")?),
        (
            "diagnosis of 20 octaves with one hidden effect",
            run("diagnosis_20")?,
        ),
        (
            "RAM of three axes of 20 octaves, stack of a diagnosis included",
            bytes("ram_bytes_three_axes_20_with_diagnosis")?,
        ),
        (
            "instructions a sample of three axes with every part but spectrum and course, and a temperature",
            whole("instructions_per_sample_three_axes")?,
        ),
        (
            "the same with spectra",
            whole("instructions_per_sample_three_axes_with_spectrum")?,
        ),
        (
            "the same with spectra and courses",
            whole("instructions_per_sample_three_axes_with_spectrum_and_course")?,
        ),
        (
            "instructions a sample of a spectrum alone, in the interrupt and in the main loop",
            format!(
                "{} and {}",
                whole("instructions_per_sample_spectrum_interrupt")?,
                whole("instructions_per_sample_spectrum_main_loop")?
            ),
        ),
        (
            "RAM an axis with every part but spectrum and course, 20 octaves",
            bytes("ram_bytes_per_axis_20_with_all_parts")?,
        ),
        (
            "RAM an axis for a spectrum of 7 levels, and for a course with a temperature",
            format!(
                "{} and {} bytes",
                of("ram_bytes_per_axis_of_spectrum")?,
                of("ram_bytes_per_axis_of_course")?
            ),
        ),
        (
            "flash with the whole diagnosis and a spectrum",
            bytes("flash_bytes_with_spectrum")?,
        ),
        ("diagnosis with a spectrum of 112 bins", {
            let instructions = target.million("instructions_of_diagnosis_with_spectrum")?;
            let stack = of("stack_of_diagnosis_with_spectrum")?;
            format!("{instructions} million instructions, {stack} bytes of stack")
        }),
    ])
}

/// The table of all cores, with a row for each core and precision. A dash marks what a core has no
/// room for.
fn cores(budgets: &Value) -> Result<String> {
    let mut table = String::from(
        "| core | precision | instructions a sample | worst | fit, million | diagnosis, million | flash | stack | RAM, stack included |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for core in budgets["cores"].as_array().context("no cores")? {
        let name = core["core"].as_str().context("a core without a name")?;
        let precision = core["precision"].as_str().context("no precision")?;
        let core = Figures(name, core);
        let diagnosis = match core.1["instructions_diagnosis"] {
            Value::Null => "–".into(),
            _ => core.million("instructions_diagnosis")?,
        };
        writeln!(
            table,
            "| {name} | {precision} | {:.0} | {} | {} | {diagnosis} | {} | {} | {} |",
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

/// The name of a core, and its figures.
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
