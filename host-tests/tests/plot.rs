//! The plot of a record says what its figures and its words say.

mod common;

use common::{ADIS16405, json, output, refusal};
use serde_json::Value;
use std::path::Path;

/// Columns left of the panels.
const MARGIN: usize = 11;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A panel of a plot: labelled rows, and the cells of its marks, from the left.
#[derive(Debug)]
struct Panel {
    labels: Vec<(usize, f64)>,
    marks: Vec<(usize, usize)>,
    rows: usize,
}

impl Panel {
    fn of(lines: &[&str]) -> Self {
        let mut panel = Self {
            labels: Vec::new(),
            marks: Vec::new(),
            rows: lines.len(),
        };
        for (row, line) in lines.iter().enumerate() {
            let cells: Vec<char> = line.chars().collect();
            let label: String = cells[..MARGIN - 1].iter().collect();
            if cells[MARGIN - 1] == '┤' {
                panel.labels.push((row, label.trim().parse().unwrap()));
            }
            let marks = cells.iter().skip(MARGIN).enumerate();
            let marks = marks.filter(|(_, cell)| **cell == '●');
            panel.marks.extend(marks.map(|(column, _)| (column, row)));
        }
        panel.marks.sort_unstable();
        panel
    }
}

/// The two panels behind the line that begins a plot.
fn panels(text: &str, axis: &str) -> (Panel, Panel) {
    let title = format!("{axis}: Allan deviation of");
    let lines: Vec<&str> = text
        .lines()
        .skip_while(|line| !line.starts_with(&title))
        .collect();
    let heading = |words: &str| {
        let found = lines.iter().position(|line| line.contains(words));
        found.unwrap_or_else(|| panic!("{words}"))
    };
    let residual = heading("in standard errors");
    let times = heading("└");
    let curve = Panel::of(&lines[heading("● measured") + 1..residual]);
    (curve, Panel::of(&lines[residual + 1..times]))
}

/// The last sentence on where a model fails, of an axis.
fn sentence<'a>(text: &'a str, axis: &str) -> &'a str {
    let is_heading = |line: &&str| line.contains(" samples at ");
    let start = format!("{axis}: ");
    let mut lines = text
        .lines()
        .skip_while(|line| !(is_heading(line) && line.starts_with(&start)));
    lines.next();
    let section = lines.take_while(|line| !is_heading(line));
    section.filter(|line| line.contains("σ)")).last().unwrap()
}

#[test]
fn marks_lie_where_the_figures_are() {
    for more in [&[][..], &["--with", "low_pass:time_constant_s=0.0057"]] {
        let arguments = [&["compare", ADIS16405], more].concat();
        let text = output(Path::new("."), &arguments);
        let document = json(Path::new("."), &arguments);
        for axis in document["axes"].as_array().unwrap() {
            let (curve, residual) = panels(&text, axis["axis"].as_str().unwrap());
            let octaves = axis["octaves"].as_array().unwrap();
            assert_eq!(curve.marks.len(), octaves.len());
            assert_eq!(residual.marks.len(), octaves.len());
            let (top, bottom) = (&residual.labels[0], &residual.labels[2]);
            assert_eq!((top.0, bottom.0), (0, residual.rows - 1));
            assert_eq!(top.1, -bottom.1);
            let step = 2.0 * top.1 / (residual.rows - 1) as f64;
            // Rows of labels are whole, the values between them are not.
            let (high, low) = (curve.labels[0], curve.labels[curve.labels.len() - 1]);
            let per_row = (high.1 / low.1).ln() / (low.0 - high.0) as f64;
            for (k, octave) in octaves.iter().enumerate() {
                let (column, row) = residual.marks[k];
                assert_eq!(column, curve.marks[k].0);
                let expected = k as f64 / (octaves.len() - 1) as f64 * 67.0;
                assert!((column as f64 - expected).abs() <= 0.5);
                let z = top.1 - step * row as f64;
                assert!(
                    (z - number(&octave["z"])).abs() <= 0.501 * step,
                    "{z}: {octave}"
                );
                let row = curve.marks[k].1 as f64;
                let measured = number(&octave["measured"]);
                let expected = high.0 as f64 + (high.1 / measured).ln() / per_row;
                assert!((row - expected).abs() < 2.0, "{row}: {expected}");
            }
        }
    }
}

#[test]
fn words_plot_and_figures_agree() {
    for command in ["compare", "diagnose"] {
        let text = output(Path::new("."), &[command, ADIS16405]);
        let document = json(Path::new("."), &[command, ADIS16405]);
        for axis in document["axes"].as_array().unwrap() {
            let last = match axis["steps"].as_array() {
                Some(steps) => &steps[steps.len() - 1],
                None => axis,
            };
            let (tau_s, z) = (number(&last["worst"]["tau_s"]), number(&last["worst"]["z"]));
            // The sentence on the last model.
            let name = axis["axis"].as_str().unwrap();
            let time = match tau_s {
                tau_s if tau_s < 0.1 => format!("τ = {:.1} ms", 1e3 * tau_s),
                tau_s if tau_s < 1.0 => format!("τ = {:.0} ms", 1e3 * tau_s),
                tau_s if tau_s < 10.0 => format!("τ = {tau_s:.2} s"),
                tau_s if tau_s < 100.0 => format!("τ = {tau_s:.1} s"),
                tau_s => format!("τ = {tau_s:.0} s"),
            };
            let sentence = sentence(&text, name);
            let side = if z > 0.0 { "above" } else { "below" };
            assert!(
                sentence.contains(&format!(" {side} the model at {time}"))
                    || sentence.contains(&format!("the worst, at {time}")),
                "{sentence}"
            );
            // The mark that lies farthest off, in the plot.
            let (_, residual) = panels(&text, name);
            let middle = residual.rows / 2;
            let far = |row: usize| row.abs_diff(middle);
            let farthest = residual
                .marks
                .iter()
                .map(|(_, row)| far(*row))
                .max()
                .unwrap();
            let at = (tau_s / 0.01).log2().round() as usize;
            let (_, row) = residual.marks[at];
            assert_eq!(far(row), farthest, "{name}: {tau_s} s");
            assert_eq!(row < middle, z > 0.0, "{name}: {tau_s} s");
        }
    }
}

#[test]
fn nothing_is_coloured_or_wider_than_usual_without_a_terminal() {
    let text = output(Path::new("."), &["compare", ADIS16405]);
    assert!(!text.contains('\u{1b}'));
    let plot = text.lines().filter(|line| line.contains(['│', '┤', '└']));
    assert!(plot.map(|line| line.chars().count()).max() <= Some(80));
}

#[test]
fn no_plot_is_drawn_of_what_cannot_be_compared() {
    let refused = refusal(Path::new("."), &["compare", "absent.json"]);
    assert!(refused.contains("no such file"), "{refused}");
}
