//! What the pictures of a page have in common: their size, their scales and their lines.

use super::scale::Scale;
use allanite_host::number::number;
use maud::{Markup, html};

/// The size of a picture. It is as large as it is shown on a phone, so that its letters are.
pub(super) const WIDTH: f64 = 370.0;
pub(super) const HEIGHT: f64 = 220.0;
/// The ends of the horizontal and of the vertical scale.
pub(super) const ACROSS: (f64, f64) = (52.0, 360.0);
pub(super) const UP: (f64, f64) = (180.0, 22.0);

/// A place as it is written.
pub(super) fn at(place: f64) -> String {
    format!("{place:.1}")
}

/// A number without the zeros at its end.
pub(super) fn short(value: f64) -> String {
    let text = number(value);
    if text.contains('e') || !text.contains('.') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A picture with its name for those who do not see it.
pub(super) fn picture(name: &str, content: &Markup) -> Markup {
    html! {
        svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(name) {
            title { (name) }
            (content)
        }
    }
}

/// The horizontal scale with its ticks and its name.
pub(super) fn across(scale: &Scale, name: &str) -> Markup {
    html! {
        @for tick in scale.ticks() {
            @let x = at(scale.place(tick));
            line.grid x1=(x) x2=(x) y1=(at(UP.0)) y2=(at(UP.1)) {}
            text.tick x=(x) y=(at(UP.0 + 14.0)) text-anchor="middle" { (short(tick)) }
        }
        (named_across(name))
    }
}

/// The name of the horizontal scale.
pub(super) fn named_across(name: &str) -> Markup {
    html! {
        text.tick x=(at(f64::midpoint(ACROSS.0, ACROSS.1))) y=(at(HEIGHT - 8.0)) text-anchor="middle" {
            (name)
        }
    }
}

/// The vertical scale with its ticks and its name.
pub(super) fn up(scale: &Scale, name: &str) -> Markup {
    html! {
        @for tick in scale.ticks() {
            @let y = scale.place(tick);
            line.grid x1=(at(ACROSS.0)) x2=(at(ACROSS.1)) y1=(at(y)) y2=(at(y)) {}
            text.tick x=(at(ACROSS.0 - 5.0)) y=(at(y + 4.0)) text-anchor="end" { (short(tick)) }
        }
        text.tick x="2" y="13" { (name) }
    }
}

/// Dots as one path, each place once, so that thousands of devices take little room.
pub(super) fn dots(class: &str, places: impl Iterator<Item = (f64, f64)>) -> Markup {
    let halves = places.map(|(x, y)| ((2.0 * x).round() as i32, (2.0 * y).round() as i32));
    let once: std::collections::BTreeSet<(i32, i32)> = halves.collect();
    let path: String = once
        .into_iter()
        .map(|(x, y)| format!("M{} {}h0", f64::from(x) / 2.0, f64::from(y) / 2.0))
        .collect();
    html! {
        @if !path.is_empty() { path class={ "dots " (class) } d=(path) {} }
    }
}
