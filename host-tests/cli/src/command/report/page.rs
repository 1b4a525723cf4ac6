//! The page of a report: its static content, and the data for its script.

use crate::command::{
    explore::Carried,
    output::{glossary, shell::quoted},
};
use allanite::{
    diagnosis::{Options, Verdict},
    fit::ADEQUATE_P,
};
use allanite_host::{
    diagnose::{
        conclusion,
        diagnosed::Diagnosed,
        words::{lead, limits},
    },
    verdict, words,
};
use allanite_log::failure::one_line;
use allanite_plot as plot;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::{collections::BTreeSet, path::Path};

const STYLE: &str = include_str!("../../report/page.css");
/// The scripts: the first ones have what every page needs and draw its figures, the others show an axis step by step.
const SCRIPTS: [&str; 14] = [
    include_str!("../../report/common.js"),
    include_str!("../../report/ticks.js"),
    include_str!("../../report/sheet.js"),
    include_str!("../../report/gloss.js"),
    include_str!("../../report/figure.js"),
    include_str!("../../report/legend.js"),
    include_str!("../../report/bars.js"),
    include_str!("../../report/plot.js"),
    include_str!("../../report/table.js"),
    include_str!("../../report/coefficients.js"),
    include_str!("../../report/walk.js"),
    include_str!("../../report/paper.js"),
    include_str!("../../report/address.js"),
    include_str!("../../report/page.js"),
];
/// The policy with which a browser loads nothing from elsewhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
    base-uri 'none'; form-action 'none'";
/// That of a report which carries a program: what it opens may compile that program and run it beside itself.
const POLICY_OF_PROGRAM: &str = "default-src 'none'; style-src 'unsafe-inline'; \
    script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; frame-src 'self'; img-src data:; \
    base-uri 'none'; form-action 'none'";

/// The content of the page.
pub(super) struct Content<'a> {
    pub(super) input: &'a Path,
    pub(super) diagnosed: &'a [Diagnosed],
    /// The data that the script shows.
    pub(super) json: &'a str,
    /// The text that is shown if scripts are off.
    pub(super) text: &'a str,
    /// The page on which effects are tried.
    pub(super) carried: Option<&'a Carried>,
}

/// The page as HTML.
pub(super) fn page(content: &Content) -> String {
    let name = content
        .input
        .file_name()
        .unwrap_or(content.input.as_os_str());
    let name = one_line(&name.to_string_lossy());
    // Without `<`, no text in the data can end the script element.
    let json = content.json.replace('<', "\\u003c");
    let glossary = serde_json::to_string(&glossary::words()).unwrap_or_default();
    let glossary = glossary.replace('<', "\\u003c");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(if content.carried.is_some() { POLICY_OF_PROGRAM } else { POLICY });
                title { "Gyro noise of " (name) }
                style { (PreEscaped(STYLE)) (PreEscaped(plot::effect_styles())) }
            }
            body {
                header {
                    h1 { "Gyro noise of " span.name { (name) } }
                    (summary(content.diagnosed))
                    @if content.carried.is_some() {
                        // The script gives it an address.
                        p.try { a #try hidden target="_blank" { "Try effects on these records" } }
                    }
                    // The findings stand beside their places below: this is the same in sentences, to be copied.
                    details.conclusion {
                        summary { "The conclusion in sentences" }
                        @for line in conclusion::lines(&content.diagnosed.iter().collect::<Vec<_>>()) { p { (line) } }
                    }
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
                script type="application/json" id="glossary" { (PreEscaped(glossary)) }
                @if let Some(carried) = content.carried { (explorer(carried)) }
                @for script in SCRIPTS { script { (PreEscaped(script)) } }
            }
        }
    };
    page.into_string()
}

/// The page on which effects are tried, with its records, and the script that opens it.
fn explorer(carried: &Carried) -> Markup {
    // Without `<`, no text can end a script element.
    let harmless = |text: String| PreEscaped(text.replace('<', "\\u003c"));
    let page = serde_json::to_string(&carried.page).unwrap_or_default();
    html! {
        script type="application/json" id="explorer" { (harmless(page)) }
        script type="application/json" id="session" { (harmless(carried.session.clone())) }
        script { (PreEscaped(include_str!("../../report/try.js"))) }
    }
}

