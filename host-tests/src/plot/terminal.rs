//! The plot in a terminal: lines of text, with the model in braille dots.

use super::{canvas::Canvas, frame::Frame, ticks};
use crate::{
    log::{BINS, OCTAVES},
    unit::Unit,
};
use allanite::Comparison;
use console::{Term, style};
use std::fmt;

/// Columns of the labels left of the panels, including the axis.
const MARGIN: usize = 11;
/// Rows of the panel of the curve.
const CURVE_ROWS: usize = 14;
/// Rows of the panel of residuals. The number is odd, so that zero is in the middle row.
const RESIDUAL_ROWS: usize = 11;
/// Range of widths, in columns, in which a plot is readable.
const WIDTHS: std::ops::RangeInclusive<usize> = 50..=120;
/// The width, in columns, if standard output is not a terminal.
const USUAL_WIDTH: usize = 80;

/// The plot of a comparison, which `Display` writes as lines of text.
#[derive(Debug)]
pub struct Plot<'a> {
    title: &'a str,
    unit: Unit,
    comparison: &'a Comparison<OCTAVES, BINS>,
    frame: Frame,
    width: usize,
}

impl<'a> Plot<'a> {
    /// A plot as wide as the terminal, or 80 columns wide if standard output is not a terminal.
    pub fn new(title: &'a str, unit: Unit, comparison: &'a Comparison<OCTAVES, BINS>) -> Self {
        let terminal = Term::stdout().size_checked();
        let width = terminal.map_or(USUAL_WIDTH, |(_, columns)| usize::from(columns));
        Self {
            title,
            unit,
            comparison,
            frame: Frame::of([comparison]),
            width: width.clamp(*WIDTHS.start(), *WIDTHS.end()),
        }
    }

    /// Number of columns of the panels.
    fn columns(&self) -> usize {
        self.width - MARGIN - 1
    }

    /// The column of an averaging time.
    fn column(&self, tau_s: f64) -> usize {
        (self.frame.tau_s.along(tau_s) * (self.columns() - 1) as f64).round() as usize
    }

    fn write_curve(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let octaves = &self.comparison.octaves;
        let sigma = &self.frame.sigma;
        let up = |value: f64| sigma.along(value);
        let mut canvas = Canvas::new(self.columns(), CURVE_ROWS);
        for pair in octaves.windows(2) {
            let across = |i: usize| self.frame.tau_s.along(pair[i].tau_s);
            let at = |i: usize| (across(i), up(pair[i].model.sqrt()));
            canvas.line(at(0), at(1));
        }
        for octave in octaves {
            canvas.mark(self.column(octave.tau_s), up(octave.measured.sqrt()), '●');
        }
        let labels = sigma.ticks().into_iter();
        let labels: Vec<(usize, String)> = labels
            .map(|value| (canvas.row(up(value)), ticks::power(value)))
            .collect();
        writeln!(f, "{}", self.title)?;
        writeln!(f, "{:>9}  {}", self.unit.name(), Legend)?;
        write_panel(f, &canvas, &labels)
    }

    fn write_residual(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let octaves = &self.comparison.octaves;
        let largest = self.frame.z;
        let up = |z: f64| self.frame.up(z);
        let mut canvas = Canvas::new(self.columns(), RESIDUAL_ROWS);
        canvas.rule(canvas.row(0.5));
        for octave in octaves {
            canvas.stem(self.column(octave.tau_s), up(0.0), up(octave.z));
            canvas.mark(self.column(octave.tau_s), up(octave.z), '●');
        }
        let labels = [(largest, "+"), (0.0, ""), (-largest, "")];
        let labels = labels.map(|(z, sign)| (canvas.row(up(z)), format!("{sign}{z}")));
        writeln!(f, "{:>9}  measured minus model, in standard errors", "σ")?;
        write_panel(f, &canvas, &labels)
    }

    /// Writes the axis of averaging times.
    fn write_times(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut axis = vec!['─'; self.columns()];
        let mut labels = String::new();
        let mut written = 0;
        for tau_s in self.frame.tau_s.ticks() {
            let column = self.column(tau_s);
            let label = ticks::time(tau_s);
            let length = label.chars().count();
            if column < written || column + length > self.columns() + 1 {
                continue;
            }
            axis[column] = '┬';
            labels += &" ".repeat(column - written);
            labels += &label;
            written = column + length;
            // A space keeps the labels apart.
            labels.push(' ');
            written += 1;
        }
        let axis: String = axis.into_iter().collect();
        writeln!(f, "{:>width$}{axis}", "└", width = MARGIN)?;
        writeln!(f, "{:>width$}{}", "τ ", labels.trim_end(), width = MARGIN)
    }
}

impl fmt::Display for Plot<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.comparison.octaves.is_empty() {
            return Ok(());
        }
        self.write_curve(f)?;
        self.write_residual(f)?;
        self.write_times(f)
    }
}

struct Legend;

impl fmt::Display for Legend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (measured, model) = (style('●').yellow(), style("⠤⠤").cyan());
        write!(f, "{measured} measured  {model} model")
    }
}

/// Writes the rows of a canvas with their labels. Colours are written only if the terminal shows them.
fn write_panel(
    f: &mut fmt::Formatter<'_>,
    canvas: &Canvas,
    labels: &[(usize, String)],
) -> fmt::Result {
    for (row, cells) in canvas.rows().enumerate() {
        let label = labels.iter().find(|(at, _)| *at == row);
        let (text, tick) = label.map_or(("", '│'), |(_, text)| (text.as_str(), '┤'));
        write!(f, "{text:>width$} {tick}", width = MARGIN - 2)?;
        let end = cells.iter().rposition(|cell| *cell != ' ');
        for cell in &cells[..end.map_or(0, |end| end + 1)] {
            match cell {
                '●' => write!(f, "{}", style(cell).yellow())?,
                '\u{2801}'..='\u{28ff}' => write!(f, "{}", style(cell).cyan())?,
                _ => write!(f, "{cell}")?,
            }
        }
        writeln!(f)?;
    }
    Ok(())
}
