//! The judgement of a lot as text.

use super::judgement::{Lot, reasons};
use allanite_host::{number::number, verdict, words::plain};
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::io::{self, Write};

/// So many devices of a list are printed. The JSON document has all.
const SHOWN: usize = 20;

/// Prints the judgement.
pub(super) fn print(lot: &Lot, output: &mut impl Write) -> io::Result<()> {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let [low, high] = lot.yield_interval.map(percent);
    writeln!(
        output,
        "{} device{}: {} pass, {} in a guard band, {}{}{}{} fail",
        lot.devices,
        if lot.devices == 1 { "" } else { "s" },
        lot.passed,
        lot.guarded,
        if_any(lot.misfit, "not explained"),
        if_any(lot.not_stationary, verdict::NOT_STATIONARY_IN_WORDS),
        if_any(lot.not_valid, "not valid"),
        lot.failed
    )?;
    writeln!(
        output,
        "yield {} ({low} … {high})\n",
        percent(lot.yield_share)
    )?;
    writeln!(output, "{}\n", limits(lot).trim_fmt())?;
    writeln!(output, "{}", distributions(lot).trim_fmt())?;
    list(output, "fail", &lot.failures, |one| {
        let [low, high] = one.interval.map(number);
        let place = place(&one.device, &one.axis, one.effect);
        format!(
            "{place} {} ({low} … {high}) {}",
            number(one.value),
            one.unit
        )
    })?;
    let reasons = reasons(&lot.invalid);
    list(output, "not valid, not judged", &reasons, String::clone)?;
    let heading = format!("{}, not judged", verdict::NOT_STATIONARY_IN_WORDS);
    list(output, &heading, &lot.disturbed, |one| {
        format!("{} {}: {}", one.device, one.axis, one.words)
    })?;
    list(
        output,
        "not explained, not judged",
        &lot.unexplained,
        |one| format!("{} {}", one.device, one.axis),
    )?;
    list(output, "outliers", &lot.outliers, |one| {
        let place = place(&one.device, &one.axis, one.effect);
        let (value, median) = (number(one.value), number(one.median));
        let median = match one.median_is_bound {
            true => format!("the median bound is {median}"),
            false => format!("the median is {median}"),
        };
        format!("{place} {value} {}, {median}", one.unit)
    })?;
    if lot.compared > 0 {
        writeln!(
            output,
            "\n{} {} earlier certificates; a change counts from {:.1} σ on",
            lot.compared,
            if lot.compared == 1 {
                "device has"
            } else {
                "devices have"
            },
            lot.drift_threshold
        )?;
    }
    list(output, "drifted", &lot.drifted, |one| {
        let place = place(&one.device, &one.axis, one.effect);
        let shown = |value, bound: Option<f64>| match bound {
            Some(bound) => format!("below {}", number(bound)),
            None => number(value),
        };
        let before = shown(one.before, one.before_bound);
        let now = shown(one.now, one.now_bound);
        format!("{place} {before} → {now} {} ({:+.1} σ)", one.unit, one.z)
    })?;
    let found = lot.found.iter();
    let found: Vec<String> = found
        .map(|(name, count)| format!("{} in {count}", plain(name)))
        .collect();
    if !found.is_empty() {
        writeln!(
            output,
            "\neffects that the five terms lack: {}",
            found.join(", ")
        )?;
    }
    Ok(())
}

/// So many devices, where there are some.
fn if_any(number: usize, what: &str) -> String {
    match number {
        0 => String::new(),
        number => format!("{number} {what}, "),
    }
}

fn place(device: &str, axis: &str, effect: &str) -> String {
    format!("{device} {axis}: {}", plain(effect))
}

/// What is decided: one row for each limit of each axis.
fn limits(lot: &Lot) -> Table {
    let header = [
        "",
        "",
        "limit",
        "accept",
        "",
        "pass",
        "guard",
        "undecided",
        "fail",
        "wrong",
    ];
    let rows = lot.limits.iter().map(|one| {
        let wrong = one.expected_false_passes + one.expected_false_failures;
        vec![
            plain(one.effect),
            one.axis.clone(),
            number(one.limit),
            one.accepted_up_to.map_or("–".into(), number),
            one.unit.clone(),
            one.passed.to_string(),
            one.guarded.to_string(),
            (one.misfit + one.not_stationary + one.not_valid).to_string(),
            one.failed.to_string(),
            format!("{wrong:.1}"),
        ]
    });
    table(&header, rows, &[2, 3, 5, 6, 7, 8, 9])
}

/// How the devices are distributed: one row for each limit of each axis.
fn distributions(lot: &Lot) -> Table {
    let header = ["", "", "Cpk", "", "5 %", "median", "95 %", "", "of"];
    let rows = lot.limits.iter().map(|one| {
        let percentiles = match one.percentiles {
            Some(values) => values.map(number),
            None => ["–"; 3].map(str::to_owned),
        };
        let interval = |[low, high]: [f64; 2]| format!("({low:.2} … {high:.2})");
        let mut row = vec![
            plain(one.effect),
            one.axis.clone(),
            one.cpk.map_or("–".into(), |cpk| format!("{cpk:.2}")),
            one.cpk_interval.map_or(String::new(), interval),
        ];
        row.extend(percentiles);
        row.extend([one.unit.clone(), one.measured.to_string()]);
        row
    });
    table(&header, rows, &[2, 4, 5, 6, 8])
}

/// A table whose columns with these numbers are aligned to the right.
fn table(header: &[&str], rows: impl Iterator<Item = Vec<String>>, right: &[usize]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(header);
    for row in rows {
        table.add_row(row);
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 1));
        if right.contains(&i) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// A list with its title, if it is not empty.
fn list<T>(
    output: &mut impl Write,
    title: &str,
    all: &[T],
    line: impl Fn(&T) -> String,
) -> io::Result<()> {
    if all.is_empty() {
        return Ok(());
    }
    writeln!(output, "\n{title}:")?;
    for one in all.iter().take(SHOWN) {
        writeln!(output, "  {}", line(one))?;
    }
    match all.len().saturating_sub(SHOWN) {
        0 => Ok(()),
        more => writeln!(output, "  and {more} more, which --json lists"),
    }
}
