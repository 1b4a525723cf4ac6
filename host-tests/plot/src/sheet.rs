//! The sheet of a drawing: its title, its legends, and the text of its file.

use super::{
    frame::Span,
    panel::{INK, PALE, Panel, Stroke, line, text},
};
use allanite_log::failure::one_line;
use svg::{
    Document,
    node::element::{Group, Rectangle, Text},
};

const WIDTH: f64 = 1030.0;
pub(super) const MARGIN: f64 = 24.0;
/// Height of the title and the subtitle.
pub(super) const HEADING: f64 = 70.0;
/// Height of the line that says that a record is not valid.
pub(super) const WARNING: f64 = 26.0;
/// Left end and width of every panel.
pub(super) const PANELS: (f64, f64) = (92.0, 690.0);
/// Left end of the legend.
pub(super) const LEGEND: f64 = PANELS.0 + PANELS.1 + 22.0;
const LEGEND_ROW: f64 = 24.0;
/// Largest numbers of characters in a title and in the smaller lines below it.
pub(super) const LONGEST: [usize; 2] = [72, 120];
/// Colour of what deserves attention.
pub(super) const ALERT: &str = "#cf222e";

pub(super) const MODEL: Stroke = Stroke {
    colour: "#0969da",
    width: 2.5,
    dashes: "none",
};
/// Lines of effects. The colours are legible on white, and the dashes distinguish the lines without
/// colour.
pub(super) const EFFECTS: [(&str, &str); 9] = [
    ("#6e7781", "2 4"),
    ("#b35900", "8 4"),
    ("#1a7f37", "8 3 2 3"),
    ("#bf3989", "5 3"),
    ("#7a4a21", "2 3"),
    ("#1b7c83", "10 3"),
    ("#8250df", "10 3 2 3"),
    ("#9a6700", "4 3"),
    ("#4d4f9c", "6 3"),
];

/// Lines of further effects of a colour that is taken, such as a second resonance.
pub(super) const TWINS: [(&str, &str); 5] = [
    ("#005f73", "12 3"),
    ("#9d174d", "6 2 2 2"),
    ("#4338ca", "3 2"),
    ("#5d6b00", "9 2 2 2 2 2"),
    ("#57311a", "14 4"),
];

/// The colour and the dashes of an effect's line.
pub(super) const fn effect_line(colour: usize, twin: usize) -> (&'static str, &'static str) {
    match twin.checked_sub(1) {
        None => EFFECTS[colour % EFFECTS.len()],
        Some(twin) => TWINS[twin % TWINS.len()],
    }
}

/// The text of an SVG file with groups of these heights, one below the other.
pub(super) fn document(groups: Vec<(Group, f64)>) -> String {
    let height: f64 = groups.iter().map(|(_, height)| height).sum();
    let paper = Rectangle::new()
        .set("width", "100%")
        .set("height", "100%")
        .set("fill", "#ffffff");
    let mut document = Document::new()
        .set("width", WIDTH)
        .set("height", height)
        .set("viewBox", (0, 0, WIDTH as u32, height as u32))
        .set("font-family", "'DejaVu Sans', Verdana, sans-serif")
        .add(paper);
    let mut down = 0.0;
    for (group, height) in groups {
        document = document.add(shifted(group, down));
        down += height;
    }
    format!("{document}\n")
}

pub(super) fn shifted(group: Group, down: f64) -> Group {
    group.set("transform", format!("translate(0 {down})"))
}

/// The title and the subtitle of a figure.
pub(super) fn heading(title: &str, subtitle: &str) -> Group {
    let title = shown(title, LONGEST[0]);
    let subtitle = shown(subtitle, LONGEST[1]);
    let title = text((MARGIN, 32.0), &title, 18.0, "start", INK).set("font-weight", "bold");
    let subtitle = text((MARGIN, 56.0), &subtitle, 13.0, "start", PALE);
    Group::new().add(title).add(subtitle)
}

/// The words of a row of the legend.
pub(super) fn legend_row(top: f64, words: &str) -> Text {
    text((LEGEND + 40.0, top + 4.0), words, 12.0, "start", INK)
}

/// The panel in which a row of the legend shows a mark.
pub(super) fn legend_sample(top: f64) -> Panel {
    Panel {
        left: LEGEND,
        top: top - 8.0,
        width: 56.0,
        height: 16.0,
    }
}

/// The legend from a height on: what is measured, then a row for each line.
pub(super) fn legend(top: f64, lines: impl IntoIterator<Item = (Stroke, String)>) -> Group {
    let mut top = top;
    let (sample, x) = (legend_sample(top), LEGEND + 18.0);
    let mut group = Group::new()
        .add(line((x, top - 8.0), (x, top + 8.0), INK).set("stroke-width", 1.5))
        .add(sample.mark(0.1, 0.5).set("cx", x))
        .add(legend_row(top, "measured ± std. error"));
    for (stroke, words) in lines {
        top += LEGEND_ROW;
        let sample = legend_sample(top);
        let ends = [(-0.4, 0.5), (0.7, 0.5)].into_iter();
        group = group
            .add(sample.curve(ends, stroke))
            .add(legend_row(top, &words));
    }
    group
}

/// The ticks with their positions instead of their values.
pub(super) fn placed(span: &Span, ticks: Vec<(f64, String)>) -> Vec<(f64, String)> {
    let ticks = ticks.into_iter();
    ticks
        .map(|(value, label)| (span.along(value), label))
        .collect()
}

/// The title of a vertical axis.
pub(super) fn upright(panel: &Panel, words: &str) -> Group {
    let (x, y) = (MARGIN + 4.0, panel.top + 0.5 * panel.height);
    let turned = Group::new().set("transform", format!("translate({x} {y}) rotate(-90)"));
    turned.add(text((0.0, 0.0), words, 13.0, "middle", INK))
}

/// Text of an input without characters that XML forbids, and no longer than there is room.
pub(super) fn shown(words: &str, longest: usize) -> String {
    let words = one_line(words).replace(['\u{fffe}', '\u{ffff}'], " ");
    if words.chars().count() <= longest {
        return words;
    }
    words.chars().take(longest).chain(['…']).collect()
}

/// The lines of effects for a page: a CSS class for each, named `effect-` and the index of the colour, and for each
/// line of a colour that is taken, named `twin-` and its number.
pub fn effect_styles() -> String {
    let rule = |name: &str, place: usize, (colour, dashes): (&str, &str)| {
        format!(".{name}-{place}{{stroke:{colour};stroke-dasharray:{dashes}}}\n")
    };
    let effects = EFFECTS.into_iter().enumerate();
    let effects = effects.map(|(place, line)| rule("effect", place, line));
    // These come last, so that they prevail.
    let twins = TWINS.into_iter().enumerate();
    let twins = twins.map(|(place, line)| rule("twin", place + 1, line));
    effects.chain(twins).collect()
}
