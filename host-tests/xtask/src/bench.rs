//! Measures the cost of the library on the target and on this host.

use crate::firmware::{
    Core, Heartbeat, Precision, Way, agreement, budgets, cargo, figures, measure,
};
use crate::{setup, step::shown};
use anyhow::{Context as _, Result, bail, ensure};
use comfy_table::{Table, presets};
use serde_json::{Map, Value};

/// The name of a figure of the Cortex-M4F or of this host, its unit and its meaning.
const FIGURES: [(&str, &str, &str); 26] = [
    (
        "instructions_per_sample",
        "instructions",
        "mean, 24 octaves, a gyro at rest",
    ),
    (
        "instructions_per_sample_slice",
        "instructions",
        "mean through push_slice, 24 octaves, a gyro at rest",
    ),
    (
        "instructions_worst_sample",
        "instructions",
        "full-scale counts, the largest of the next three",
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
        "instructions_per_sample_three_axes",
        "instructions",
        "gate, integrity, accumulator, moments, a covariate; 20 octaves",
    ),
    (
        "ram_bytes_per_axis_20_with_all_parts",
        "bytes",
        "a third of three axes with all these parts",
    ),
    (
        "flash_bytes",
        "bytes",
        "accumulator, curve and fit, with start-up code",
    ),
    ("flash_bytes_accumulator", "bytes", "push, gap and merge"),
    (
        "flash_bytes_with_five_terms",
        "bytes",
        "with curve and the fit of the five terms alone, 14 octaves",
    ),
    (
        "instructions_five_terms_20",
        "instructions",
        "that fit, of 20 octaves",
    ),
    ("stack_of_five_terms_20", "bytes", "stack of that fit"),
    (
        "flash_bytes_with_self_test",
        "bytes",
        "with curve and a self-test of an accumulator, 14 octaves",
    ),
    (
        "instructions_of_look_20",
        "instructions",
        "a look of that test at 20 octaves, with one limit",
    ),
    ("stack_of_look_20", "bytes", "stack of that look"),
    ("flash_bytes_with_fit", "bytes", "with curve and fit"),
    (
        "flash_bytes_with_diagnosis",
        "bytes",
        "with curve, fit and diagnosis, whole catalogue",
    ),
    (
        "instructions_fit_20",
        "instructions",
        "covariance fit of 20 octaves, five effects",
    ),
    ("stack_bytes_fit_20", "bytes", "stack of that fit"),
    (
        "instructions_diagnosis_20",
        "instructions",
        "diagnosis of 20 octaves with a hidden sinusoid",
    ),
    (
        "stack_bytes_diagnosis_20",
        "bytes",
        "stack of that diagnosis",
    ),
    (
        "ram_bytes_three_axes_20_with_diagnosis",
        "bytes",
        "three accumulators, a curve, the stack of a diagnosis",
    ),
    (
        "ns_per_sample_slice",
        "ns",
        "push_slice on this host, one core, median of 15 runs",
    ),
    (
        "ns_per_sample",
        "ns",
        "push on this host, one core, median of 15 runs",
    ),
];

const NOTE: &str = "QEMU counts instructions, not cycles";

/// One core in both precisions: its budgets, or the most expensive ones of a thousand fits and looks.
pub(crate) fn of_core(core: &str, worst: bool) -> Result<()> {
    let measure = if worst {
        measure::worst
    } else {
        measure::measured
    };
    println!("{:#}", budgets::of_core(core, measure)?);
    Ok(())
}

pub(crate) fn run(json: bool, update_budgets: bool) -> Result<()> {
    if !json {
        setup::run()?;
    }
    let way = Way::in_use()?;
    ensure!(
        !update_budgets || way == Way::Rustup,
        "budgets are those of rustup's toolchain, and {way} is in use"
    );
    let mut measured = budgets::measured()?;
    if update_budgets {
        budgets::update(&measured)?;
        println!("written: {}", budgets::path().display());
        println!(
            "for host-tests/doc/firmware.md:\n\n{}",
            figures::readme(&measured)?
        );
        return Ok(());
    }
    let host = host()?;
    if json {
        for (core, entry) in Core::all().zip(entries(&mut measured)) {
            entry["bits_equal_host"] = agreement::difference(&core)?.is_none().into();
        }
        for precision in Precision::ALL {
            measured[budgets::target(precision)]["note"] = NOTE.into();
        }
        measured["toolchain"] = way.name().into();
        measured["host"] = host.into();
        println!("{measured:#}");
        return Ok(());
    }
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_header(["figure", "single", "double", "unit", "meaning"]);
    for (name, unit, of) in FIGURES {
        let [single, double] = Precision::ALL.map(|precision| {
            let target = &measured[budgets::target(precision)];
            target.get(name).map(shown_number)
        });
        // Times on the host are measured in one precision only.
        let single = single.or_else(|| host.get(name).map(shown_number));
        let single = single.with_context(|| format!("{name} was not measured"))?;
        table.add_row([name, &single, &double.unwrap_or_default(), unit, of]);
    }
    println!("toolchain: {way}\n\nCortex-M4F and this host\n{table}\n");
    println!("every core\n{}\n{NOTE}.", core_table(&mut measured));
    Ok(())
}

/// Measures the costs again, and compares them with the budgets, which are those of rustup's toolchain.
pub(crate) fn check_budgets() -> Result<()> {
    println!("\n== budgets of every core");
    let way = Way::in_use()?;
    if way != Way::Rustup {
        println!("      skipped: they are those of rustup's toolchain, and {way} is in use");
        return Ok(());
    }
    budgets::check(&budgets::measured()?, &budgets::committed()?)
}

fn entries(measured: &mut Value) -> impl Iterator<Item = &mut Value> {
    measured["cores"].as_array_mut().into_iter().flatten()
}

/// A table with a row for each core and a column for each figure.
fn core_table(measured: &mut Value) -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for entry in entries(measured) {
        let figures = entry.as_object().into_iter().flatten();
        let (names, values): (Vec<_>, Vec<_>) = figures.unzip();
        table.set_header(names);
        table.add_row(values.into_iter().map(shown_number));
    }
    table
}

fn shown_number(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        Value::String(text) => text.clone(),
        _ => "–".into(),
    }
}

/// The figures that `host-tests/benches/accumulator.rs` prints.
fn host() -> Result<Map<String, Value>> {
    let mut command = cargo();
    command.args([
        "bench",
        "--package",
        "allanite-host",
        "--bench",
        "accumulator",
    ]);
    let _heartbeat = Heartbeat::new("the bench on this host".into());
    let output = command
        .stderr(std::process::Stdio::inherit())
        .output()
        .with_context(|| format!("`{}` did not start", shown(&command)))?;
    if !output.status.success() {
        bail!("`{}` failed ({})", shown(&command), output.status);
    }
    measure::named_numbers(String::from_utf8(output.stdout)?.lines())
}
