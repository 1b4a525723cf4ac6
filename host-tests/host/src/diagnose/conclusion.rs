//! The conclusion of all axes in a few lines: what was found on which axes, how sure it is, and what to do.

use super::{
    diagnosed::Diagnosed,
    lines::comb_words,
    words::{added_chi_squared, shown_p},
};
use crate::{known_filter, number::number, tried::per, verdict, words};
use allanite::{Coefficient, Term, covariate, diagnosis::Verdict, effect::Explanation, fit::State};

/// The most lines of a conclusion, with the one that says what to do next.
const MOST_LINES: usize = 5;

/// Two axes have the same oscillation if their frequencies differ by less than this share. Chosen by hand: intervals are
/// narrower, and a fan wanders by as much while it is measured.
const SAME_FREQUENCY: f64 = 0.02;

/// What was found on one axis.
struct Found<'a> {
    axis: &'a str,
    /// The name of the effect, or those of the columns that the rate follows.
    name: String,
    frequency_hz: Option<f64>,
    /// Where it is, such as `31.00 Hz`, before the axes; empty if it has no frequency.
    place: String,
    /// The names and values of what it has, such as `amplitude` and `0.0301 deg/s (0.0297 … 0.0304)`.
    values: Vec<(String, Value)>,
    chi_squared: Option<f64>,
    alternatives: Vec<&'static str>,
    explanation: Option<Explanation>,
}

/// A number with its unit and its 95 % interval.
struct Value {
    unit: String,
    value: f64,
    ends: Option<[f64; 2]>,
}

/// What to do after a diagnosis.
pub fn next(diagnosed: &[Diagnosed]) -> &'static str {
    let mut axes = diagnosed.iter();
    match axes.all(|one| matches!(one.verdict, Verdict::Invalid(_))) {
        true => "next: leave out what disturbed the record, or record again",
        false => {
            "next: `report` shows every step on a page, and `export` writes the model for a filter"
        }
    }
}

/// The conclusion: the verdicts, and the findings beginning with what explains most.
pub fn lines(diagnosed: &[&Diagnosed]) -> Vec<String> {
    let mut lines = verdicts(diagnosed);
    let found = grouped(diagnosed.iter().flat_map(|one| found(one)).collect());
    let room = MOST_LINES.saturating_sub(lines.len() + 1).max(1);
    let shown = found.iter().take(room);
    lines.extend(shown.map(|group| sentence(group, diagnosed.len())));
    if let Some(last) = lines.last_mut().filter(|_| found.len() > room) {
        *last += &format!("; and {} more below", found.len() - room);
    }
    lines
}

/// The verdict of the axes, a line for all axes of which the same is said.
fn verdicts(diagnosed: &[&Diagnosed]) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&Diagnosed>)> = Vec::new();
    for one in diagnosed {
        let said = said(one);
        match groups.iter_mut().find(|(other, _)| *other == said) {
            Some((_, axes)) => axes.push(one),
            None => groups.push((said, vec![one])),
        }
    }
    let line = |(said, axes): &(String, Vec<&Diagnosed>)| {
        let names = axes.iter().map(|one| one.axis.axis.clone()).collect();
        let p = axes.iter().filter_map(|one| one.ends());
        let p: Vec<String> = p.map(|(_, last)| shown_p(last.fit.p_value)).collect();
        let p = match matches!(axes[0].verdict, Verdict::Invalid(_) | Verdict::TooShort) {
            true => String::new(),
            // The sign is said once: `p = 0.103, 0.053 and 0.997`.
            false => format!(
                " (p {})",
                words::list_of(p)
                    .replace(", = ", ", ")
                    .replace(" and = ", " and ")
            ),
        };
        format!("{}: {said}{p}", words::list_of(names))
    };
    groups.iter().map(line).collect()
}

/// What is said of an axis in a few words, without its p-value.
fn said(diagnosed: &Diagnosed) -> String {
    let terms = match diagnosed.ends() {
        Some((first, _)) => known_filter::terms(&first.model),
        None => return String::new(),
    };
    if let Some(reason) = diagnosed.invalid() {
        return format!("not valid: {reason}");
    }
    let stationarity = &diagnosed.stationarity;
    let event = stationarity.strongest(diagnosed.axis.unit);
    let disturbed = event.filter(|_| stationarity.is_disturbed());
    let of_curve = verdict::concluded(diagnosed.verdict, &terms, disturbed.is_some());
    match disturbed {
        Some(event) => format!("{}, {event}; {of_curve}", verdict::NOT_STATIONARY_IN_WORDS),
        None => of_curve,
    }
}

