//! The page of a report: what stands in it without a script, and what the script takes.

use crate::{
    command::{
        diagnose::{diagnosed::Diagnosed, words::lead},
        output::words,
    },
    plot,
};
use allanite::{
    diagnosis::{Options, Verdict},
    fit::ADEQUATE_P,
};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::{collections::BTreeSet, path::Path};

const STYLE: &str = include_str!("../../report/page.css");
/// Draws a figure, walks through the steps.
const SCRIPTS: [&str; 2] = [
    include_str!("../../report/figure.js"),
    include_str!("../../report/page.js"),
];
/// The page takes nothing from anywhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// What the page is made of.
pub(super) struct Content<'a> {
    pub(super) input: &'a Path,
    pub(super) diagnosed: &'a [Diagnosed],
    /// What the script shows.
    pub(super) json: &'a str,
    /// What is shown without a script.
    pub(super) text: &'a str,
}

/// The page.
pub(super) fn page(content: &Content) -> String {
    let name = content
        .input
        .file_name()
        .unwrap_or(content.input.as_os_str());
    let name = name.to_string_lossy();
    // No `<` in a script element can end it.
    let json = content.json.replace('<', "\\u003c");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { "Gyro noise of " (name) }
                style { (PreEscaped(STYLE)) (PreEscaped(plot::effect_styles())) }
            }
            body {
                header {
                    h1 { "Gyro noise of " span.name { (name) } }
                    (summary(content.diagnosed))
                }
                main {
                    (introduction())
                    @for (number, diagnosed) in content.diagnosed.iter().enumerate() {
                        (axis(number, diagnosed))
                    }
                    noscript {
                        section { h2 { "The diagnosis in full" } pre { (content.text) } }
                    }
                    (settings(content))
                }
                script type="application/json" id="data" { (PreEscaped(json)) }
                @for script in SCRIPTS { script { (PreEscaped(script)) } }
            }
        }
    };
    page.into_string()
}

/// One sentence an axis.
fn summary(diagnosed: &[Diagnosed]) -> Markup {
    html! {
        ul.summary {
            @for (number, diagnosed) in diagnosed.iter().enumerate() {
                @let (class, verdict) = badge(diagnosed);
                li class=(class) {
                    a href={ "#axis-" (number) } { (diagnosed.axis.axis) }
                    " " span.badge { (verdict) }
                    p { (lead(diagnosed)) }
                }
            }
        }
    }
}

/// The verdict in a word or two, and its class.
fn badge(diagnosed: &Diagnosed) -> (&'static str, &'static str) {
    match diagnosed.verdict {
        Verdict::Adequate => ("good", "five terms suffice"),
        Verdict::Improved => ("found", "effects found"),
        Verdict::Unexplained => ("open", "unexplained"),
        Verdict::TooShort => ("open", "too short to judge"),
        Verdict::Invalid(_) => ("open", "record invalid"),
        _ => ("open", "unknown"),
    }
}

fn introduction() -> Markup {
    html! {
        section.introduction aria-label="How to read this page" {
            p {
                "The Allan deviation σ(τ) is how much the rate, averaged over a time τ, typically "
                "changes from one average to the next. Five noise terms (IEEE 952) should add up to "
                "it. Where the measured dots leave the model’s line, something else is in the record. "
                "χ² sums up how far they do, in units of their scatter: about as large as the degrees "
                "of freedom is as good as it gets. Each step adds the effect that explains most."
            }
            fieldset #units hidden {
                legend { "Units" }
                label { input type="radio" name="unit" value="0" checked; " those of the log" }
                label { input type="radio" name="unit" value="1"; " customary (°/h, °/√h)" }
            }
        }
    }
}

fn axis(number: usize, diagnosed: &Diagnosed) -> Markup {
    let axis = &diagnosed.axis;
    let record = words::record(axis.samples, axis.rate_hz, axis.octaves.len());
    let notes = diagnosed.notes();
    html! {
        section.axis id={ "axis-" (number) } aria-label={ "Axis " (axis.axis) } {
            h2 { (axis.axis) }
            p.record { (record) }
            // Filled by the script.
            div.walk data-axis=(number) {}
            @if !notes.is_empty() {
                div.notes {
                    h3 { "To note" }
                    ul { @for note in &notes { li { (note) } } }
                }
            }
        }
    }
}

/// All that it takes to make the page again.
fn settings(content: &Content) -> Markup {
    let default = Options::default();
    let options = content.diagnosed.first().map_or(default, |one| one.options);
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|argument| argument.to_string_lossy().into_owned());
    let words = std::iter::once("allanite".to_owned()).chain(arguments);
    let command = words
        .map(|word| quoted(&word))
        .collect::<Vec<_>>()
        .join(" ");
    let settings = [
        ("input", content.input.to_string_lossy().into_owned()),
        ("command", command),
        ("version", format!("allanite {}", env!("CARGO_PKG_VERSION"))),
        (
            "tolerance of the model",
            format!("{} %", 100.0 * options.tolerance),
        ),
        ("adequate from", format!("p = {ADEQUATE_P}")),
        ("effects at most", options.max_effects.to_string()),
    ];
    html! {
        section.settings {
            h2 { "Options" }
            dl {
                @for (name, value) in &settings { dt { (name) } dd { (value) } }
            }
            @for source in sources(content.diagnosed) { p.record { "record: " (source) } }
        }
    }
}

/// Where the records come from, each place once.
fn sources(diagnosed: &[Diagnosed]) -> BTreeSet<String> {
    let axes = diagnosed.iter().map(|one| &one.axis);
    let named = axes.map(|axis| axis.source.iter().chain(&axis.licence));
    let named = named.map(|words| words.cloned().collect::<Vec<_>>().join(", "));
    named.filter(|words| !words.is_empty()).collect()
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
