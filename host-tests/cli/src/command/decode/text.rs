//! Factory certificates and snapshots as text.

use super::decoded::{self, Decoded, Stored, StoredSnapshot};
use allanite::{
    effect::{Effect, IEEE_952, Parameter},
    storage::{
        AxisCertificate, Certificate, CertifiedLimit, CertifiedShape, CertifiedState, CertifiedTerm,
    },
};
use allanite_host::{
    number::{duration, number, probability},
    stationarity::is_disturbed,
    units,
    verdict::{ambiguous, certified},
    words,
};
use allanite_log::unit::Unit;
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::io::{self, Write};

/// Prints one factory certificate in full, or a table of several, and then the snapshots.
pub(super) fn print(decoded: &[Decoded], output: &mut impl Write) -> io::Result<()> {
    let mut records = Vec::new();
    for one in decoded {
        if let Stored::Certificate(record) = &one.stored {
            records.push(record.as_ref());
        }
    }
    match records[..] {
        [] => {}
        [record] => print_record(record, output)?,
        _ => writeln!(output, "{}", devices(&records).trim_fmt())?,
    }
    let mut first = records.is_empty();
    for one in decoded {
        if let Stored::Snapshot(snapshot) = &one.stored {
            if !first {
                writeln!(output)?;
            }
            first = false;
            print_snapshot(one, snapshot, output)?;
        }
    }
    Ok(())
}

fn print_record(record: &Certificate, output: &mut impl Write) -> io::Result<()> {
    let conditions = &record.conditions;
    writeln!(
        output,
        "{}: firmware {}, {} samples at {} Hz ({}), {}, {}",
        decoded::device(record),
        decoded::firmware(record),
        conditions.samples,
        conditions.rate_hz,
        duration(conditions.duration_s),
        gaps(conditions.gaps),
        temperature(record),
    )?;
    for (i, axis) in record.axes.iter().enumerate() {
        writeln!(output, "\n{}: {}", decoded::axis_name(i), judgement(axis))?;
        writeln!(output, "{}", terms(axis, record.unit.into()).trim_fmt())?;
        writeln!(
            output,
            "χ² {:.1}, {} degrees of freedom{}",
            axis.chi_squared,
            axis.degrees_of_freedom,
            p_value(axis, ", p ")
        )?;
        for finding in findings(axis, record.unit.into()) {
            writeln!(output, "{finding}")?;
        }
        if !axis.limits.is_empty() {
            writeln!(output, "{}", words::LIMITS)?;
        }
        for range in axis.limits.iter().filter_map(CertifiedLimit::range) {
            writeln!(output, "  {}", words::limit(&range, record.unit.into()))?;
        }
    }
    Ok(())
}

fn gaps(gaps: u64) -> String {
    match gaps {
        0 => "no gap".into(),
        1 => "1 gap".into(),
        _ => format!("{gaps} gaps"),
    }
}

fn temperature(record: &Certificate) -> String {
    match record.conditions.temperature_c {
        Some((low, high)) => format!("{low} … {high} °C"),
        None => "temperature unknown".into(),
    }
}

fn p_value(axis: &AxisCertificate, before: &str) -> String {
    let p = axis.p_value;
    if p.is_finite() {
        format!("{before}{}", probability(p))
    } else {
        String::new()
    }
}

/// The verdict, with the effects that were found.
fn judgement(axis: &AxisCertificate) -> String {
    let found = words::list(axis.found().map(|term| term.effect.name()));
    certified(axis.verdict, is_disturbed(axis), &found)
}

/// What a diagnosis found besides the terms, one line each.
fn findings(axis: &AxisCertificate, unit: Unit) -> Vec<String> {
    let found = &axis.findings;
    let mut lines = Vec::new();
    for slope in &found.covariates {
        lines.push(format!(
            "follows covariate {} with {} ± {} {unit} per unit of it; the curve is that without it",
            slope.covariate,
            number(slope.value.into()),
            number(slope.error.into()),
        ));
    }
    for group in found.doubts.chunk_by(|a, b| a.effect == b.effect) {
        let others = group.iter().map(|doubt| doubt.other.name());
        lines.push(format!(
            "{}: {}",
            words::plain(group[0].effect.name()),
            ambiguous(&words::alternatives(others)),
        ));
    }
    for band in &found.bands {
        let band = words::band(&band.band());
        lines.push(format!("unexplained in the spectrum: {band}"));
    }
    match &found.events {
        None => {}
        Some(events) if events.is_empty() => lines.push("the record is stationary".into()),
        Some(events) => {
            let told = events
                .iter()
                .map(|event| words::event(&event.event(), unit));
            lines.extend(told);
        }
    }
    lines
}

fn columns(header: impl IntoIterator<Item = String>) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(header);
    table
}

