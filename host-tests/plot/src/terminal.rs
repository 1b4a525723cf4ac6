//! The plot in a terminal: lines of text, with the model in braille dots.

use super::{canvas::Canvas, figure::Figure, frame::Frame, lines::Line, quantity::Quantity, ticks};
use allanite_log::unit::Unit;
use console::{Term, style};
use std::fmt;

/// Columns of the labels left of the panels, including the axis.
pub(super) const MARGIN: usize = 11;
/// Rows of the panel of the curve.
const CURVE_ROWS: usize = 14;
/// Rows of the panel of residuals. The number is odd, so that zero is in the middle row.
const RESIDUAL_ROWS: usize = 11;
/// Range of widths, in columns, in which a plot is readable.
const WIDTHS: std::ops::RangeInclusive<usize> = 50..=120;
/// The width, in columns, if standard output is not a terminal.
const USUAL_WIDTH: usize = 80;

/// The number of columns of a plot's panels. A plot is as wide as the terminal, or 80 columns wide if standard output is
/// not a terminal.
pub(super) fn columns() -> usize {
    let terminal = Term::stdout().size_checked();
    let width = terminal.map_or(USUAL_WIDTH, |(_, columns)| usize::from(columns));
    width.clamp(*WIDTHS.start(), *WIDTHS.end()) - MARGIN - 1
}

/// The plot of a figure, which `Display` writes as lines of text.
#[derive(Debug)]
pub struct Plot<'a> {
    title: &'a str,
    unit: Unit,
    figure: &'a Figure,
    frame: &'a Frame,
    columns: usize,
}

impl<'a> Plot<'a> {
    /// The plot of a figure in a unit of the rate.
    pub fn new(title: &'a str, unit: Unit, figure: &'a Figure, frame: &'a Frame) -> Self {
        Self {
            title,
            unit,
            figure,
            frame,
            columns: columns(),
        }
    }

    /// The column of an averaging time or a frequency.
    fn column(&self, x: f32) -> usize {
        (self.frame.x.along(f64::from(x)) * (self.columns - 1) as f64).round() as usize
    }

    fn write_curve(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Frame { quantity, x, y, .. } = self.frame;
        let measured = &self.figure.measured;
        let mut canvas = Canvas::new(self.columns, CURVE_ROWS);
        let Line(pieces) = &self.figure.model;
        for pair in pieces.iter().flat_map(|piece| piece.windows(2)) {
            let place = |[across, up]: [f32; 2]| (x.along(across.into()), y.along(up.into()));
            canvas.line(place(pair[0]), place(pair[1]));
        }
        for (at, value) in measured.x.iter().zip(&measured.measured) {
            canvas.mark(self.column(*at), y.along(f64::from(*value)), '●');
        }
        let labels = y.ticks().into_iter();
        let labels: Vec<(usize, String)> = labels
            .map(|value| (canvas.row(y.along(value)), ticks::power(value)))
            .collect();
        writeln!(f, "{}", self.title)?;
        let unit = match quantity {
            Quantity::Deviation => self.unit.name().to_owned(),
            Quantity::Density => quantity.unit(self.unit),
        };
        writeln!(f, "{unit:>9}  {Legend}")?;
        write_panel(f, &canvas, &labels)
    }

    fn write_residual(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let up = |z: f64| self.frame.up(z);
        let mut canvas = Canvas::new(self.columns, RESIDUAL_ROWS);
        canvas.rule(canvas.row(0.5));
        for (x, z) in self.figure.measured.x.iter().zip(&self.figure.z) {
            canvas.stem(self.column(*x), up(0.0), up(f64::from(*z)));
        }
        // Bins can share a column, in which no line hides a mark.
        for (x, z) in self.figure.measured.x.iter().zip(&self.figure.z) {
            canvas.mark(self.column(*x), up(f64::from(*z)), '●');
        }
        let labels = self.frame.residuals().into_iter();
        let labels: Vec<(usize, String)> = labels
            .map(|(z, label)| (canvas.row(up(z)), label.replace('−', "-")))
            .collect();
        writeln!(f, "{:>9}  measured minus model, in standard errors", "σ")?;
        write_panel(f, &canvas, &labels)
    }

    /// Writes the horizontal axis.
    fn write_axis(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.frame.quantity {
            Quantity::Deviation => "τ",
            Quantity::Density => "Hz",
        };
        let ticks = self.frame.across().into_iter();
        let ticks = ticks.map(|(value, label)| (self.column(value as f32), label));
        write_axis(f, self.columns, name, ticks)
    }
}

impl fmt::Display for Plot<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.figure.measured.x.is_empty() {
            return Ok(());
        }
        self.write_curve(f)?;
        self.write_residual(f)?;
        self.write_axis(f)
    }
}

/// Writes a horizontal axis with the labels for which there is room.
pub(super) fn write_axis(
    f: &mut fmt::Formatter<'_>,
    columns: usize,
    name: &str,
    ticks: impl Iterator<Item = (usize, String)>,
) -> fmt::Result {
    let mut axis = vec!['─'; columns];
    let mut labels = String::new();
    let mut written = 0;
    for (column, label) in ticks {
        let length = label.chars().count();
        if column < written || column >= columns || column + length > columns + 1 {
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
    let name = format!("{name} ");
    writeln!(f, "{name:>width$}{}", labels.trim_end(), width = MARGIN)
}

struct Legend;

impl fmt::Display for Legend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (measured, model) = (style('●').yellow(), style("⠤⠤").cyan());
        write!(f, "{measured} measured  {model} model")
    }
}

/// Writes the rows of a canvas with their labels. Colours are written only if the terminal shows them.
pub(super) fn write_panel(
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
