//! The coefficients of many files in one table of 80 columns, with one row for each axis below its file's name.

use crate::command::input::many::shown;
use allanite_host::{
    fit::{fitted::Fitted, table::customary},
    number::probability,
    verdict::ADEQUATE,
};
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::{
    io::{self, Write},
    path::Path,
};

/// The columns; coefficients are in customary units, in the order of the fit.
const HEADER: [&str; 8] = [
    "axis",
    "Q arcsec",
    "N °/√h",
    "B °/h",
    "K °/h^1.5",
    "R °/h²",
    "p",
    ADEQUATE,
];

/// Prints the table, and a line that explains its signs.
pub(super) fn print(found: &[(&Path, Vec<Fitted>)], output: &mut impl Write) -> io::Result<()> {
    if found.is_empty() {
        return Ok(());
    }
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(HEADER);
    for fitted in found.iter().flat_map(|(_, axes)| axes) {
        table.add_row(row(fitted));
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 1));
        if (1..7).contains(&i) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let rows = table.trim_fmt();
    let mut rows = rows.lines();
    writeln!(output, "{}", rows.next().unwrap_or_default())?;
    for (path, axes) in found {
        writeln!(output, "{}", shown(path))?;
        for row in rows.by_ref().take(axes.len()) {
            writeln!(output, "{row}")?;
        }
    }
    writeln!(output, "<: upper bound; –: not observable in that record")?;
    for (path, axes) in found {
        for (fitted, limit) in axes
            .iter()
            .flat_map(|one| one.limits.iter().map(move |limit| (one, limit)))
        {
            writeln!(
                output,
                "{}, {}: {}",
                shown(path),
                fitted.axis.axis,
                limit.words()
            )?;
        }
    }
    Ok(())
}

fn row(fitted: &Fitted) -> Vec<String> {
    let Fitted { axis, fit, .. } = fitted;
    let mut row = vec![axis.axis.clone()];
    let coefficients = fit.coefficients.iter();
    row.extend(coefficients.map(|one| customary(one, axis.unit)));
    row.push(if fit.p_value.is_finite() {
        probability(fit.p_value).trim_start_matches("= ").to_owned()
    } else {
        "–".into()
    });
    row.push(if fitted.is_valid() {
        adequate(fitted.is_adequate()).into()
    } else {
        "not valid".into()
    });
    row
}

fn adequate(adequate: Option<bool>) -> &'static str {
    match adequate {
        Some(true) => "yes",
        Some(false) => "no",
        None => "–",
    }
}
