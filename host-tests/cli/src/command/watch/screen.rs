//! The screen of a recording: the curves with their models above, the coefficients below, and what is missing.

use super::status::{AxisStatus, Status, verdict, waiting};
use allanite::Comparison;
use allanite_host::{
    fit,
    number::{duration, number},
    units,
};
use crossterm::{
    cursor::{Hide, Show},
    execute,
    terminal::{self, EnterAlternateScreen, LeaveAlternateScreen},
};
use ratatui::{
    Frame, Terminal, TerminalOptions, Viewport,
    backend::CrosstermBackend,
    layout::{Constraint, Layout, Rect},
    style::{Color, Modifier, Style},
    symbols::Marker,
    text::{Line, Span},
    widgets::{Axis, Block, Chart, Dataset, GraphType, Paragraph, Row, Table},
};
use std::io::{self, Stdout};

/// The colours of the axes; further axes start again with the first colour.
const COLOURS: [Color; 6] = [
    Color::Cyan,
    Color::Yellow,
    Color::Magenta,
    Color::Green,
    Color::Blue,
    Color::Red,
];

/// The terminal while a recording is shown. Dropping the screen restores the terminal.
pub(super) struct Screen {
    /// It is there until this is dropped.
    terminal: Option<Terminal<CrosstermBackend<Stdout>>>,
    area: Rect,
}

/// The largest screen that is drawn, in columns and rows. A terminal may claim a size that fits into no memory.
const MOST_COLUMNS: u16 = 500;
const MOST_ROWS: u16 = 250;

/// The size of the terminal, as far as it is drawn.
fn area() -> io::Result<Rect> {
    let (columns, rows) = terminal::size()?;
    let [columns, rows] = [columns.min(MOST_COLUMNS), rows.min(MOST_ROWS)];
    Ok(Rect::new(0, 0, columns, rows))
}

impl Screen {
    /// Switches the terminal to the screen.
    ///
    /// # Errors
    /// When the terminal cannot be written to.
    pub(super) fn open() -> io::Result<Self> {
        let area = area()?;
        let options = TerminalOptions {
            viewport: Viewport::Fixed(area),
        };
        let terminal = Terminal::with_options(CrosstermBackend::new(io::stdout()), options)?;
        // The screen exists before the switch, so that an error drops it and restores the terminal.
        let screen = Self {
            terminal: Some(terminal),
            area,
        };
        execute!(io::stdout(), EnterAlternateScreen, Hide)?;
        Ok(screen)
    }

    /// Draws the status of a recording.
    pub(super) fn draw(&mut self, status: &Status) -> io::Result<()> {
        let area = area()?;
        if let Some(terminal) = &mut self.terminal {
            if area != self.area {
                terminal.resize(area)?;
                self.area = area;
            }
            terminal.draw(|frame| draw(frame, status))?;
        }
        Ok(())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // An error is ignored, because nothing can be done about a terminal that is gone.
        let _ = execute!(io::stdout(), LeaveAlternateScreen, Show);
        // Its own end would show the cursor once more, and panic where standard error is the terminal that is gone.
        if let Some(terminal) = self.terminal.take() {
            std::mem::forget(terminal);
        }
    }
}

/// Lines of an axis' table: a border with the title, a header, five coefficients, where the model fails, and a border
/// with what is missing.
const TABLE_ROWS: u16 = 9;

/// The least width of a table, in columns, that has the names of the terms.
const WIDE: u16 = 86;

fn draw(frame: &mut Frame<'_>, status: &Status) {
    let tables = TABLE_ROWS * status.axes.len() as u16;
    let [head, chart, tables, foot] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Min(8),
        Constraint::Max(tables),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    frame.render_widget(Paragraph::new(heading(status)), head);
    curves(frame, chart, status);
    let areas = Layout::vertical(status.axes.iter().map(|_| Constraint::Max(TABLE_ROWS)));
    for (i, (axis, area)) in status
        .axes
        .iter()
        .zip(areas.split(tables).iter())
        .enumerate()
    {
        table(
            frame,
            *area,
            axis,
            COLOURS[i % COLOURS.len()],
            (status.length_s(), status.rate_hz),
        );
    }
    let foot_line = format!("Ctrl-C saves and ends   {}", status.saving);
    frame.render_widget(Paragraph::new(foot_line).style(dim()), foot);
}

fn dim() -> Style {
    Style::new().add_modifier(Modifier::DIM)
}

fn heading(status: &Status) -> Line<'static> {
    let record = format!(
        "{}: {} samples at {} Hz",
        duration(status.length_s()),
        status.samples,
        status.rate_hz
    );
    let mut spans = vec![Span::styled(
        record,
        Style::new().add_modifier(Modifier::BOLD),
    )];
    if status.garbled > 0 {
        let lost = format!("   {}", status.losses());
        spans.push(Span::styled(lost, Style::new().fg(Color::Red)));
    }
    Line::from(spans)
}

