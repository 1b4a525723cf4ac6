//! The devices that a page names: those that fail, that are unlike the others, and that have drifted.

use super::quantity::shown_unit;
use crate::command::lot::judgement::{Judged, reasons};
use allanite::effect::{CATALOGUE, Effect, IEEE_952};
use allanite_host::{number::number, words::plain};
use maud::{Markup, html};

/// So many devices of a list are named. The CSV and the JSON document have all.
const SHOWN: usize = 15;

/// A coefficient with the factor and the unit in which the page shows it.
fn unit_of(judged: &Judged<'_>, effect: &str) -> (f64, String) {
    let mut effects = IEEE_952.into_iter().chain(CATALOGUE);
    let found = effects.find(|one| one.name() == effect);
    found.map_or((1.0, String::new()), |effect: &'static dyn Effect| {
        shown_unit(judged, effect.half_seconds())
    })
}

/// The tables of a lot.
pub(super) fn findings(judged: &Judged<'_>) -> Markup {
    let lot = judged.lot;
    let failures = lot.failures.iter().map(|one| {
        let (factor, unit) = unit_of(judged, one.effect);
        let [low, high] = one.interval.map(|end| number(factor * end));
        [
            one.device.clone(),
            one.axis.clone(),
            plain(one.effect),
            format!("{} {unit}", number(factor * one.value)),
            format!("{low} … {high}"),
        ]
    });
    let outliers = lot.outliers.iter().map(|one| {
        let (factor, unit) = unit_of(judged, one.effect);
        let bound = if one.median_is_bound {
            " (of bounds)"
        } else {
            ""
        };
        [
            one.device.clone(),
            one.axis.clone(),
            plain(one.effect),
            format!("{} {unit}", number(factor * one.value)),
            format!("{}{bound}", number(factor * one.median)),
        ]
    });
    let drifted = lot.drifted.iter().map(|one| {
        let (factor, unit) = unit_of(judged, one.effect);
        let shown = |value: f64, bound: Option<f64>| match bound {
            Some(bound) => format!("below {}", number(factor * bound)),
            None => number(factor * value),
        };
        let before = shown(one.before, one.before_bound);
        let now = shown(one.now, one.now_bound);
        [
            one.device.clone(),
            one.axis.clone(),
            plain(one.effect),
            format!("{before} → {now} {unit}"),
            format!("{:+.1} σ", one.z),
        ]
    });
    html! {
        div.findings {
            (table("fail", "Devices that fail", ["value", "95 % interval"], failures, lot.failures.len()))
            (table("outliers", "Outliers", ["value", "median"], outliers, lot.outliers.len()))
            (table("drifted", "Drifted", ["earlier → now", "change"], drifted, lot.drifted.len()))
            (names("Not valid, not judged", "reasons", reasons(&lot.invalid).into_iter()))
            (names("Not stationary, not judged", "reasons",
                lot.disturbed.iter().map(|one| format!("{} {}: {}", one.device, one.axis, one.words))))
            (names("Not explained by the effects of the catalogue, not judged", "names",
                lot.unexplained.iter().map(|one| format!("{} {}", one.device, one.axis))))
        }
    }
}

/// A table with its title, if it has a row.
fn table(
    id: &str,
    title: &str,
    last: [&str; 2],
    rows: impl Iterator<Item = [String; 5]>,
    all: usize,
) -> Markup {
    html! {
        @if all > 0 {
            section id=(id) {
                h2 { (title) }
                // A table that is wider than a phone is moved by touch, and by keys once it has the focus.
                div.wide tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead {
                            tr {
                                th scope="col" { "device" } th scope="col" { "axis" } th scope="col" { "coefficient" }
                                @for name in last { th scope="col" { (name) } }
                            }
                        }
                        tbody {
                            @for row in rows.take(SHOWN) {
                                tr {
                                    th scope="row" { (row[0]) }
                                    @for cell in &row[1..] { td { (cell) } }
                                }
                            }
                        }
                    }
                }
                (more(all))
            }
        }
    }
}

/// How many are not shown.
fn more(all: usize) -> Markup {
    html! {
        @if all > SHOWN {
            p.pale { "and " (all - SHOWN) " more, which the output as .csv or --json lists" }
        }
    }
}

/// Axes by their names, if there are any.
fn names(title: &str, class: &str, all: impl ExactSizeIterator<Item = String>) -> Markup {
    let count = all.len();
    html! {
        @if count > 0 {
            section {
                h2 { (title) }
                ul class=(class) {
                    @for one in all.take(SHOWN) { li { (one) } }
                }
                (more(count))
            }
        }
    }
}
