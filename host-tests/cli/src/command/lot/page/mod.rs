//! A lot as a page: one HTML file with pictures, without a script, that needs nothing from elsewhere.

mod course;
mod distribution;
mod findings;
mod quantity;
mod scale;
mod sheet;

use super::judgement::{Judged, Lot};
use crate::command::output::shell::quoted;
use allanite_host::number::number;
use course::{in_order, since};
use distribution::distribution;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use quantity::{Quantity, quantities};

const STYLE: &str = include_str!("page.css");
/// The policy with which a browser loads nothing from elsewhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// The page as HTML.
pub(super) fn page(judged: &Judged<'_>) -> String {
    let (lot, quantities) = (judged.lot, quantities(judged));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { "Lot of " (count(lot.devices, "device")) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header { (summary(lot)) }
                main {
                    (pictures(&quantities, "distributions", "Distributions against their limits", DISTRIBUTIONS,
                        |one| Some(distribution(one))))
                    (findings::findings(judged))
                    (pictures(&quantities, "order", "From device to device", IN_ORDER, |one| Some(in_order(one))))
                    @if lot.compared > 0 {
                        (pictures(&quantities, "drift", "Since the earlier measurement", SINCE, since))
                    }
                    (settings(judged))
                }
            }
        }
    };
    page.into_string()
}

const DISTRIBUTIONS: &str = "Each bar counts devices. The solid line is the limit. A device left of the dashed line passes, if its \
    uncertainty is usual for the lot; between the lines lies the guard band, where the record is too short to tell. Devices \
    that only bound the coefficient are not drawn.";
const IN_ORDER: &str = "The devices stand in the order in which they were given, folders by the names of their files. Of many \
    devices, the line is the median of groups and the band has 90 % of each group; those that fail are dots.";
const SINCE: &str = "A device on the line has not changed. Those whose change is too large for the errors of both records \
    have drifted, and are named.";

/// So many things.
fn count(number: usize, thing: &str) -> String {
    let s = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{s}")
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// The result in a sentence and in a bar.
fn summary(lot: &Lot) -> Markup {
    let [low, high] = lot.yield_interval.map(percent);
    let all = lot.devices.max(1) as f64;
    let parts = [
        ("pass", "pass", lot.passed),
        ("guard", "are in a guard band", lot.guarded),
        (
            "none",
            "are not judged",
            lot.misfit + lot.not_stationary + lot.not_valid,
        ),
        ("fail", "fail", lot.failed),
    ];
    let mut from = 0.0;
    let bars = parts.map(|(class, _, number)| {
        let width = 100.0 * number as f64 / all;
        from += width;
        (class, from - width, width)
    });
    html! {
        h1 { "Lot of " (count(lot.devices, "device")) }
        p.yield { "Yield " strong { (percent(lot.yield_share)) } " " span.pale { "(95 % interval " (low) " to " (high) ")" } }
        svg.stack viewBox="0 0 100 6" preserveAspectRatio="none" aria-hidden="true" {
            @for (class, from, width) in bars {
                rect class=(class) x=(format!("{from:.2}")) width=(format!("{width:.2}")) y="0" height="6" {}
            }
        }
        ul.legend {
            @for (class, words, number) in parts {
                li { span class={ "key " (class) } {} strong { (number) } " " (words) }
            }
        }
        p { (lead(lot)) }
    }
}

/// What deserves attention, in words.
fn lead(lot: &Lot) -> String {
    let mut parts = Vec::new();
    let mut rows: Vec<_> = lot.limits.iter().filter(|one| one.failed > 0).collect();
    rows.sort_by_key(|one| std::cmp::Reverse(one.failed));
    if let Some(worst) = rows.first() {
        let effect = allanite_host::words::plain(worst.effect);
        parts.push(format!(
            "Most failures are by {effect} of axis {}: {}.",
            worst.axis,
            count(worst.failed, "device")
        ));
    } else {
        parts.push("No device exceeds a limit.".into());
    }
    if lot.guarded > 0 {
        let of = count(lot.guarded, "device");
        parts.push(format!("A longer record may decide {of}."));
    }
    let unjudged = lot.misfit + lot.not_stationary + lot.not_valid;
    if unjudged > 0 {
        let of = count(unjudged, "device");
        parts.push(format!(
            "Of {of}, nothing is decided: no model explains the record, something happened during it, or it is not one of a gyro at rest."
        ));
    }
    let mut devices: Vec<&str> = lot.outliers.iter().map(|one| one.device.as_str()).collect();
    devices.sort_unstable();
    devices.dedup();
    if !devices.is_empty() {
        let verb = if devices.len() == 1 { "is" } else { "are" };
        parts.push(format!(
            "{} {verb} unlike the others.",
            count(devices.len(), "device")
        ));
    }
    if lot.compared > 0 {
        let mut drifted: Vec<&str> = lot.drifted.iter().map(|one| one.device.as_str()).collect();
        drifted.sort_unstable();
        drifted.dedup();
        let (of, verb) = (
            count(lot.compared, "device"),
            if drifted.len() == 1 { "has" } else { "have" },
        );
        parts.push(format!(
            "Of {of} measured before, {} {verb} drifted.",
            drifted.len()
        ));
    }
    parts.join(" ")
}

/// A section with a picture for each coefficient that has one.
fn pictures(
    quantities: &[Quantity<'_>],
    id: &str,
    title: &str,
    words: &str,
    draw: impl Fn(&Quantity<'_>) -> Option<Markup>,
) -> Markup {
    let drawn: Vec<(&Quantity<'_>, Markup)> = quantities
        .iter()
        .filter_map(|one| Some((one, draw(one)?)))
        .collect();
    html! {
        @if !drawn.is_empty() {
            section id=(id) {
                h2 { (title) }
                p.pale { (words) }
                div.pictures {
                    @for (one, picture) in &drawn {
                        figure {
                            figcaption { (one.effect) ", " (one.axis) }
                            (picture)
                        }
                    }
                }
            }
        }
    }
}

/// The settings with which the page can be made again.
fn settings(judged: &Judged<'_>) -> Markup {
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|argument| argument.to_string_lossy().into_owned());
    let words = std::iter::once("allanite".to_owned()).chain(arguments);
    let command = words
        .map(|word| quoted(&word))
        .collect::<Vec<_>>()
        .join(" ");
    let version = concat!("allanite ", env!("CARGO_PKG_VERSION"));
    html! {
        section.settings {
            h2 { "How it was judged" }
            dl {
                dt { "risk of a wrong decision at a limit" } dd { (percent(judged.lot.risk)) }
                dt { "a change counts as drift from" } dd { (number(judged.lot.drift_threshold)) " σ on" }
                dt { "command" } dd { (shortened(&command)) }
                dt { "version" } dd { (version) }
            }
        }
    }
}

/// A command whose thousands of files are left out.
fn shortened(command: &str) -> String {
    const MOST: usize = 600;
    if command.chars().count() <= MOST {
        return command.to_owned();
    }
    let start: String = command.chars().take(MOST).collect();
    format!("{start} …")
}
