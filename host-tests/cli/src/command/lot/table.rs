//! The results of a lot as one table: one row for each device and axis, whose columns are named with their units.

use super::{
    device::{Device, is_invalid},
    judgement::Judged,
    limited::Rule,
};
use crate::command::decode;
use allanite::{
    diagnosis::Verdict,
    effect::{Effect, IEEE_952},
    storage::{AxisCertificate, CertifiedState, CertifiedTerm},
};
use allanite_host::{
    lot::{Decision, Measurement, difference},
    stationarity::is_disturbed,
    units, verdict,
};
use std::{borrow::Cow, collections::BTreeMap};

/// A column. What is not known is `None`.
pub(super) struct Column<'a> {
    pub(super) name: String,
    pub(super) values: Values<'a>,
}

/// The values of a column, one a row.
pub(super) enum Values<'a> {
    Text(Vec<Option<Cow<'a, str>>>),
    Number(Vec<Option<f64>>),
    Count(Vec<u64>),
}

/// A row: an axis of a device.
struct Row<'a> {
    device: &'a Device,
    axis: usize,
    certificate: &'a AxisCertificate,
    earlier: Option<&'a Device>,
}

/// The number that has the digits of this one in single precision, in which certificates are stored.
fn short(value: f32) -> Option<f64> {
    let text = value.is_finite().then(|| value.to_string())?;
    text.parse().ok()
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// A unit as a part of a name that any program takes: `deg_per_s_per_sqrt_hz` for `deg/s/√Hz`.
pub(super) fn in_name(unit: &str) -> String {
    let mut name = String::new();
    for part in unit.split('/') {
        if !name.is_empty() {
            name.push_str("_per_");
        }
        for one in part.chars() {
            match one {
                '√' => name.push_str("sqrt_"),
                '²' => name.push('2'),
                '³' => name.push('3'),
                '·' => name.push('_'),
                one if one.is_ascii_alphanumeric() => name.push(one.to_ascii_lowercase()),
                _ => name.push('_'),
            }
        }
    }
    name
}

/// The decision as it is written in files, as those of `fit --limit`.
pub(super) const fn name(decision: Decision) -> &'static str {
    match decision {
        Decision::Passed => "pass",
        Decision::Guarded => "guard_band",
        Decision::Misfit => "misfit",
        Decision::NotStationary => verdict::NOT_STATIONARY,
        Decision::Invalid => "invalid",
        Decision::Failed => "fail",
    }
}

/// The columns of a lot.
pub(super) fn columns<'a>(judged: &Judged<'a>) -> Vec<Column<'a>> {
    let rows = judged.devices.iter().flat_map(|device| {
        let earlier = judged.before.get(device.id.as_str()).copied();
        let axes = device.certificate.axes.iter().enumerate();
        axes.map(move |(axis, certificate)| Row {
            device,
            axis,
            certificate,
            earlier,
        })
    });
    let rows: Vec<Row<'a>> = rows.collect();
    let mut columns = conditions(&rows);
    columns.extend(axis(&rows, judged));
    let mut effects: Vec<&'static dyn Effect> = IEEE_952.to_vec();
    for rule in judged.rules {
        let limited = rule.limit.effect;
        if !effects.iter().any(|one| one.name() == limited.name()) {
            effects.push(limited);
        }
    }
    for effect in effects {
        columns.extend(coefficient(&rows, judged, effect));
    }
    columns
}

/// A column of texts.
fn text<'a>(
    name: &str,
    rows: &[Row<'a>],
    value: impl Fn(&Row<'a>) -> Option<Cow<'a, str>>,
) -> Column<'a> {
    Column {
        name: name.into(),
        values: Values::Text(rows.iter().map(value).collect()),
    }
}

/// A column of numbers.
fn number<'a>(
    name: impl Into<String>,
    rows: &[Row<'a>],
    value: impl Fn(&Row<'a>) -> Option<f64>,
) -> Column<'a> {
    Column {
        name: name.into(),
        values: Values::Number(rows.iter().map(value).collect()),
    }
}

/// A column of counts.
fn count<'a>(name: &str, rows: &[Row<'a>], value: impl Fn(&Row<'a>) -> u64) -> Column<'a> {
    Column {
        name: name.into(),
        values: Values::Count(rows.iter().map(value).collect()),
    }
}

/// Which axis of which device it is, and how it was measured.
fn conditions<'a>(rows: &[Row<'a>]) -> Vec<Column<'a>> {
    let certificate = |row: &Row<'a>| &row.device.certificate;
    let temperature = |row: &Row<'a>| certificate(row).conditions.temperature_c;
    vec![
        text("device", rows, |row| Some(row.device.id.as_str().into())),
        text("axis", rows, |row| Some(decode::axis_name(row.axis).into())),
        text("file", rows, |row| Some(row.device.file.to_string_lossy())),
        text("source", rows, |row| Some(row.device.source.name().into())),
        text("firmware", rows, |row| {
            Some(decode::firmware(certificate(row)).into())
        }),
        number("temperature_low_degc", rows, |row| {
            short(temperature(row)?.0)
        }),
        number("temperature_high_degc", rows, |row| {
            short(temperature(row)?.1)
        }),
        number("duration_s", rows, |row| {
            finite(certificate(row).conditions.duration_s)
        }),
        number("sample_rate_hz", rows, |row| {
            finite(certificate(row).conditions.rate_hz)
        }),
        count("samples", rows, |row| certificate(row).conditions.samples),
        count("gaps", rows, |row| certificate(row).conditions.gaps),
    ]
}