fn finish(mut table: Table, right: impl Fn(usize) -> bool) -> Table {
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if right(i) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// The table of one axis: one row for each term.
fn terms(axis: &AxisCertificate, unit: Unit) -> Table {
    let header = [
        "effect",
        "",
        "value",
        "95 % interval",
        "unit",
        "state",
        "shape",
    ];
    let mut table = columns(header.map(String::from));
    for term in &axis.terms {
        let effect = term.effect.effect();
        table.add_row([
            words::plain(term.effect.name()),
            effect.map_or("", |effect| effect.symbol()).into(),
            value(term, 1.0),
            match term.state {
                CertifiedState::Measured => format!(
                    "{} … {}",
                    number(term.lower.into()),
                    number(term.upper.into())
                ),
                CertifiedState::UpperBound => "interval includes 0".into(),
                CertifiedState::NotObservable { .. } => "–".into(),
            },
            effect.map_or(String::new(), |effect| {
                units::unit(unit, effect.half_seconds())
            }),
            match term.state {
                CertifiedState::Measured => "measured".into(),
                CertifiedState::UpperBound => "upper bound".into(),
                CertifiedState::NotObservable { after_s: None } => "not observable".into(),
                CertifiedState::NotObservable {
                    after_s: Some(after_s),
                } => format!(
                    "not observable; a record of {} would show it above {}",
                    duration(after_s.into()),
                    number(f64::from(term.upper))
                ),
            },
            shape(term, effect),
        ]);
    }
    finish(table, |i| i == 2)
}

fn value(term: &CertifiedTerm, factor: f64) -> String {
    match term.state {
        CertifiedState::Measured => number(factor * f64::from(term.value)),
        CertifiedState::UpperBound => format!("< {}", number(factor * f64::from(term.upper))),
        CertifiedState::NotObservable { .. } => "–".into(),
    }
}

fn shape(term: &CertifiedTerm, effect: Option<&dyn Effect>) -> String {
    let parameters = effect.map_or(&[][..], |effect| effect.parameters());
    let one = |(parameter, shape): (&Parameter, &CertifiedShape)| {
        let interval = match shape.lower.is_finite() && shape.upper.is_finite() {
            true => format!(
                " ({} … {})",
                number(shape.lower.into()),
                number(shape.upper.into())
            ),
            false => String::new(),
        };
        words::shape_value(parameter, shape.value.into()) + &interval
    };
    let parameters = parameters.iter().zip(&term.shape).map(one);
    parameters.collect::<Vec<_>>().join(", ")
}

/// The table of several devices: one row for each axis, in customary units, which makes rows comparable.
fn devices(records: &[&Certificate]) -> Table {
    let customary = |effect: &&dyn Effect| {
        let customary = units::customary(Unit::DegreesPerSecond, effect.half_seconds());
        format!(
            "{} {}",
            effect.symbol(),
            customary.map_or("", |(_, name)| name)
        )
    };
    let before = ["device", "firmware", "temperature", "axis"].map(String::from);
    let after = ["p", "verdict"].map(String::from);
    let header = before.into_iter().chain(IEEE_952.iter().map(customary));
    let mut table = columns(header.chain(after));
    for record in records {
        for (i, axis) in record.axes.iter().enumerate() {
            let about = [
                decoded::device(record),
                decoded::firmware(record),
                temperature(record),
                decoded::axis_name(i),
            ];
            let coefficient = |effect: &&dyn Effect| {
                let unit = Unit::from(record.unit);
                let (factor, _) =
                    units::customary(unit, effect.half_seconds()).unwrap_or((1.0, ""));
                let mut terms = axis.terms.iter();
                let term = terms.find(|term| term.effect.name() == effect.name());
                term.map_or("–".into(), |term| value(term, factor))
            };
            let end = [p_value(axis, ""), judgement(axis)];
            let row = about.into_iter().chain(IEEE_952.iter().map(coefficient));
            table.add_row(row.chain(end));
        }
    }
    finish(table, |i| (4..9).contains(&i))
}

fn print_snapshot(
    decoded: &Decoded,
    snapshot: &StoredSnapshot,
    output: &mut impl Write,
) -> io::Result<()> {
    writeln!(
        output,
        "{}: snapshot of {} samples, {}, {} octaves",
        decoded.file.display(),
        snapshot.samples,
        gaps(snapshot.gaps),
        snapshot.octaves.len()
    )?;
    let mut table = columns(["m", "differences", "deviation"].map(String::from));
    for octave in &snapshot.octaves {
        let m = f64::from(octave.m);
        let mean = octave.sum.to_real() / octave.differences as f64;
        let deviation = match octave.differences {
            0 => "–".into(),
            _ => format!("{} counts", number((0.5 * mean).sqrt() / m)),
        };
        let numbers = [octave.m.to_string(), octave.differences.to_string()];
        table.add_row(numbers.into_iter().chain([deviation]));
    }
    writeln!(output, "{}", finish(table, |_| true).trim_fmt())
}
