//! The plot in a file: an SVG drawing of a record with its figures one below the other.

use super::{
    comparison,
    course::CourseFigure,
    figure::Figure,
    frame::Frame,
    panel::text,
    sheet::{ALERT, HEADING, LONGEST, MARGIN, WARNING, document, heading, shifted, shown},
    strips,
};
use allanite_log::unit::Unit;
use svg::node::element::Group;

/// The drawing of one record.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The title.
    pub title: String,
    /// The subtitle, in smaller letters.
    pub subtitle: String,
    /// Why the record is not valid, if it is not. This comes first.
    pub warning: Option<String>,
    /// The unit of the rate.
    pub unit: Unit,
    /// The record beside a model, with the spans of the panels.
    pub figures: Vec<(Figure, Frame)>,
    /// The record over time.
    pub course: Option<CourseFigure>,
}

/// The drawing of records, one below the other, as the text of an SVG file.
pub fn svg(drawings: &[Drawing]) -> String {
    document(drawings.iter().map(Drawing::draw).collect())
}

impl Drawing {
    /// The drawing and its height.
    fn draw(&self) -> (Group, f64) {
        let (mut group, mut down) = (Group::new(), 0.0);
        if let Some(warning) = &self.warning {
            let words = shown(&format!("The curve is not valid: {warning}"), LONGEST[1]);
            let words = text((MARGIN, WARNING), &words, 14.0, "start", ALERT);
            group = group.add(words.set("font-weight", "bold"));
            down += WARNING;
        }
        group = group.add(shifted(heading(&self.title, &self.subtitle), down));
        down += HEADING;
        for (figure, frame) in &self.figures {
            let (part, height) = comparison::draw(figure, frame, self.unit);
            group = group.add(shifted(part, down));
            down += height;
        }
        if let Some(course) = &self.course {
            let (part, height) = strips::draw(course);
            group = group.add(shifted(part, down));
            down += height;
        }
        (group, down)
    }
}
