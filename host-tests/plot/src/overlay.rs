//! A drawing of one curve beside those of several models, without residuals.

use super::{
    frame::Span,
    panel::{INK, Panel, Stroke, text},
    sheet::{EFFECTS, MODEL, PANELS, document, heading, legend, placed, upright},
};
use svg::node::element::Group;

/// The height of one overlay, including its axis of averaging times.
const HEIGHT: f64 = 490.0;

/// The only panel.
const CURVE: Panel = Panel {
    left: PANELS.0,
    top: 84.0,
    width: PANELS.1,
    height: 340.0,
};

/// The line of the first model, which is drawn below the others. The last one has the line of a model in
/// other figures.
const FIRST: Stroke = Stroke {
    colour: "#8c959f",
    width: 5.0,
    dashes: "none",
};

/// A measured curve and the curves of models, with deviations in one unit.
#[derive(Clone, Debug)]
pub struct Overlay {
    /// The title.
    pub title: String,
    /// The subtitle, in smaller letters.
    pub subtitle: String,
    /// The unit of the deviations.
    pub unit: &'static str,
    /// The averaging times, in seconds.
    pub tau_s: Vec<f64>,
    /// The measured deviations.
    pub measured: Vec<f64>,
    /// Their standard errors.
    pub errors: Vec<f64>,
    /// The names of the models and their deviations. A deviation that is not a number leaves its line
    /// open.
    pub curves: Vec<(String, Vec<f64>)>,
    /// The span of the deviations that is drawn.
    pub span: Span,
}

/// The drawing of overlays, one below the other, as the text of an SVG file.
pub fn overlays(overlays: &[Overlay]) -> String {
    document(overlays.iter().map(|one| (one.draw(), HEIGHT)).collect())
}

impl Overlay {
    fn draw(&self) -> Group {
        let first = self.tau_s.first().copied().unwrap_or(1.0);
        let last = self.tau_s.last().copied().unwrap_or(first);
        let times = Span {
            low: first,
            high: last.max(2.0 * first),
        };
        let at = |tau_s: f64, sigma: f64| (times.along(tau_s), self.span.along(sigma));
        let middle = CURVE.left + 0.5 * CURVE.width;
        let bottom = CURVE.top + CURVE.height;
        let mut group = heading(&self.title, &self.subtitle)
            .add(CURVE.times(&placed(&times, times.times()), true))
            .add(CURVE.framed(&placed(&self.span, self.span.labelled())))
            .add(upright(
                &CURVE,
                &format!("Allan deviation σ, {}", self.unit),
            ))
            .add(text(
                (middle, bottom + 40.0),
                "averaging time τ",
                13.0,
                "middle",
                INK,
            ));
        for (number, (_, curve)) in self.curves.iter().enumerate() {
            let points = self.tau_s.iter().zip(curve);
            let points = points.map(|(tau_s, sigma)| at(*tau_s, *sigma));
            group = group.add(CURVE.curve(points, stroke(number, self.curves.len())));
        }
        for ((tau_s, sigma), error) in self.tau_s.iter().zip(&self.measured).zip(&self.errors) {
            let (across, up) = at(*tau_s, *sigma);
            // A lower end below zero has no logarithm and ends at the panel.
            let low = (sigma - error).max(self.span.low);
            let (low, high) = (self.span.along(low), self.span.along(sigma + error));
            group = group
                .add(CURVE.stem(across, low, high, 1.5))
                .add(CURVE.mark(across, up));
        }
        let curves = self.curves.iter().enumerate();
        let lines =
            curves.map(|(number, (name, _))| (stroke(number, self.curves.len()), name.clone()));
        group.add(legend(CURVE.top + 12.0, lines))
    }
}

/// The line of the model with this number, of so many models.
fn stroke(number: usize, models: usize) -> Stroke {
    if number == 0 {
        return FIRST;
    }
    if number + 1 == models {
        return MODEL;
    }
    let (colour, dashes) = EFFECTS[(number - 1) % EFFECTS.len()];
    Stroke {
        colour,
        width: 2.0,
        dashes,
    }
}