/// What was found on an axis.
fn found(diagnosed: &Diagnosed) -> Vec<Found<'_>> {
    let Some((_, last)) = diagnosed.ends() else {
        return Vec::new();
    };
    let axis = diagnosed.axis.axis.as_str();
    let unit = diagnosed.axis.unit;
    let mut found = Vec::new();
    if let Some(followed) = &last.covariate {
        let value =
            |(slope, series): (covariate::Slope, &crate::dependence::candidates::Candidate)| {
                let (lower, upper) = slope.interval();
                let value = Value {
                    unit: per(&series.column, &series.form, unit),
                    value: slope.value,
                    ends: Some([lower, upper]),
                };
                ("slope".to_owned(), value)
            };
        found.push(Found {
            axis,
            name: words::list_of(
                diagnosed
                    .covariate(followed)
                    .into_iter()
                    .map(String::from)
                    .collect(),
            ),
            frequency_hz: None,
            place: String::new(),
            values: diagnosed.slopes(followed).into_iter().map(value).collect(),
            chi_squared: added_chi_squared(diagnosed, None),
            alternatives: Vec::new(),
            explanation: Some(covariate::EXPLANATION),
        });
    }
    for term in diagnosed.added() {
        let Some(at) = last
            .model
            .terms()
            .iter()
            .position(|one| std::ptr::eq(one, term))
        else {
            continue;
        };
        let name = words::name_in(term.effect, &last.model);
        found.push(effect(
            diagnosed,
            axis,
            (term, at, name),
            &last.fit.coefficients[at],
        ));
    }
    in_combs(diagnosed, found)
}

fn effect<'a>(
    diagnosed: &Diagnosed,
    axis: &'a str,
    (term, at, name): (&Term, usize, &'static str),
    coefficient: &Coefficient,
) -> Found<'a> {
    let unit = diagnosed.axis.unit;
    let is_oscillation = term.effect.replaces().is_none();
    let frequency = term.effect.parameters().first();
    let frequency = frequency.filter(|first| is_oscillation && first.name == "frequency_hz");
    let frequency_hz = frequency.map(|_| term.parameters[0]);
    let fit = diagnosed.ends().map(|(_, last)| &last.fit);
    let shapes = term.effect.parameters().iter().zip(term.parameters);
    let shapes = shapes.skip(usize::from(frequency_hz.is_some()));
    let mut values: Vec<(String, Value)> = shapes
        .map(|(parameter, value)| {
            let mut estimates = fit.into_iter().flat_map(|fit| fit.shape.iter());
            let estimate = estimates.find(|one| one.term == at && one.name == parameter.name);
            let value = Value {
                unit: parameter.unit.into(),
                value,
                ends: estimate.map(|one| [one.lower, one.upper]),
            };
            (words::without_unit(parameter.name, parameter.unit), value)
        })
        .collect();
    if coefficient.state == State::Measured
        && ["amplitude", "rms"].contains(&term.effect.coefficient())
    {
        let value = Value {
            unit: unit.to_string(),
            value: coefficient.value,
            ends: Some([coefficient.lower, coefficient.upper]),
        };
        values.push((term.effect.coefficient().into(), value));
    }
    let ambiguous = diagnosed.ambiguous();
    let mut ambiguous = ambiguous.filter(|(added, _)| *added == name);
    Found {
        axis,
        name: words::plain(name),
        frequency_hz,
        place: frequency_hz.map_or(String::new(), |hz| format!("{} Hz", number(hz))),
        values,
        chi_squared: added_chi_squared(diagnosed, Some(term)),
        alternatives: ambiguous
            .next()
            .map_or(Vec::new(), |(_, others)| others.to_vec()),
        explanation: words::explanation(name),
    }
}