/// Allan deviations over averaging times, on logarithmic axes.
fn curves(frame: &mut Frame<'_>, area: Rect, status: &Status) {
    let fitted = status.axes.iter().filter_map(|axis| axis.fitted.as_ref());
    let unit = fitted
        .clone()
        .next()
        .map_or("", |fitted| fitted.axis.unit.name());
    let drawn: Vec<Drawn<'_>> = status
        .axes
        .iter()
        .filter_map(|axis| {
            let points = axis.fitted.as_ref()?.curve.points().iter();
            Some(Drawn {
                name: &axis.name,
                measured: logarithms(points.map(|point| (point.tau_s, point.deviation()))),
                model: logarithms(model(axis)),
            })
        })
        .collect();
    let block = Block::bordered().title(format!("Allan deviation, {unit}, over τ, s; line: model"));
    let all = drawn
        .iter()
        .flat_map(|axis| axis.measured.iter().chain(&axis.model));
    let Some((x, y)) = bounds(all) else {
        let wait = Paragraph::new("waiting for two octaves of samples").block(block);
        frame.render_widget(wait, area);
        return;
    };
    let mut datasets = Vec::new();
    for (i, axis) in drawn.iter().enumerate() {
        let line = Dataset::default()
            .style(Style::new().fg(COLOURS[i % COLOURS.len()]))
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .data(&axis.model);
        let dots = line
            .clone()
            .name(axis.name)
            .marker(Marker::Dot)
            .graph_type(GraphType::Scatter)
            .data(&axis.measured);
        datasets.extend([line, dots]);
    }
    let labels = |[low, high]: [f64; 2]| {
        [low, 0.5 * (low + high), high].map(|exponent| number(10f64.powf(exponent)))
    };
    let chart = Chart::new(datasets)
        .block(block)
        .x_axis(Axis::default().bounds(x).labels(labels(x)).style(dim()))
        .y_axis(Axis::default().bounds(y).labels(labels(y)).style(dim()));
    frame.render_widget(chart, area);
}

/// The logarithms of averaging times and Allan deviations of an axis that is drawn.
struct Drawn<'a> {
    name: &'a str,
    measured: Vec<(f64, f64)>,
    model: Vec<(f64, f64)>,
}

fn logarithms(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let logarithms = points.map(|(tau_s, deviation)| (tau_s.log10(), deviation.log10()));
    logarithms.filter(|(_, y)| y.is_finite()).collect()
}

/// The averaging times and Allan deviations of a model: of that of the last diagnosis, or of the five terms before there
/// is one.
fn model(axis: &AxisStatus) -> impl Iterator<Item = (f64, f64)> + '_ {
    let found = axis
        .found
        .iter()
        .flat_map(|found| found.model.iter().copied());
    let five = axis.comparison.iter().filter(|_| axis.found.is_none());
    let five = five.flat_map(|comparison| &comparison.octaves);
    found.chain(five.map(|octave| (octave.tau_s, octave.model.sqrt())))
}

/// The ranges of both coordinates, in powers of ten. The vertical one has a margin. `None` without
/// points.
fn bounds<'a>(points: impl Iterator<Item = &'a (f64, f64)>) -> Option<([f64; 2], [f64; 2])> {
    // The margin, in powers of ten; chosen by hand.
    const ROOM: f64 = 0.1;
    let mut bounds: Option<([f64; 2], [f64; 2])> = None;
    for &(x, y) in points {
        let (xs, ys) = bounds.get_or_insert(([x, x], [y, y]));
        *xs = [xs[0].min(x), xs[1].max(x)];
        *ys = [ys[0].min(y), ys[1].max(y)];
    }
    bounds.map(|(x, [low, high])| (x, [low - ROOM, high + ROOM]))
}

/// Draws the table of an axis: its coefficients, and how much longer to record for those not yet
/// measured; where the model fails, and what is missing. `record` is the length of the record, in seconds, and
/// its rate.
fn table(
    frame: &mut Frame<'_>,
    area: Rect,
    axis: &AxisStatus,
    colour: Color,
    (length_s, rate_hz): (f64, f64),
) {
    let title = match &axis.fitted {
        Some(fitted) => format!("{}: {}", axis.name, verdict(&fitted.fit)),
        None => format!("{}: nothing to fit yet", axis.name),
    };
    let missing = axis.found.as_ref().map(|found| {
        let length = duration(found.samples as f64 / rate_hz);
        format!("{} (after {length})", found.brief)
    });
    let block = Block::bordered()
        .title(title)
        .title_bottom(missing.unwrap_or_default())
        .border_style(Style::new().fg(colour));
    let [rows, failure] =
        Layout::vertical([Constraint::Min(0), Constraint::Length(1)]).areas(block.inner(area));
    frame.render_widget(block, area);
    if let Some(worst) = axis.comparison.as_ref().and_then(Comparison::worst) {
        let words = format!(
            "largest difference: {:+.0} % at τ = {} ({:+.1} σ)",
            worst.percent(),
            duration(worst.tau_s),
            worst.z
        );
        frame.render_widget(Paragraph::new(words), failure);
    }
    let is_wide = area.width >= WIDE;
    let columns = if is_wide { 0.. } else { 1.. };
    let coefficients = axis.fitted.iter().flat_map(|fitted| {
        let unit = fitted.axis.unit;
        let columns = columns.clone();
        fitted.fit.coefficients.iter().map(move |one| {
            let (_, customary_unit) = units::customary(unit, one.half_seconds).unwrap_or((1.0, ""));
            let cells = [
                one.name.replace('_', " "),
                one.symbol.to_owned(),
                fit::table::customary(one, unit),
                customary_unit.to_owned(),
                fit::table::interval(one, unit),
                waiting(one, length_s),
            ];
            Row::new(cells[columns.clone()].to_vec())
        })
    });
    let widths = [17, 1, 11, 7, 19].map(Constraint::Length);
    let last = Constraint::Min(12);
    let widths = widths.into_iter().chain([last]).skip(columns.start);
    let header = [
        "effect",
        "",
        "value",
        "unit",
        "95 % interval",
        "how much longer",
    ];
    let table = Table::new(coefficients, widths)
        .header(Row::new(header[columns.clone()].to_vec()).style(dim()))
        .column_spacing(if is_wide { 2 } else { 1 });
    frame.render_widget(table, rows);
}

