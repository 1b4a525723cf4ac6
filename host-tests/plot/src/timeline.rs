//! The course of a record in a terminal: the rate, the noise and the recorded columns over time.

use super::{
    canvas::Canvas,
    course::{CourseFigure, Strip},
    terminal::{columns, write_axis, write_panel},
};
use std::fmt;

/// Rows of the panel of the rate, and those of the others.
const ROWS: [usize; 2] = [9, 5];

/// The plot of a course, which `Display` writes as lines of text.
#[derive(Debug)]
pub struct Timeline<'a> {
    title: &'a str,
    course: &'a CourseFigure,
    columns: usize,
}

impl<'a> Timeline<'a> {
    /// A plot as wide as the terminal, or 80 columns wide if standard output is not a terminal.
    pub fn new(title: &'a str, course: &'a CourseFigure) -> Self {
        Self {
            title,
            course,
            columns: columns(),
        }
    }

    /// The column of a time.
    fn column(&self, time_s: f64) -> usize {
        (self.course.along(time_s) * (self.columns - 1) as f64).round() as usize
    }

    fn write_strip(&self, f: &mut fmt::Formatter<'_>, strip: &Strip, rows: usize) -> fmt::Result {
        let mut canvas = Canvas::new(self.columns, rows);
        for event in &self.course.events {
            canvas.stem(self.column(event.at_s), 0.0, 1.0);
        }
        for (time_s, value) in self.course.at_s.iter().zip(&strip.values) {
            let column = self.column(f64::from(*time_s));
            canvas.mark(column, strip.up(f64::from(*value)), '●');
        }
        let labels = strip.ticks.iter();
        let mut labels: Vec<(usize, String)> = labels
            .map(|(value, label)| (canvas.row(strip.up(*value)), label.replace('−', "-")))
            .collect();
        // Few rows have room for the outermost labels only.
        if labels.len() > rows / 2 {
            let last = labels.len() - 1;
            labels = vec![labels.swap_remove(last), labels.swap_remove(0)];
        }
        writeln!(f, "           {}", strip.title)?;
        write_panel(f, &canvas, &labels)
    }
}

impl fmt::Display for Timeline<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        for (number, strip) in self.course.strips.iter().enumerate() {
            self.write_strip(f, strip, ROWS[number.min(1)])?;
        }
        let ticks = self.course.times.iter();
        let ticks = ticks.map(|(time_s, label)| (self.column(*time_s), label.clone()));
        let (_, unit) = self.course.across.split_once(", ").unwrap_or_default();
        write_axis(f, self.columns, unit, ticks)
    }
}
