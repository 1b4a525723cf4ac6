//! A figure beside its residual: two panels over one horizontal axis.

use super::{
    figure::{Figure, Share},
    frame::Frame,
    lines::Line,
    panel::{INK, Panel, Stroke, line, text},
    sheet::{
        ALERT, LEGEND, MODEL, PANELS, effect_line, legend, legend_row, legend_sample, placed,
        upright,
    },
};
use allanite_log::unit::Unit;
use svg::node::element::{Circle, Group, Rectangle};

const CURVE: Panel = Panel {
    left: PANELS.0,
    top: 10.0,
    width: PANELS.1,
    height: 330.0,
};
const RESIDUAL: Panel = Panel {
    left: CURVE.left,
    top: CURVE.top + CURVE.height + 14.0,
    width: CURVE.width,
    height: 160.0,
};
/// Height of both panels with their axis.
const HEIGHT: f64 = RESIDUAL.top + RESIDUAL.height + 66.0;
/// Colour of the band of residuals that are not noticeable.
const BAND: &str = "#ddf4ff";
/// A residual is noticeable beyond this many standard errors. It is the limit that the library's
/// `Comparison::stretches` has.
const NOTICEABLE: f64 = 2.0;

/// The drawing of a figure in a unit of the rate, and its height.
pub(super) fn draw(figure: &Figure, frame: &Frame, unit: Unit) -> (Group, f64) {
    let pair = Pair { figure, frame };
    let quantity = frame.quantity;
    let group = Group::new().set("class", quantity.class());
    let title = format!("{}, {}", quantity.up(), quantity.unit(unit));
    let group = pair.draw_curve(group).add(upright(&CURVE, &title));
    let group = pair.draw_residual(group);
    let middle = CURVE.left + 0.5 * CURVE.width;
    let bottom = RESIDUAL.top + RESIDUAL.height;
    let across = text(
        (middle, bottom + 40.0),
        quantity.across(),
        13.0,
        "middle",
        INK,
    );
    (group.add(across).add(pair.legend()), HEIGHT)
}

struct Pair<'a> {
    figure: &'a Figure,
    frame: &'a Frame,
}