#[cfg(test)]
mod tests {
    use super::{super::status::tests::status, *};
    use allanite::diagnosis::Verdict;
    use allanite_host::verdict::{ADEQUATE, brief};
    use ratatui::backend::TestBackend;

    /// The end of a diagnosis that found nothing, and when it ended.
    fn none_is_missing() -> String {
        format!("{} (after 30.000 s)", brief(Verdict::Adequate, ""))
    }

    fn drawn(width: u16, height: u16, status: &Status) -> Vec<String> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| draw(frame, status)).unwrap();
        let buffer = terminal.backend().buffer();
        let row = |y| {
            (0..width)
                .map(|x| buffer[(x, y)].symbol())
                .collect::<String>()
        };
        (0..height).map(row).collect()
    }

    #[test]
    fn screen_has_the_record_its_curves_coefficients_and_verdicts() {
        let rows = drawn(100, 40, &status());
        let text = rows.join("\n");
        assert!(
            rows[0].starts_with("30.000 s: 3000 samples at 100 Hz   invalid lines: 1, gaps: 1")
        );
        assert!(
            rows[1].contains("Allan deviation, deg/s, over τ, s; line: model"),
            "{text}"
        );
        assert!(rows[39].starts_with("Ctrl-C saves and ends   curve.json was saved 3 s ago"));
        // The dots of the curves cover rows over the height of the chart.
        let braille = |row: &String| row.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c));
        assert!(
            rows[2..20].iter().filter(|row| braille(row)).count() >= 8,
            "{text}"
        );
        for (name, first) in [("left", 21), ("right", 30)] {
            assert!(
                rows[first].contains(&format!("┌{name}: {ADEQUATE}, p = 0.")),
                "{text}"
            );
            assert!(
                rows[first + 1].contains("effect") && rows[first + 1].contains("how much longer")
            );
            let symbols = ["Q", "N", "B", "K", "R"];
            for (row, symbol) in rows[first + 2..first + 7].iter().zip(symbols) {
                assert!(row.contains(&format!("  {symbol}  ")), "{text}");
            }
            let walk = &rows[first + 3];
            assert!(
                walk.contains("angle random walk  N  2.") && walk.contains("°/√h"),
                "{text}"
            );
            let waits = [" more", " without gaps", "never"];
            assert!(
                waits.iter().any(|wait| rows[first + 6].contains(wait)),
                "{text}"
            );
            assert!(rows[first + 7].contains("largest difference: "), "{text}");
            assert!(rows[first + 8].contains(&none_is_missing()), "{text}");
        }
    }

    /// A terminal of 60 columns leaves the names of the terms out, and cuts no number.
    #[test]
    fn sixty_columns_have_the_coefficients() {
        let rows = drawn(60, 40, &status());
        let text = rows.join("\n");
        assert!(rows[22].contains("how much longer"), "{text}");
        let walk = &rows[24];
        for part in ["│N 2.", " °/√h ", " … "] {
            assert!(walk.contains(part), "{text}");
        }
        assert!(rows[29].contains(&none_is_missing()), "{text}");
        assert!(rows[28].contains("σ)"), "{text}");
        assert!(rows[39].trim_end().ends_with("saved 3 s ago"), "{text}");
    }

    #[test]
    fn terminals_of_any_size_and_records_without_samples_are_drawn() {
        let mut empty = status();
        empty.axes.clear();
        for (width, height) in [(1, 1), (7, 3), (20, 10), (80, 24), (300, 100)] {
            for status in [&status(), &empty] {
                assert_eq!(drawn(width, height, status).len(), usize::from(height));
            }
        }
        assert!(drawn(60, 20, &empty)[2].contains("waiting for two octaves"));
    }
}
