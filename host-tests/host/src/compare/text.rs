//! The text of a comparison.

use super::compared::Compared;
use crate::{
    fit,
    number::{duration, number, probability},
    words,
};
use allanite::fit::{ADEQUATE_P, State};
use allanite_plot::{Figure, Frame, Plot, Quantity, View};
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::io::{self, Write};

/// A smaller share of the model's variance is shown as a dot: it would round to 0 %.
const LEAST_SHARE: f32 = 0.005;

/// Prints a table and a plot of every axis, and what to do next.
pub fn print(compared: &[Compared], output: &mut impl Write) -> io::Result<()> {
    for (i, compared) in compared.iter().enumerate() {
        if i > 0 {
            writeln!(output)?;
        }
        print_axis(compared, output)?;
    }
    let differs = compared.iter().any(|one| {
        let p = one.comparison.p_value;
        p.is_finite() && p < ADEQUATE_P
    });
    let next = match differs {
        true => "next: `diagnose` looks for what the model lacks; --with adds an effect by hand",
        false => "next: `export` writes the model for a filter, with the same --with and --without",
    };
    writeln!(output, "\n{next}")
}

fn print_axis(compared: &Compared, output: &mut impl Write) -> io::Result<()> {
    let Compared {
        axis,
        model,
        fit,
        comparison,
        spectrum,
        held_out,
    } = compared;
    let record = words::record(axis.samples, axis.rate_hz, axis.octaves.len());
    let part = held_out.as_ref().map_or("", |_| "fitted to the first ");
    writeln!(output, "{}: {part}{record}", axis.axis)?;
    for (place, term) in model.terms().iter().enumerate() {
        let shape = words::shape(term, Some((fit, place)));
        if !shape.is_empty() {
            writeln!(output, "with {}: {shape}", words::plain(term.effect.name()))?;
        }
    }
    writeln!(output, "{}", fit::table::table(fit, axis.unit))?;
    if let Some(held_out) = held_out {
        writeln!(
            output,
            "\nin the fitted part: χ² {:.1}, {} degrees of freedom",
            fit.chi_squared, fit.degrees_of_freedom
        )?;
        let rest = &held_out.axis;
        let record = words::record(rest.samples, rest.rate_hz, rest.octaves.len());
        writeln!(
            output,
            "compared with the last {record}, which were held out"
        )?;
    }
    writeln!(output)?;
    writeln!(output, "{}", octaves(compared).trim_fmt())?;
    writeln!(output)?;
    let against = held_out
        .as_ref()
        .map_or("the record", |_| "the held-out part");
    let view = View {
        model,
        fit,
        comparison,
        spectrum,
        errors: &[],
        interval_s: 1.0 / axis.rate_hz,
    };
    for quantity in Quantity::ALL {
        if quantity == Quantity::Density && comparison.bins.is_empty() {
            continue;
        }
        let frame = Frame::of(quantity, [comparison]);
        let figure = Figure::new(&view, &frame);
        let name = quantity.name();
        let title = format!("{}: {name} of {against} and of the model", axis.axis);
        writeln!(output, "{}", Plot::new(&title, axis.unit, &figure, &frame))?;
    }
    let p = match comparison.p_value {
        p if p.is_finite() => format!(", p {}", probability(p)),
        _ => String::new(),
    };
    writeln!(
        output,
        "{}: χ² {:.1}, {} degrees of freedom{p}",
        axis.axis, comparison.chi_squared, comparison.degrees_of_freedom
    )?;
    writeln!(output, "{}: {comparison}", axis.axis)
}

/// The table of octaves: measured and model deviations, their difference, and the share of each effect
/// in the model's variance.
fn octaves(compared: &Compared) -> Table {
    let unit = compared.axis.unit;
    // Effects with a coefficient of zero have no column.
    let coefficients = compared.fit.coefficients.iter().enumerate();
    let shown: Vec<(usize, &'static str)> = coefficients
        .filter(|(_, coefficient)| coefficient.square > 0.0 || coefficient.state == State::Measured)
        .map(|(i, coefficient)| (i, coefficient.symbol))
        .collect();
    let mut table = Table::new();
    table.load_style(NOTHING);
    let measured = format!("measured, {unit}");
    let header = ["τ", &measured, "model", "difference", "z"].map(String::from);
    let shares = shown.iter().map(|(_, symbol)| format!("{symbol} %"));
    table.set_header(header.into_iter().chain(shares));
    for octave in &compared.comparison.octaves {
        let row = [
            duration(octave.tau_s),
            number(octave.measured.sqrt()),
            number(octave.model.sqrt()),
            format!("{:+.1} %", octave.percent()),
            format!("{:+.1}", octave.z),
        ];
        let share = |&(i, _): &(usize, &str)| match octave.shares.get(i) {
            Some(&share) if share >= LEAST_SHARE => format!("{:.0}", 100.0 * share),
            _ => "·".into(),
        };
        table.add_row(row.into_iter().chain(shown.iter().map(share)));
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
