//! The plot in a file: an SVG drawing with one figure below the other.

use super::{
    figure::{Figure, Share},
    frame::{Frame, Span},
    panel::{INK, PALE, Panel, Stroke, line, text},
};
use crate::{failure::one_line, unit::Unit};
use svg::{
    Document,
    node::element::{Circle, Group, Rectangle, Text},
};

const WIDTH: f64 = 1030.0;
/// Height of one figure, including its axis of averaging times.
const HEIGHT: f64 = 664.0;
const MARGIN: f64 = 24.0;
pub(super) const CURVE: Panel = Panel {
    left: 92.0,
    top: 84.0,
    width: 690.0,
    height: 340.0,
};
const RESIDUAL: Panel = Panel {
    left: CURVE.left,
    top: 442.0,
    width: CURVE.width,
    height: 154.0,
};
const LEGEND: (f64, f64) = (CURVE.left + CURVE.width + 22.0, CURVE.top + 12.0);
const LEGEND_ROW: f64 = 24.0;
/// Largest numbers of characters in a title and in the smaller subtitle.
const LONGEST: [usize; 2] = [72, 120];
/// A residual is noticeable beyond this many standard errors. It is the limit that the library's
/// `Comparison::stretches` has.
const NOTICEABLE: f64 = 2.0;

pub(super) const MODEL: Stroke = Stroke {
    colour: "#0969da",
    width: 2.5,
    dashes: "none",
};
/// Lines of effects. The colours are legible on white, and the dashes distinguish the lines without
/// colour.
pub(super) const EFFECTS: [(&str, &str); 8] = [
    ("#6e7781", "2 4"),
    ("#b35900", "8 4"),
    ("#1a7f37", "8 3 2 3"),
    ("#bf3989", "5 3"),
    ("#7a4a21", "2 3"),
    ("#1b7c83", "10 3"),
    ("#8250df", "10 3 2 3"),
    ("#9a6700", "4 3"),
];
/// Colour of the ring around the octave with the largest residual.
const WORST: &str = "#cf222e";

/// One figure of a drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The title.
    pub title: String,
    /// The subtitle, in smaller letters.
    pub subtitle: String,
    /// The unit of the rate.
    pub unit: Unit,
    /// The data to draw.
    pub figure: Figure,
    /// The spans of the panels.
    pub frame: Frame,
}

/// The drawing of figures, one below the other, as the text of an SVG file.
pub fn svg(drawings: &[Drawing]) -> String {
    document(drawings.iter().map(Drawing::draw).collect(), HEIGHT)
}

/// The text of an SVG file with figures of one height, one below the other.
pub(super) fn document(figures: Vec<Group>, each: f64) -> String {
    let height = each * figures.len() as f64;
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
    for (number, figure) in figures.into_iter().enumerate() {
        let down = each * number as f64;
        document = document.add(figure.set("transform", format!("translate(0 {down})")));
    }
    format!("{document}\n")
}

/// The title and the subtitle of a figure.
pub(super) fn heading(title: &str, subtitle: &str) -> Group {
    let title = shown(title, LONGEST[0]);
    let subtitle = shown(subtitle, LONGEST[1]);
    let title = text((MARGIN, 36.0), &title, 18.0, "start", INK).set("font-weight", "bold");
    let subtitle = text((MARGIN, 60.0), &subtitle, 13.0, "start", PALE);
    Group::new().add(title).add(subtitle)
}

impl Drawing {
    fn draw(&self) -> Group {
        let group = heading(&self.title, &self.subtitle);
        let group = self.draw_residual(self.draw_curve(group));
        let middle = CURVE.left + 0.5 * CURVE.width;
        let bottom = RESIDUAL.top + RESIDUAL.height;
        let time = "averaging time τ";
        group
            .add(text((middle, bottom + 40.0), time, 13.0, "middle", INK))
            .add(self.legend())
    }

    /// The positions of the octaves' averaging times and of their deviations.
    fn points<'a>(&'a self, sigma: &'a [f32]) -> impl Iterator<Item = (f64, f64)> + 'a {
        let tau_s = self.figure.tau_s.iter().zip(sigma);
        tau_s.map(|(tau_s, sigma)| (self.across(*tau_s), self.up(*sigma)))
    }

    fn across(&self, tau_s: f32) -> f64 {
        self.frame.tau_s.along(f64::from(tau_s))
    }

    fn up(&self, sigma: f32) -> f64 {
        self.frame.sigma.along(f64::from(sigma))
    }

    fn draw_curve(&self, group: Group) -> Group {
        let Figure {
            measured,
            lower,
            upper,
            model,
            shares,
            ..
        } = &self.figure;
        let mut group = group
            .add(CURVE.times(&self.times(), false))
            .add(CURVE.framed(&self.sigmas()))
            .add(upright(
                &CURVE,
                &format!("Allan deviation σ, {}", self.unit),
            ));
        for share in shares {
            group = group.add(CURVE.curve(self.points(&share.sigma), effect(share)));
        }
        group = group.add(CURVE.curve(self.points(model), MODEL));
        let bars = self.points(lower).zip(self.points(upper));
        for ((across, low), (_, high)) in bars {
            group = group.add(CURVE.stem(across, low, high, 1.5));
        }
        for (across, up) in self.points(measured) {
            group = group.add(CURVE.mark(across, up));
        }
        let worst = self.worst().and_then(|at| self.points(measured).nth(at));
        match worst {
            Some((across, up)) => group.add(ring(&CURVE, across, up)),
            None => group,
        }
    }

