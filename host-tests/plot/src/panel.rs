//! One panel of a drawing: a frame with ticks, curves and marks.

use svg::node::element::{Circle, Group, Line, Path, Rectangle, Text, path::Data};

/// Colour of text, bars and marks.
pub(super) const INK: &str = "#1b1f24";
/// Paler colour of frames, ticks and their labels.
pub(super) const PALE: &str = "#57606a";
const RULE: &str = "#d8dee4";
/// Margins inside the frame: left of the first octave and right of the last, below the lowest value and above the
/// highest. No mark reaches over the frame.
const INSET: (f64, f64) = (14.0, 9.0);
const TICK: f64 = 5.0;

/// A rectangle of the drawing. Positions in it are shares of its width and its height, from the lower
/// left.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// The style of a line.
#[derive(Clone, Copy)]
pub(super) struct Stroke {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    pub(super) dashes: &'static str,
}

impl Panel {
    pub(super) fn x(&self, across: f64) -> f64 {
        self.left + INSET.0 + across * (self.width - 2.0 * INSET.0)
    }

    pub(super) fn y(&self, up: f64) -> f64 {
        self.top + INSET.1 + (1.0 - up) * (self.height - 2.0 * INSET.1)
    }

    /// The frame, with labelled ticks on its left and horizontal rules.
    pub(super) fn framed(&self, ticks: &[(f64, String)]) -> Group {
        let mut group = Group::new();
        for (up, label) in ticks {
            let y = self.y(*up);
            let (left, right) = (self.left, self.left + self.width);
            group = group
                .add(line((left, y), (right, y), RULE))
                .add(line((left - TICK, y), (left, y), PALE))
                .add(text((left - 2.0 * TICK, y + 4.0), label, 12.0, "end", PALE));
        }
        let outline = Rectangle::new()
            .set("x", self.left)
            .set("y", self.top)
            .set("width", self.width)
            .set("height", self.height)
            .set("fill", "none")
            .set("stroke", PALE);
        group.add(outline)
    }

    /// Vertical rules at ticks of the horizontal axis, with labels below the panel if `labels` is set.
    pub(super) fn times(&self, ticks: &[(f64, String)], labels: bool) -> Group {
        let bottom = self.top + self.height;
        let mut group = Group::new();
        for (across, label) in ticks {
            let x = self.x(*across);
            group = group.add(line((x, self.top), (x, bottom), RULE));
            if labels {
                group = group
                    .add(line((x, bottom), (x, bottom + TICK), PALE))
                    .add(text((x, bottom + 19.0), label, 12.0, "middle", PALE));
            }
        }
        group
    }

    /// A line through points, clipped to the panel.
    pub(super) fn curve(&self, points: impl Iterator<Item = (f64, f64)>, stroke: Stroke) -> Path {
        self.curves(std::iter::once(points), stroke)
    }

    /// A line in pieces, clipped to the panel.
    pub(super) fn curves(
        &self,
        pieces: impl Iterator<Item = impl Iterator<Item = (f64, f64)>>,
        stroke: Stroke,
    ) -> Path {
        let mut data = Data::new();
        let place = |point: (f64, f64)| (round(self.x(point.0)), round(self.y(point.1)));
        for points in pieces {
            let mut before: Option<(f64, f64)> = None;
            // The end of what has been drawn. Dashes continue where a line does.
            let mut end = None;
            for point in points {
                let Some(from) = before.replace(point) else {
                    continue;
                };
                let Some((from, to)) = inside(from, point) else {
                    end = None;
                    continue;
                };
                if end != Some(from) {
                    data = data.move_to(place(from));
                }
                data = data.line_to(place(to));
                end = Some(to);
            }
        }
        Path::new()
            .set("d", data)
            .set("fill", "none")
            .set("stroke", stroke.colour)
            .set("stroke-width", stroke.width)
            .set("stroke-dasharray", stroke.dashes)
            .set("stroke-linecap", "round")
            .set("stroke-linejoin", "round")
    }

    /// A vertical line, clipped to the panel.
    pub(super) fn stem(&self, across: f64, from: f64, to: f64, width: f64) -> Line {
        let clamp = |up: f64| if up.is_nan() { 0.0 } else { up.clamp(0.0, 1.0) };
        let (x, [from, to]) = (self.x(across), [from, to].map(clamp));
        line((x, self.y(from)), (x, self.y(to)), INK).set("stroke-width", width)
    }

    /// A dot. One that would lie outside of the panel, such as a deviation of zero, lies at its edge.
    pub(super) fn mark(&self, across: f64, up: f64) -> Circle {
        let up = if up.is_nan() { 0.0 } else { up.clamp(0.0, 1.0) };
        Circle::new()
            .set("cx", round(self.x(across)))
            .set("cy", round(self.y(up)))
            .set("r", 3.5)
            .set("fill", INK)
    }
}

/// The part of the line between two points that lies between the heights 0 and 1, if any.
fn inside(from: (f64, f64), to: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    let finite = [from.1, to.1].iter().all(|up| up.is_finite());
    if !finite || from.1.max(to.1) < 0.0 || from.1.min(to.1) > 1.0 {
        return None;
    }
    let at = |point: (f64, f64)| {
        let up = point.1.clamp(0.0, 1.0);
        if up == point.1 {
            return point;
        }
        let share = (up - from.1) / (to.1 - from.1);
        (from.0 + share * (to.0 - from.0), up)
    };
    Some((at(from), at(to)))
}

/// Rounds to hundredths, which are finer than any screen.
fn round(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

pub(super) fn line(from: (f64, f64), to: (f64, f64), colour: &str) -> Line {
    Line::new()
        .set("x1", round(from.0))
        .set("y1", round(from.1))
        .set("x2", round(to.0))
        .set("y2", round(to.1))
        .set("stroke", colour)
}

pub(super) fn text(at: (f64, f64), text: &str, size: f64, anchor: &str, colour: &str) -> Text {
    Text::new(text)
        .set("x", round(at.0))
        .set("y", round(at.1))
        .set("font-size", size)
        .set("text-anchor", anchor)
        .set("fill", colour)
}

#[cfg(test)]
mod tests {
    use super::inside;

    #[test]
    fn lines_end_where_they_leave_the_panel() {
        let below = inside((0.0, -1.0), (1.0, 1.0));
        assert_eq!(below, Some(((0.5, 0.0), (1.0, 1.0))));
        let across = inside((0.0, 1.5), (1.0, -0.5));
        assert_eq!(across, Some(((0.25, 1.0), (0.75, 0.0))));
        assert_eq!(inside((0.0, -2.0), (1.0, -1.0)), None);
        assert_eq!(inside((0.0, f64::NEG_INFINITY), (1.0, 0.5)), None);
    }
}
