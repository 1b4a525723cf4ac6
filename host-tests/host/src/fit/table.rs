//! The table of coefficients.

use super::fitted::{Fitted, MethodName};
use crate::{
    judgement::Judgement,
    known_filter::{described, known_filter},
    number::{duration, number, probability},
    rounding, units,
    verdict::of_five_terms,
    words,
};
use allanite::{
    Coefficient,
    effect::{AngleRandomWalk, Effect as _},
    fit::{Fit, State},
};
use allanite_log::unit::Unit;
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use std::io::{self, Write};

/// Prints one table for each axis, with the verdict below it.
pub fn print(fitted: &[Fitted], output: &mut impl Write) -> io::Result<()> {
    for (i, fitted) in fitted.iter().enumerate() {
        if i > 0 {
            writeln!(output)?;
        }
        let axis = &fitted.axis;
        let length_s = axis.samples as f64 / axis.rate_hz;
        writeln!(
            output,
            "{}: {} samples at {} Hz ({}), {} octaves, method {}",
            axis.axis,
            axis.samples,
            axis.rate_hz,
            duration(length_s),
            axis.octaves.len(),
            fitted.method.name()
        )?;
        if let Some(filter) = known_filter(&fitted.model) {
            writeln!(output, "behind {}", described(filter))?;
        }
        writeln!(output, "{}", table(&fitted.fit, axis.unit))?;
        if let Some(mean) = axis.mean_rate {
            writeln!(output, "mean rate {} {}", number(mean), axis.unit)?;
        }
        let note = rounding::note(axis, &fitted.fit);
        // Whether the model explains a curve that is not valid does not matter.
        let is_invalid = !fitted.is_valid();
        let lines = verdict(fitted);
        for line in lines.iter().take(if is_invalid { 1 } else { lines.len() }) {
            writeln!(output, "{line}")?;
        }
        match (&fitted.invalid, note) {
            (Some(reason), _) => writeln!(output, "The curve is not valid: {reason}.")?,
            (None, Some(note)) => writeln!(output, "Note: {note}.")?,
            (None, None) => {}
        }
        for note in fitted.covariate_notes() {
            writeln!(output, "Note: {note}.")?;
        }
        for limit in &fitted.limits {
            writeln!(output, "{}", limit.words())?;
        }
    }
    Ok(())
}

/// The table of a fit, which fits into 80 columns: one row for each coefficient, and below them the lengths of records
/// that would show those that this one does not show, if they are as large as it allows. No record promises more: whether a
/// random walk shows depends on how large it is.
pub fn table(fit: &Fit, unit: Unit) -> String {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(["effect", "", "value", "95 % interval", "unit", "customary"]);
    for coefficient in &fit.coefficients {
        table.add_row(row(coefficient, fit, unit));
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, if i == 0 { 1 } else { 2 }));
        if i == 2 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let needed = fit.coefficients.iter().filter_map(|coefficient| {
        let State::NotObservable { after_s } = coefficient.state else {
            return None;
        };
        let name = name(coefficient, fit, unit);
        let (upper, unit) = (
            number(coefficient.upper),
            units::unit(unit, coefficient.half_seconds),
        );
        Some(format!(
            "{name} above {upper} {unit} in {}",
            duration(after_s?)
        ))
    });
    let needed: Vec<String> = needed.collect();
    let rows = table.trim_fmt();
    match needed.is_empty() {
        true => rows,
        false => format!("{rows}\na longer record would show: {}", needed.join(", ")),
    }
}

/// The value of a coefficient times a factor, its upper bound, or a dash.
fn shown(coefficient: &Coefficient, factor: f64) -> String {
    match coefficient.state {
        State::Measured => number(factor * coefficient.value),
        State::UpperBound => format!("< {}", number(factor * coefficient.upper)),
        State::NotObservable { .. } => "–".into(),
    }
}

fn customary_unit(coefficient: &Coefficient, unit: Unit) -> (f64, &'static str) {
    units::customary(unit, coefficient.half_seconds).unwrap_or((1.0, ""))
}

/// The value, the bound or the dash in the customary unit.
pub fn customary(coefficient: &Coefficient, unit: Unit) -> String {
    shown(coefficient, customary_unit(coefficient, unit).0)
}

