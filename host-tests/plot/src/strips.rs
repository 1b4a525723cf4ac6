//! The course of a record as strips: the rate, the noise and the recorded columns over one axis of times.

use super::{
    course::{CourseFigure, Strip},
    panel::{INK, Panel, line, text},
    sheet::{ALERT, LEGEND, PANELS, legend, shown, upright},
};
use svg::node::element::Group;

/// Height of the strip of the rate, and that of the others.
const HEIGHTS: [f64; 2] = [210.0, 120.0];
const BETWEEN: f64 = 14.0;
/// Room above the first strip for the numbers of events.
const TOP: f64 = 26.0;
/// Height of the axis of times.
const AXIS: f64 = 66.0;
/// Height of a letter of an upright title along its panel.
const LETTER: f64 = 7.5;
/// Height of an event in the legend, and the width of its number.
const EVENT_ROW: f64 = 24.0;
const NUMBER: f64 = 13.0;
/// The longest words of an event, in characters.
const EVENT_WORDS: usize = 26;

/// The drawing of a course, and its height.
pub(super) fn draw(course: &CourseFigure) -> (Group, f64) {
    let times: Vec<(f64, String)> = course
        .times
        .iter()
        .map(|(time_s, label)| (course.along(*time_s), label.clone()))
        .collect();
    let mut group = Group::new().set("class", "rate");
    let mut top = TOP;
    let last = course.strips.len().saturating_sub(1);
    for (number, strip) in course.strips.iter().enumerate() {
        let panel = Panel {
            left: PANELS.0,
            top,
            width: PANELS.1,
            height: HEIGHTS[number.min(1)],
        };
        group = group.add(draw_strip(course, strip, &panel, &times, number == last));
        top += panel.height + BETWEEN;
    }
    let bottom = top - BETWEEN;
    let middle = PANELS.0 + 0.5 * PANELS.1;
    let across = text((middle, bottom + 40.0), &course.across, 13.0, "middle", INK);
    group = group.add(across).add(legend(TOP + 12.0, []));
    let whole = Panel {
        left: PANELS.0,
        top: TOP,
        width: PANELS.1,
        height: bottom - TOP,
    };
    let mut free = f64::NEG_INFINITY;
    for (number, event) in course.events.iter().enumerate() {
        let x = whole.x(course.along(event.at_s));
        let mark = line((x, TOP), (x, bottom), ALERT).set("stroke-dasharray", "4 3");
        let row = TOP + 12.0 + EVENT_ROW * (number + 1) as f64;
        let number = (number + 1).to_string();
        // Two events at one time have their numbers beside each other.
        let above = x.max(free);
        free = above + NUMBER;
        let numbered = |x, y| text((x, y), &number, 12.0, "middle", ALERT);
        let words = shown(&event.words, EVENT_WORDS);
        group = group
            .add(mark.set("class", "event"))
            .add(numbered(above, TOP - 7.0))
            .add(numbered(LEGEND + 18.0, row + 4.0))
            .add(text((LEGEND + 40.0, row + 4.0), &words, 12.0, "start", INK));
    }
    (group, bottom + AXIS)
}

fn draw_strip(
    course: &CourseFigure,
    strip: &Strip,
    panel: &Panel,
    times: &[(f64, String)],
    labels: bool,
) -> Group {
    let ticks: Vec<(f64, String)> = strip
        .ticks
        .iter()
        .map(|(value, label)| (strip.up(*value), label.clone()))
        .collect();
    let title = shown(&strip.title, (panel.height / LETTER) as usize);
    let mut group = Group::new()
        .add(panel.times(times, labels))
        .add(panel.framed(&ticks))
        .add(upright(panel, &title));
    for (at, (time_s, value)) in course.at_s.iter().zip(&strip.values).enumerate() {
        let across = course.along(f64::from(*time_s));
        let value = f64::from(*value);
        if let Some(error) = strip.errors.get(at) {
            let [low, high] = [-1.0, 1.0].map(|sign| strip.up(value + sign * f64::from(*error)));
            group = group.add(panel.stem(across, low, high, 1.5).set("class", "bar"));
        }
        group = group.add(panel.mark(across, strip.up(value)));
    }
    group
}