/// The list of axes, with one sentence for each.
fn summary(diagnosed: &[Diagnosed]) -> Markup {
    html! {
        ul.summary {
            @for (number, diagnosed) in diagnosed.iter().enumerate() {
                @let (class, verdict) = badge(diagnosed);
                li class=(class) {
                    // The script draws the figure in which the five terms fail most.
                    div.picture data-axis=(number) {}
                    div {
                        a href={ "#axis-" (number) } data-axis=(number) { (diagnosed.axis.axis) }
                        " " span.badge { (verdict) }
                        p { (lead(diagnosed)) }
                    }
                }
            }
        }
    }
}

/// The class of the verdict in CSS, and the verdict in a few words.
fn badge(diagnosed: &Diagnosed) -> (&'static str, &'static str) {
    if diagnosed.stationarity.is_disturbed() {
        return ("open", verdict::NOT_STATIONARY_IN_WORDS);
    }
    let class = match diagnosed.verdict {
        Verdict::Adequate => "good",
        Verdict::Improved => "found",
        _ => "open",
    };
    (class, verdict::on_badge(diagnosed.verdict))
}

fn introduction() -> Markup {
    html! {
        section.introduction aria-label="How to read this page" {
            details {
                summary { "How to read this page" }
                p {
                    "Move over a figure, tap it or use the arrow keys to read the values of a point. Zoom by the wheel, by two "
                    "fingers or by the keys + and −, show all by 0, and move by dragging or by shift and the arrow keys. The "
                    "address keeps what is seen."
                }
            p {
                "The Allan deviation σ(τ) is how much the rate, averaged over a time τ, typically "
                "changes from one average to the next. The spectrum is the root of the one-sided power "
                "spectral density of the same record: a line is narrow there, a resonance is a hump, and "
                "a filter is an edge. In a simple record, the five noise terms of IEEE 952 add up to both. "
                "Where the measured dots leave the model’s line, " (verdict::ANOTHER_EFFECT) ". The bars "
                "are standard errors of the measurement. χ² is the squared distance of the dots from the "
                "line, each weighted by its error: for " (verdict::ADEQUATE_MODEL) ", χ² is about as large as the "
                "number of degrees of freedom. All steps share one scale of residuals, linear near zero "
                "and logarithmic beyond, so that the error is seen to fall. χ² is the one number that falls from step to step; what "
                "follows a recorded temperature counts for it until it is subtracted. Each step adds the effect that explains most."
                }
            }
            fieldset #units hidden {
                legend { "Units" }
                label { input type="radio" name="unit" value="0" checked; " as in the log" }
                label { input type="radio" name="unit" value="1"; " customary (°/h, °/√h)" }
            }
        }
    }
}

fn axis(number: usize, diagnosed: &Diagnosed) -> Markup {
    let axis = &diagnosed.axis;
    let record = words::record(axis.samples, axis.rate_hz, axis.octaves.len());
    let notes = diagnosed.notes();
    let limits = limits(diagnosed);
    html! {
        section.axis id={ "axis-" (number) } aria-label={ "Axis " (axis.axis) } {
            h2 { (axis.axis) }
            p.record { (record) }
            // The script fills this element.
            div.walk data-axis=(number) {}
            @if !limits.is_empty() {
                div.notes {
                    h3 { (words::LIMITS) }
                    ul { @for limit in &limits { li { (limit) } } }
                }
            }
            @if !notes.is_empty() {
                div.notes {
                    h3 { "Notes" }
                    ul { @for note in &notes { li { (note) } } }
                }
            }
        }
    }
}

/// The settings with which the page can be made again.
fn settings(content: &Content) -> Markup {
    let default = Options::default();
    let options = content
        .diagnosed
        .first()
        .map_or(default, |one| one.scope.options);
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|argument| one_line(&argument.to_string_lossy()));
    let words = std::iter::once("allanite".to_owned()).chain(arguments);
    let command = words
        .map(|word| quoted(&word))
        .collect::<Vec<_>>()
        .join(" ");
    let settings = [
        ("input", one_line(&content.input.to_string_lossy())),
        ("command", command),
        ("version", format!("allanite {}", env!("CARGO_PKG_VERSION"))),
        (
            "model tolerance",
            format!("{} %", 100.0 * options.tolerance),
        ),
        (verdict::ADEQUATE_FROM, format!("p = {ADEQUATE_P}")),
        (
            "largest number of effects to add",
            options.max_effects.to_string(),
        ),
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

/// The sources and licences of the records, each of them once.
fn sources(diagnosed: &[Diagnosed]) -> BTreeSet<String> {
    let axes = diagnosed.iter().map(|one| &one.axis);
    let named = axes.map(|axis| axis.source.iter().chain(&axis.licence));
    let named = named.map(|words| words.cloned().collect::<Vec<_>>().join(", "));
    named.filter(|words| !words.is_empty()).collect()
}