    fn draw_residual(&self, group: Group) -> Group {
        let frame = &self.frame;
        let ticks = frame.residuals().into_iter();
        let ticks: Vec<_> = ticks.map(|(z, label)| (frame.up(z), label)).collect();
        let [low, high] = [-NOTICEABLE, NOTICEABLE].map(|z| RESIDUAL.y(frame.up(z)));
        let band = Rectangle::new()
            .set("x", RESIDUAL.left)
            .set("y", high)
            .set("width", RESIDUAL.width)
            .set("height", low - high)
            .set("fill", "#ddf4ff");
        let zero = RESIDUAL.y(frame.up(0.0));
        let right = RESIDUAL.left + RESIDUAL.width;
        let mut group = group
            .add(band)
            .add(RESIDUAL.times(&self.times(), true))
            .add(RESIDUAL.framed(&ticks))
            .add(line((RESIDUAL.left, zero), (right, zero), MODEL.colour))
            .add(upright(&RESIDUAL, "residual, std. errors"));
        for (at, tau_s) in self.figure.tau_s.iter().enumerate() {
            let (across, up) = (self.across(*tau_s), self.z_up(at));
            group = group
                .add(RESIDUAL.stem(across, frame.up(0.0), up, 1.5))
                .add(RESIDUAL.mark(across, up));
        }
        if let Some(at) = self.worst() {
            let (across, up) = (self.across(self.figure.tau_s[at]), self.z_up(at));
            group = group.add(ring(&RESIDUAL, across, up));
        }
        group
    }

    fn z_up(&self, at: usize) -> f64 {
        self.frame.up(f64::from(self.figure.z[at]))
    }

    /// The octave with the largest residual, if that is noticeable.
    fn worst(&self) -> Option<usize> {
        let worst = self.figure.worst();
        let z = self.figure.z.get(worst)?;
        (f64::from(z.abs()) > NOTICEABLE).then_some(worst)
    }

    fn times(&self) -> Vec<(f64, String)> {
        placed(&self.frame.tau_s, self.frame.tau_s.times())
    }

    fn sigmas(&self) -> Vec<(f64, String)> {
        placed(&self.frame.sigma, self.frame.sigma.labelled())
    }

    fn legend(&self) -> Group {
        let mut lines = vec![(MODEL, "model".to_owned())];
        let effects = self.figure.shares.iter();
        lines.extend(effects.map(|share| (effect(share), share.effect.replace('_', " "))));
        let group = legend(lines);
        let left = LEGEND.0;
        let band = Rectangle::new()
            .set("x", left)
            .set("y", RESIDUAL.top + 4.0)
            .set("width", 31)
            .set("height", 16)
            .set("fill", "#ddf4ff");
        let group = group
            .add(band)
            .add(legend_row(RESIDUAL.top + 12.0, "± 2 std. errors"));
        let Some(worst) = self.worst() else {
            return group;
        };
        let sample = Panel {
            top: RESIDUAL.top + 36.0 - 8.0,
            ..legend_sample()
        };
        let words = format!("worst octave: {:+.0}", self.figure.z[worst]).replace('-', "−");
        group
            .add(sample.mark(0.1, 0.5))
            .add(ring(&sample, 0.1, 0.5))
            .add(legend_row(RESIDUAL.top + 36.0, &words))
    }
}

/// The words of a row of the legend.
fn legend_row(top: f64, words: &str) -> Text {
    text((LEGEND.0 + 40.0, top + 4.0), words, 12.0, "start", INK)
}

/// The panel in which the first row of the legend shows its mark.
fn legend_sample() -> Panel {
    let (left, top) = LEGEND;
    Panel {
        left,
        top: top - 8.0,
        width: 56.0,
        height: 16.0,
    }
}

/// The legend: what is measured, then a row for each line.
pub(super) fn legend(lines: impl IntoIterator<Item = (Stroke, String)>) -> Group {
    let (sample, mut top) = (legend_sample(), LEGEND.1);
    let mut group = Group::new()
        .add(sample.stem(0.1, 0.0, 1.0, 1.5))
        .add(sample.mark(0.1, 0.5))
        .add(legend_row(top, "measured ± std. error"));
    for (stroke, words) in lines {
        top += LEGEND_ROW;
        let sample = Panel { top, ..sample };
        let ends = [(-0.4, 1.0), (0.7, 1.0)].into_iter();
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

fn ring(panel: &Panel, across: f64, up: f64) -> Circle {
    let mark = panel.mark(across, up).set("r", 8).set("fill", "none");
    mark.set("stroke", WORST).set("stroke-width", 2)
}

fn effect(share: &Share) -> Stroke {
    let (colour, dashes) = EFFECTS[share.colour % EFFECTS.len()];
    Stroke {
        colour,
        width: 1.6,
        dashes,
    }
}

/// Text of an input without characters that XML forbids, and no longer than there is room.
fn shown(words: &str, longest: usize) -> String {
    let words = one_line(words).replace(['\u{fffe}', '\u{ffff}'], " ");
    if words.chars().count() <= longest {
        return words;
    }
    words.chars().take(longest).chain(['…']).collect()
}

/// The lines of effects for a page: a CSS class for each, named `effect-` and the index of the colour.
pub fn effect_styles() -> String {
    let rule = |(place, (colour, dashes)): (usize, (&str, &str))| {
        format!(".effect-{place}{{stroke:{colour};stroke-dasharray:{dashes}}}\n")
    };
    EFFECTS.into_iter().enumerate().map(rule).collect()
}