/// What is known of an axis as a whole.
fn axis<'a>(rows: &[Row<'a>], judged: &Judged<'a>) -> Vec<Column<'a>> {
    let mut outlying: BTreeMap<(&str, &str), Vec<&'static str>> = BTreeMap::new();
    for one in &judged.lot.outliers {
        let effects = outlying.entry((&one.device, &one.axis)).or_default();
        effects.push(one.effect);
    }
    let listed = |names: Vec<&str>| (!names.is_empty()).then(|| names.join(";").into());
    vec![
        text("decision", rows, |row| {
            let decisions = judged.rules.iter().map(|rule| decision(row, rule));
            decisions.max().map(|one| name(one).into())
        }),
        text("verdict", rows, |row| {
            let axis = row.certificate;
            (axis.verdict).map(|verdict| verdict::name(verdict, is_disturbed(axis)).into())
        }),
        text("invalid_because", rows, |row| {
            match row.certificate.verdict {
                Some(Verdict::Invalid(reason)) => Some(reason.to_string().into()),
                _ => None,
            }
        }),
        number("chi_squared", rows, |row| {
            finite(row.certificate.chi_squared)
        }),
        count("degrees_of_freedom", rows, |row| {
            row.certificate.degrees_of_freedom.into()
        }),
        number("p_value", rows, |row| finite(row.certificate.p_value)),
        text("effects_found", rows, |row| {
            let found = row.certificate.found();
            listed(found.map(|term| term.effect.name()).collect())
        }),
        text("outlier_in", rows, |row| {
            let axis = decode::axis_name(row.axis);
            let names = outlying.get(&(row.device.id.as_str(), axis.as_str()))?;
            listed(names.clone())
        }),
    ]
}

/// The term of an effect. A record that is not valid has none.
fn term<'a>(row: &Row<'a>, effect: &dyn Effect) -> Option<&'a CertifiedTerm> {
    let mut terms = row.certificate.terms.iter();
    terms.find(|term| !is_invalid(row.certificate) && term.effect.name() == effect.name())
}

fn measurement(row: &Row<'_>, effect: &dyn Effect) -> Option<Measurement> {
    Measurement::of(term(row, effect)?)
}

fn decision(row: &Row<'_>, rule: &Rule) -> Decision {
    rule.decision(row.device, row.axis)
}

/// What is known of a coefficient: its value, its interval, and what its limit says.
fn coefficient<'a>(
    rows: &[Row<'a>],
    judged: &Judged<'a>,
    effect: &'static dyn Effect,
) -> Vec<Column<'a>> {
    let unit = in_name(&units::unit(judged.unit, effect.half_seconds()));
    let name_of = |part: &str| format!("{}{part}_{unit}", effect.name());
    let of_term = |part: &str, value: fn(&CertifiedTerm) -> f32| {
        number(name_of(part), rows, |row| short(value(term(row, effect)?)))
    };
    let mut columns = vec![
        of_term("", |term| term.value),
        of_term("_lower", |term| term.lower),
        of_term("_upper", |term| term.upper),
        text(&format!("{}_state", effect.name()), rows, |row| {
            let state = match term(row, effect)?.state {
                CertifiedState::Measured => "measured",
                CertifiedState::UpperBound => "upper_bound",
                CertifiedState::NotObservable { .. } => "not_observable",
            };
            Some(state.into())
        }),
    ];
    let mut rules = judged.rules.iter();
    if let Some(rule) = rules.find(|rule| rule.limit.effect.name() == effect.name()) {
        columns.extend([
            number(name_of("_limit"), rows, |_| Some(rule.limit.value)),
            text(&format!("{}_decision", effect.name()), rows, |row| {
                Some(name(decision(row, rule)).into())
            }),
            number(format!("{}_conformity", effect.name()), rows, |row| {
                rule.conformity(row.axis, measurement(row, effect))
            }),
        ]);
    }
    if !judged.before.is_empty() {
        let earlier = |row: &Row<'a>| {
            let certificate = row.earlier?.certificate.axes.get(row.axis)?;
            Some(Row {
                device: row.earlier?,
                axis: row.axis,
                certificate,
                earlier: None,
            })
        };
        columns.extend([
            number(name_of("_earlier"), rows, |row| {
                short(term(&earlier(row)?, effect)?.value)
            }),
            number(format!("{}_change_sigma", effect.name()), rows, |row| {
                let before = earlier(row)?;
                let [was, is] =
                    [&before, row].map(|one| one.device.certificate.conditions.duration_s);
                let pair = measurement(&before, effect).zip(measurement(row, effect));
                pair.and_then(|(before, now)| finite(difference(&before, &now, is / was)))
            }),
        ]);
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use allanite_log::unit::Unit;

    #[test]
    fn units_are_parts_of_names_that_every_program_takes() {
        let names =
            [2, 1, 0, -1, -2].map(|half| in_name(&units::unit(Unit::DegreesPerSecond, half)));
        let expected = [
            "deg",
            "deg_per_s_per_sqrt_hz",
            "deg_per_s",
            "deg_per_s_per_sqrt_s",
            "deg_per_s2",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn numbers_have_the_digits_of_single_precision() {
        assert_eq!(short(0.005_37), Some(0.005_37));
        assert_eq!(short(f32::INFINITY), None);
    }
}