/// Puts the lines of each comb into one finding.
fn in_combs<'a>(diagnosed: &Diagnosed, mut found: Vec<Found<'a>>) -> Vec<Found<'a>> {
    for comb in diagnosed.combs.iter().filter(|comb| comb.members.len() > 1) {
        let frequencies: Vec<f64> = comb
            .members
            .iter()
            .map(|(line, _)| diagnosed.lines[*line].frequency_hz)
            .collect();
        let is_member = |one: &Found| one.frequency_hz.is_some_and(|hz| frequencies.contains(&hz));
        let chi_squared = found.iter().filter(|one| is_member(one));
        let chi_squared = chi_squared.filter_map(|one| one.chi_squared).sum();
        let Some(first) = found.iter().position(is_member) else {
            continue;
        };
        let mut at = 0;
        found.retain(|one| {
            at += 1;
            at == first + 1 || !is_member(one)
        });
        let comb_hz = comb.fundamental_hz;
        found[first].place = comb_words(comb);
        found[first].frequency_hz = Some(comb_hz);
        found[first].name = "comb of lines".into();
        found[first].values.clear();
        found[first].chi_squared = Some(chi_squared);
    }
    found
}

/// The same findings of several axes together, those first that explain most.
fn grouped(found: Vec<Found<'_>>) -> Vec<Vec<Found<'_>>> {
    let mut groups: Vec<Vec<Found>> = Vec::new();
    for one in found {
        let is_same = |group: &&mut Vec<Found>| {
            let first = &group[0];
            let near = match (first.frequency_hz, one.frequency_hz) {
                (Some(a), Some(b)) => (a / b - 1.0).abs() < SAME_FREQUENCY,
                (a, b) => a == b,
            };
            first.name == one.name && near && group.iter().all(|other| other.axis != one.axis)
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    let weight = |group: &[Found]| -> f64 { group.iter().filter_map(|one| one.chi_squared).sum() };
    groups.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    groups
}

/// A finding of one or more axes in a sentence.
fn sentence(group: &[Found], axes: usize) -> String {
    let first = &group[0];
    let on = match group.len() {
        len if len == axes && axes == 3 => "all three axes".into(),
        len if len == axes && axes > 3 => format!("all {axes} axes"),
        _ => words::list_of(group.iter().map(|one| one.axis.to_owned()).collect()),
    };
    let is_covariate = first
        .explanation
        .is_some_and(|one| one.what == covariate::EXPLANATION.what);
    let mut text = match (first.place.as_str(), is_covariate) {
        (_, true) => format!("{on}: the rate follows {}", first.name),
        ("", _) => format!("{} on {on}", first.name),
        (place, _) => format!("{place} on {on}: {}", first.name),
    };
    for (at, (name, value)) in first.values.iter().enumerate() {
        let of_axes = group.iter().filter_map(|one| one.values.get(at));
        text += &format!(
            ", {name} {}",
            values(of_axes.map(|(_, value)| value), value)
        );
    }
    let falls: Vec<String> = group
        .iter()
        .filter_map(|one| one.chi_squared)
        .map(|fall| format!("{fall:.0}"))
        .collect();
    if !falls.is_empty() {
        text += &format!("; explains {} of χ²", words::list_of(falls));
    }
    let mut alternatives: Vec<&str> = group
        .iter()
        .flat_map(|one| &one.alternatives)
        .copied()
        .collect();
    alternatives.sort_unstable();
    alternatives.dedup();
    text += &match alternatives.is_empty() {
        true => String::new(),
        false => format!(", or else {}", words::alternatives(alternatives)),
    };
    if let Some(explanation) = first.explanation {
        let (origin, check) = (clause(explanation.origin), clause(explanation.check));
        text += &format!(". It may come from {origin}; {check}");
    }
    text
}

/// Values of several axes with their unit; a single one has its interval.
fn values<'a>(all: impl Iterator<Item = &'a Value>, first: &Value) -> String {
    let all: Vec<&Value> = all.collect();
    let numbers = all.iter().map(|one| match one.value.fract() {
        0.0 => one.value.to_string(),
        _ => number(one.value),
    });
    let numbers = words::list_of(numbers.collect());
    let unit = match first.unit.as_str() {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let interval = match (all.as_slice(), first.ends) {
        ([_], Some([lower, upper])) if upper.is_finite() => {
            format!(" ({} … {})", number(lower), number(upper))
        }
        _ => String::new(),
    };
    format!("{numbers}{unit}{interval}")
}

/// The first clause of an explanation.
fn clause(text: &str) -> &str {
    text.split(';').next().unwrap_or_default()
}
