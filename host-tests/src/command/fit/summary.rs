//! The coefficients of many files in one table, with one row for each axis.

use super::{fitted::Fitted, table::customary};
use crate::command::{input::many::shown, output::number::probability};
use allanite::fit::Fit;
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::{
    io::{self, Write},
    path::Path,
};

/// The columns; coefficients are in customary units, in the order of the fit.
const HEADER: [&str; 10] = [
    "file",
    "axis",
    "Q arcsec",
    "N °/√h",
    "B °/h",
    "K °/h^1.5",
    "R °/h²",
    "χ²/dof",
    "p",
    "adequate",
];

/// Prints the table, and a line that explains its signs.
pub(super) fn print(found: &[(&Path, Vec<Fitted>)], output: &mut impl Write) -> io::Result<()> {
    if found.is_empty() {
        return Ok(());
    }
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(HEADER);
    for (path, axes) in found {
        for fitted in axes {
            table.add_row(row(path, fitted));
        }
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if (2..8).contains(&i) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    writeln!(output, "{}", table.trim_fmt())?;
    writeln!(output, "<: upper bound; –: not observable in that record")
}

fn row(path: &Path, fitted: &Fitted) -> Vec<String> {
    let Fitted { axis, fit, .. } = fitted;
    let mut row = vec![shown(path), axis.axis.clone()];
    let coefficients = fit.coefficients.iter();
    row.extend(coefficients.map(|one| customary(one, axis.unit)));
    let per_freedom = fit.chi_squared / fit.degrees_of_freedom as f64;
    row.push(if per_freedom.is_finite() {
        format!("{per_freedom:.2}")
    } else {
        "–".into()
    });
    row.push(if fit.p_value.is_finite() {
        probability(fit.p_value).trim_start_matches("= ").to_owned()
    } else {
        "–".into()
    });
    row.push(if fitted.invalid.is_some() {
        "not valid".into()
    } else {
        adequate(fit).into()
    });
    row
}

fn adequate(fit: &Fit) -> &'static str {
    match fit.is_adequate() {
        Some(true) => "yes",
        Some(false) => "no",
        None => "–",
    }
}
