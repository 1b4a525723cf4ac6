//! The page: its static content, and the data for its script.

use super::{
    catalogue::{Listed, catalogue},
    record::LoadedRecord,
};
use crate::plot;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::Serialize;

/// The style of the page of `report`, and what this page adds to it.
const STYLES: [&str; 2] = [
    include_str!("../../report/page.css"),
    include_str!("../../explore/page.css"),
];
/// The scripts: the first ones are those of the page of `report` and draw figures, the others are this page.
const SCRIPTS: [&str; 13] = [
    include_str!("../../report/common.js"),
    include_str!("../../report/ticks.js"),
    include_str!("../../report/sheet.js"),
    include_str!("../../report/figure.js"),
    include_str!("../../report/legend.js"),
    include_str!("../../report/bars.js"),
    include_str!("../../report/plot.js"),
    include_str!("../../report/table.js"),
    include_str!("../../explore/state.js"),
    include_str!("../../explore/records.js"),
    include_str!("../../explore/controls.js"),
    include_str!("../../explore/answer.js"),
    include_str!("../../explore/page.js"),
];

/// The data for the script.
#[derive(Serialize)]
struct Data<'a> {
    catalogue: Vec<Listed>,
    records: Vec<ListedRecord<'a>>,
}

#[derive(Serialize)]
struct ListedRecord<'a> {
    name: String,
    axis: &'a str,
    size: String,
    unit: String,
}

/// The page as HTML. Its scripts and styles have this nonce, so that a browser runs no others.
pub(super) fn page(records: &[LoadedRecord], nonce: &str) -> String {
    let data = Data {
        catalogue: catalogue(records),
        records: records
            .iter()
            .map(|record| ListedRecord {
                name: record.name(),
                axis: &record.axis.axis,
                size: record.size(),
                unit: record.axis.unit.to_string(),
            })
            .collect(),
    };
    // Without `<`, no text in the data can end the script element.
    let json = serde_json::to_string(&data)
        .unwrap_or_default()
        .replace('<', "\\u003c");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Effects by hand" }
                link rel="icon" href="data:,";
                style nonce=(nonce) {
                    @for style in STYLES { (PreEscaped(style)) }
                    (PreEscaped(plot::effect_styles()))
                }
            }
            body {
                header {
                    h1 { "Effects by hand" }
                    details.introduction { summary { "How this page works" } p { (INTRODUCTION) } }
                    noscript { p { "This page needs JavaScript, which comes from this computer only." } }
                }
                main.walk { (controls()) (panel()) }
                script type="application/json" id="data" nonce=(nonce) { (PreEscaped(json)) }
                @for script in SCRIPTS { script nonce=(nonce) { (PreEscaped(script)) } }
            }
        }
    };
    page.into_string()
}

const INTRODUCTION: &str = "Add an effect and move its sliders: the model is fitted anew at every change, by the \
    functions of the command compare, and curve, χ² and coefficients follow. Where the dots leave the model’s line, \
    something is missing; χ² of an adequate model is about as large as the number of degrees of freedom. A click on a peak of \
    the spectrum adds a line there. Move over a figure, tap it or use the arrow keys to read the values of a point; zoom by the \
    wheel, by two fingers or by the keys + and −, and show all by 0.";

/// What changes the model.
fn controls() -> Markup {
    html! {
        div.control {
            section aria-labelledby="records-heading" {
                h2 #records-heading { "Records" }
                div #records {}
            }
            section aria-labelledby="model-heading" {
                h2 #model-heading { "Model" }
                div.turns {
                    button.turn type="button" #undo { "Undo" }
                    button.turn type="button" #redo { "Redo" }
                    button.turn type="button" #reset { "Reset" }
                }
                div #history {}
                div #terms {}
                div #effects {}
            }
            section aria-labelledby="catalogue-heading" {
                h2 #catalogue-heading { "Add an effect" }
                ul #catalogue {}
            }
        }
    }
}

/// What the model does.
fn panel() -> Markup {
    html! {
        div.panel {
            h2.model #model {}
            p.error #error {}
            // A screen reader is told the result when it rests.
            p.spoken #said aria-live="polite" aria-atomic="true" {}
            p #problem role="alert" {}
            p.words #words {}
            div.places #places {}
            ul.legend #legend aria-label="Legend" {}
            section #judged aria-label="Records that judge the model" {}
            section.coefficients aria-labelledby="coefficients-heading" {
                h2 #coefficients-heading { "Coefficients" }
                div.options {
                    label { "Compared with " select #reference {
                        option value="before" { "the model before the last change" }
                        option value="five" { "the five terms" }
                    } }
                    label { "Units " select #unit {
                        option value="0" { "as in the log" }
                        option value="1" { "customary (°/h, °/√h)" }
                    } }
                }
                div #coefficients {}
                p.hint #widened {}
            }
            section aria-labelledby="diagnosis-heading" {
                h2 #diagnosis-heading { "What does diagnose think?" }
                div.options {
                    button.turn type="button" #diagnose { "Diagnose this record" }
                    button.turn type="button" #adopt hidden { "Take its model" }
                }
                div #diagnosis aria-live="polite" {}
            }
            section aria-labelledby="keep-heading" {
                h2 #keep-heading { "Keep it" }
                div.options {
                    button.turn type="button" #drawing { "Download SVG" }
                    button.turn type="button" #table { "Download CSV" }
                    button.turn type="button" #link { "Copy link" }
                    button.turn type="button" #copy { "Copy command" }
                }
                p.hint #kept role="status" {}
                p.hint { "The same fit on the command line; the address of this page has the model too." }
                pre { code #command {} }
            }
        }
    }
}