impl Pair<'_> {
    /// The positions of the points and of their values.
    fn points<'a>(&'a self, values: &'a [f32]) -> impl Iterator<Item = (f64, f64)> + 'a {
        let points = self.figure.measured.x.iter().zip(values);
        points.map(|(x, value)| self.place([*x, *value]))
    }

    fn place(&self, [x, value]: [f32; 2]) -> (f64, f64) {
        let up = self.frame.y.along(f64::from(value));
        (self.frame.x.along(f64::from(x)), up)
    }

    fn line(&self, Line(pieces): &Line, stroke: Stroke) -> svg::node::element::Path {
        let place = |points: &Vec<[f32; 2]>| {
            let points: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
            points.into_iter()
        };
        CURVE.curves(pieces.iter().map(place), stroke)
    }

    fn draw_curve(&self, group: Group) -> Group {
        let measured = &self.figure.measured;
        let ticks = placed(&self.frame.y, self.frame.y.labelled());
        let mut group = group
            .add(CURVE.times(&self.ticks(), false))
            .add(CURVE.framed(&ticks));
        for share in &self.figure.shares {
            group = group.add(self.line(&share.line, effect(share)));
        }
        group = group.add(self.line(&self.figure.model, MODEL).set("class", "model"));
        let bars = self
            .points(&measured.lower)
            .zip(self.points(&measured.upper));
        for ((across, low), (_, high)) in bars {
            group = group.add(CURVE.stem(across, low, high, 1.5).set("class", "bar"));
        }
        for (across, up) in self.points(&measured.measured) {
            group = group.add(CURVE.mark(across, up));
        }
        let worst = self.worst();
        let worst = worst.and_then(|at| self.points(&measured.measured).nth(at));
        match worst {
            Some((across, up)) => group.add(ring(&CURVE, across, up)),
            None => group,
        }
    }

    fn draw_residual(&self, group: Group) -> Group {
        let frame = self.frame;
        let ticks = frame.residuals().into_iter();
        let ticks: Vec<_> = ticks.map(|(z, label)| (frame.up(z), label)).collect();
        let [low, high] = [-NOTICEABLE, NOTICEABLE].map(|z| RESIDUAL.y(frame.up(z)));
        let band = Rectangle::new()
            .set("x", RESIDUAL.left)
            .set("y", high)
            .set("width", RESIDUAL.width)
            .set("height", low - high)
            .set("fill", BAND);
        let zero = RESIDUAL.y(frame.up(0.0));
        let right = RESIDUAL.left + RESIDUAL.width;
        let mut group = group
            .add(band)
            .add(RESIDUAL.times(&self.ticks(), true))
            .add(RESIDUAL.framed(&ticks))
            .add(line((RESIDUAL.left, zero), (right, zero), MODEL.colour))
            .add(upright(&RESIDUAL, "residual, std. errors"));
        for (x, z) in self.figure.measured.x.iter().zip(&self.figure.z) {
            let (across, up) = (frame.x.along(f64::from(*x)), frame.up(f64::from(*z)));
            group = group
                .add(RESIDUAL.stem(across, frame.up(0.0), up, 1.5))
                .add(RESIDUAL.mark(across, up));
        }
        if let Some(at) = self.worst() {
            let across = frame.x.along(f64::from(self.figure.measured.x[at]));
            let up = frame.up(f64::from(self.figure.z[at]));
            group = group.add(ring(&RESIDUAL, across, up));
        }
        group
    }

    /// The point with the largest residual, if that is noticeable.
    fn worst(&self) -> Option<usize> {
        let worst = self.figure.worst();
        let z = self.figure.z.get(worst)?;
        (f64::from(z.abs()) > NOTICEABLE).then_some(worst)
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        placed(&self.frame.x, self.frame.across())
    }

    /// The name of an effect; its frequency tells it from another one of the same name.
    fn name(&self, share: &Share) -> String {
        let name = share.effect.replace('_', " ");
        let alike = self.figure.shares.iter();
        let alike = alike.filter(|other| other.effect == share.effect).count();
        match share.frequency_hz {
            Some(frequency_hz) if alike > 1 => {
                let digits: f32 = format!("{frequency_hz:.2e}")
                    .parse()
                    .unwrap_or(frequency_hz);
                format!("{name}, {digits} Hz")
            }
            _ => name,
        }
    }

    fn legend(&self) -> Group {
        let mut lines = vec![(MODEL, "model".to_owned())];
        let effects = self.figure.shares.iter();
        lines.extend(effects.map(|share| (effect(share), self.name(share))));
        let band = Rectangle::new()
            .set("x", LEGEND)
            .set("y", RESIDUAL.top + 4.0)
            .set("width", 31)
            .set("height", 16)
            .set("fill", BAND);
        let group = legend(CURVE.top + 12.0, lines)
            .add(band)
            .add(legend_row(RESIDUAL.top + 12.0, "± 2 std. errors"));
        let Some(worst) = self.worst() else {
            return group;
        };
        let row = RESIDUAL.top + 36.0;
        let sample = legend_sample(row);
        let words = format!(
            "worst {}: {:+.0}",
            self.frame.quantity.point(),
            self.figure.z[worst]
        );
        group
            .add(sample.mark(0.1, 0.5))
            .add(ring(&sample, 0.1, 0.5))
            .add(legend_row(row, &words.replace('-', "−")))
    }
}

fn ring(panel: &Panel, across: f64, up: f64) -> Circle {
    let mark = panel.mark(across, up).set("r", 8).set("fill", "none");
    mark.set("stroke", ALERT).set("stroke-width", 2)
}

fn effect(share: &Share) -> Stroke {
    let (colour, dashes) = effect_line(share.colour, share.twin);
    Stroke {
        colour,
        width: 1.6,
        dashes,
    }
}