/// The 95 % interval in the customary unit.
pub fn interval(coefficient: &Coefficient, unit: Unit) -> String {
    scaled_interval(coefficient, customary_unit(coefficient, unit).0)
}

fn scaled_interval(coefficient: &Coefficient, factor: f64) -> String {
    match coefficient.state {
        State::Measured => format!(
            "{} … {}",
            number(factor * coefficient.lower),
            number(factor * coefficient.upper)
        ),
        State::UpperBound => "upper bound".into(),
        State::NotObservable { .. } => "not observable".into(),
    }
}

/// The name of a coefficient. White noise beside another white noise, which a filter passes, enters behind the filter.
fn name(coefficient: &Coefficient, fit: &Fit, unit: Unit) -> String {
    let is_white = coefficient.name == AngleRandomWalk.description().name;
    let mut others = fit.coefficients.iter();
    let is_alike =
        |other: &Coefficient| other.name != coefficient.name && other.symbol == coefficient.symbol;
    match is_white && others.any(is_alike) {
        true => words::plain(words::BEHIND_FILTER),
        false => words::of_sensor(coefficient.name, unit),
    }
}

fn row(coefficient: &Coefficient, fit: &Fit, unit: Unit) -> [String; 6] {
    let (_, customary_unit) = customary_unit(coefficient, unit);
    let customary = match coefficient.state {
        State::NotObservable { .. } => String::new(),
        _ => format!("{} {customary_unit}", customary(coefficient, unit)),
    };
    [
        name(coefficient, fit, unit),
        coefficient.symbol.into(),
        shown(coefficient, 1.0),
        scaled_interval(coefficient, 1.0),
        units::unit(unit, coefficient.half_seconds),
        match customary_unit {
            "" => String::new(),
            _ => customary,
        },
    ]
}

/// The state of a coefficient in words, with the length of the record that would show it.
pub fn state(coefficient: &Coefficient) -> String {
    match coefficient.state {
        State::Measured => "measured".into(),
        State::UpperBound => "upper bound".into(),
        State::NotObservable { after_s: None } => "not observable".into(),
        State::NotObservable {
            after_s: Some(after_s),
        } => {
            let (length, upper) = (duration(after_s), number(coefficient.upper));
            format!("not observable; a record of {length} would show it above {upper}")
        }
    }
}

/// One line with χ² and one with the judgement that follows from it.
fn verdict(fitted: &Fitted) -> Vec<String> {
    let Fitted {
        fit, method, model, ..
    } = fitted;
    let behind = known_filter(model).map_or(String::new(), |filter| {
        format!(" behind the {}", words::plain(filter.effect.name()))
    });
    if !fit.chi_squared.is_finite() {
        return vec![
            "This method has no error model and no χ²: judge the model with --method covariance."
                .into(),
        ];
    }
    let mut first = format!("χ² {}", words::goodness(fit));
    if fit.p_value.is_finite() {
        first += &format!(", p {}", probability(fit.p_value));
    }
    if fit.tolerance > 0.0 {
        first += &format!(", with a model tolerance of {} %", 100.0 * fit.tolerance);
    }
    if fit.shrinkage > 0.0 {
        first += &format!(
            ", correlations shrunk by {} %",
            number(100.0 * fit.shrinkage)
        );
    }
    let judgement = if let Some(judgement) = covariance_judgement(fitted) {
        judgement.sentence(&behind)
    } else if !fit.p_value.is_finite() {
        of_five_terms(&behind, None, "")
    } else if *method == MethodName::RelativeAccuracy {
        "This method treats octaves as independent: judge the model with --method covariance."
            .into()
    } else {
        of_five_terms(&behind, Some(fit.is_adequate() == Some(true)), "")
    };
    [first, judgement]
        .into_iter()
        .chain(words::widened(fit))
        .chain(words::unseen_flicker(fit, fitted.axis.rate_hz))
        .collect()
}

/// The verdict of the diagnosis beside a fit whose errors are those of the diagnosis.
fn covariance_judgement(fitted: &Fitted) -> Option<&Judgement> {
    let judgement = fitted.judgement.as_ref();
    judgement.filter(|_| fitted.method == MethodName::Covariance)
}
