//! What the library costs, on the target and on the host.

use super::{setup, step::shown};
use crate::firmware::{self, Image, cargo};
use anyhow::{Context as _, Result, bail};
use comfy_table::{Table, presets};
use serde_json::{Map, Value, json};

/// A figure, its unit and what it counts.
const FIGURES: [(&str, &str, &str); 14] = [
    (
        "instructions_per_sample",
        "instructions",
        "mean, 24 octaves, a gyro at rest",
    ),
    (
        "instructions_per_sample_slice",
        "instructions",
        "the same through push_slice",
    ),
    (
        "instructions_worst_sample",
        "instructions",
        "full-scale counts, the worst of the next three",
    ),
    (
        "instructions_worst_sample_12",
        "instructions",
        "with 12 octaves",
    ),
    (
        "instructions_worst_sample_24",
        "instructions",
        "with 24 octaves",
    ),
    (
        "instructions_worst_sample_30",
        "instructions",
        "with 30 octaves",
    ),
    (
        "ram_bytes_per_axis_24",
        "bytes",
        "one accumulator of 24 octaves",
    ),
    (
        "flash_bytes",
        "bytes",
        "accumulator, curve and fit, with start-up code",
    ),
    (
        "instructions_fit_20",
        "instructions",
        "covariance fit of 20 octaves, five effects",
    ),
    ("stack_bytes_fit_20", "bytes", "the same"),
    (
        "instructions_diagnosis_20",
        "instructions",
        "diagnosis of 20 octaves with a hidden sinusoid",
    ),
    ("stack_bytes_diagnosis_20", "bytes", "the same"),
    (
        "ns_per_sample_slice",
        "ns",
        "push_slice on this host, one core, median of 15 runs",
    ),
    ("ns_per_sample", "ns", "push on this host, the same"),
];

const NOTE: &str = "QEMU counts instructions, not cycles";

pub(super) fn run(json: bool) -> Result<()> {
    if !json {
        setup::run()?;
    }
    let target = target()?;
    let host = host()?;
    if json {
        let mut target = target;
        target.insert("note".into(), NOTE.into());
        println!("{:#}", json!({ "target": target, "host": host }));
        return Ok(());
    }
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_header(["figure", "value", "unit", "of what"]);
    for (name, unit, of) in FIGURES {
        let value = target.get(name).or_else(|| host.get(name));
        let value = value.with_context(|| format!("{name} was not measured"))?;
        let number = value.as_f64().unwrap_or(f64::NAN);
        let digits = usize::from(unit == "ns" || number.fract() != 0.0);
        table.add_row([name, &format!("{number:.digits$}"), unit, of]);
    }
    println!("{table}\n{NOTE}.");
    Ok(())
}

/// What the images `bench` and `footprint` tell.
fn target() -> Result<Map<String, Value>> {
    let run = firmware::run(&Image::build("bench")?)?;
    if !run.status.success() {
        bail!("the image bench ended with {}: {:?}", run.status, run.lines);
    }
    let lines = run
        .lines
        .iter()
        .filter_map(|line| line.strip_prefix("info "));
    let mut figures = figures(lines)?;
    let worst = figures
        .iter()
        .filter(|(name, _)| name.starts_with("instructions_worst_sample_"))
        .filter_map(|(_, value)| value.as_u64())
        .max();
    figures.insert("instructions_worst_sample".into(), worst.into());
    let footprint = Image::build("footprint")?;
    figures.insert("flash_bytes".into(), footprint.flash_bytes()?.into());
    Ok(figures)
}

/// What `host-tests/benches/accumulator.rs` tells.
fn host() -> Result<Map<String, Value>> {
    let mut command = cargo();
    command.args([
        "bench",
        "--quiet",
        "--package",
        "host-tests",
        "--bench",
        "accumulator",
    ]);
    let output = command
        .stderr(std::process::Stdio::inherit())
        .output()
        .with_context(|| format!("`{}` did not start", shown(&command)))?;
    if !output.status.success() {
        bail!("`{}` failed ({})", shown(&command), output.status);
    }
    figures(String::from_utf8(output.stdout)?.lines())
}

/// Lines of a name and a number.
fn figures<'a>(lines: impl Iterator<Item = &'a str>) -> Result<Map<String, Value>> {
    let figure = |line: &str| {
        let (name, number) = line.split_once(' ')?;
        let number: serde_json::Number = number.parse().ok()?;
        Some((name.to_owned(), number.into()))
    };
    lines
        .map(|line| figure(line).with_context(|| format!("{line:?} is not a name and a number")))
        .collect()
}
