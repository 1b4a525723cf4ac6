//! The plot of a record agrees with its figures and its text.

use program::{ADIS16405, json, number, output, refusal, rows};
use resvg::tiny_skia::Pixmap;
use roxmltree::Document;
use serde_json::Value;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};
use tempfile::TempDir;

/// The number of columns to the left of the panels.
const MARGIN: usize = 11;

/// A panel of a plot: its labelled rows, and the cells of its marks from left to right.
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

/// The two panels that follow the first line of a plot.
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

/// The last sentence about where the model of an axis fails.
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
            let (top, bottom) = (&residual.labels[0], residual.labels.last().unwrap());
            assert_eq!((top.0, bottom.0), (0, residual.rows - 1));
            assert_eq!(top.1, -bottom.1);
            // The scale is linear near zero and logarithmic beyond.
            let along = |z: f64| (z / 3.0).asinh() / (top.1 / 3.0).asinh();
            let half = 0.5 * (residual.rows - 1) as f64;
            // Rows with labels are exact, and the values between them are interpolated.
            let (high, low) = (curve.labels[0], curve.labels[curve.labels.len() - 1]);
            let per_row = (high.1 / low.1).ln() / (low.0 - high.0) as f64;
            for (k, octave) in octaves.iter().enumerate() {
                let (column, row) = residual.marks[k];
                assert_eq!(column, curve.marks[k].0);
                let expected = k as f64 / (octaves.len() - 1) as f64 * 67.0;
                assert!((column as f64 - expected).abs() <= 0.5);
                let expected = half * (1.0 - along(number(&octave["z"])));
                assert!((row as f64 - expected).abs() <= 0.501, "{row}: {octave}");
                let row = curve.marks[k].1 as f64;
                let measured = number(&octave["measured"]);
                let expected = high.0 as f64 + (high.1 / measured).ln() / per_row;
                assert!((row - expected).abs() < 2.0, "{row}: {expected}");
            }
        }
    }
}

#[test]
fn text_plot_and_json_agree() {
    for command in ["compare", "diagnose"] {
        let text = output(Path::new("."), &[command, ADIS16405]);
        let document = json(Path::new("."), &[command, ADIS16405]);
        for axis in document["axes"].as_array().unwrap() {
            let last = match axis["steps"].as_array() {
                Some(steps) => &steps[steps.len() - 1],
                None => axis,
            };
            let (tau_s, z) = (number(&last["worst"]["tau_s"]), number(&last["worst"]["z"]));
            // This is the sentence about the last model.
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
                    || sentence.contains(&format!(" % at {time}")),
                "{sentence}"
            );
            // This is the mark in the plot that lies farthest from the model.
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
fn no_plot_is_drawn_for_a_file_that_is_absent() {
    let refused = refusal(Path::new("."), &["compare", "absent.json"]);
    assert!(refused.contains("no such file"), "{refused}");
}

/// The output of the program in a terminal with the given number of columns.
fn in_a_terminal(columns: u32, variables: &[(&str, &str)]) -> String {
    let program = program::path();
    let program = program.display();
    let line = format!("stty cols {columns} rows 40; {program} compare {ADIS16405}");
    let mut script = Command::new("script");
    script.args(["--quiet", "--return", "--command", &line, "/dev/null"]);
    script.env("TERM", "xterm-256color").env_remove("NO_COLOR");
    script.env_remove("CLICOLOR_FORCE").env_remove("CLICOLOR");
    let output = script.envs(variables.iter().copied()).stdin(Stdio::null());
    let output = output.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_terminal_gets_colours_unless_disabled_and_sets_the_width() {
    assert!(in_a_terminal(100, &[]).contains('\u{1b}'));
    for columns in [60, 100] {
        let text = in_a_terminal(columns, &[("NO_COLOR", "1")]);
        assert!(!text.contains('\u{1b}'));
        let axis = text.lines().map(|line| line.trim_end_matches('\r'));
        let axis = axis.filter(|line| line.contains('└'));
        let widths: Vec<usize> = axis.map(|line| line.chars().count()).collect();
        // Three axes, each with its Allan deviation and its spectrum.
        assert_eq!(widths, [columns as usize - 1; 6]);
    }
}

/// The positions of a drawing's marks of octaves: first those of the curve, then those of the
/// residual.
fn marks(drawing: &Document) -> Vec<(f64, f64)> {
    let circles = drawing
        .descendants()
        .filter(|node| node.has_tag_name("circle"));
    let marks = circles.filter(|circle| circle.attribute("r") == Some("3.5"));
    let place = |circle: roxmltree::Node, name| circle.attribute(name).unwrap().parse().unwrap();
    marks
        .map(|mark| (place(mark, "cx"), place(mark, "cy")))
        .collect()
}

#[test]
fn drawing_has_its_marks_at_the_figures_and_describes_them_in_words() {
    let folder = TempDir::new().unwrap();
    let arguments = [
        "plot",
        ADIS16405,
        "--axis",
        "gz",
        "--step",
        "0",
        "--output",
        "curve.svg",
        "--what",
        "deviation",
    ];
    assert!(output(folder.path(), &arguments).contains("wrote curve.svg: "));
    let text = fs::read_to_string(folder.path().join("curve.svg")).unwrap();
    let drawing = Document::parse(&text).unwrap();
    // The first step of a diagnosis equals the output of `compare`.
    let document = json(Path::new("."), &["compare", ADIS16405]);
    let octaves = document["axes"][2]["octaves"].as_array().unwrap();
    let marks = marks(&drawing);
    let (curve, rest) = marks.split_at(octaves.len());
    let residual = &rest[..octaves.len()];
    let last = octaves.len() - 1;
    let value = |k: usize, key: &str| number(&octaves[k][key]);
    let log = |k: usize, key: &str| value(k, key).ln();
    let z = |k: usize| (value(k, "z") / 3.0).asinh();
    let share = |from: f64, at: f64, to: f64| (at - from) / (to - from);
    for k in 0..=last {
        assert_eq!(curve[k].0, residual[k].0);
        let across = share(curve[0].0, curve[k].0, curve[last].0);
        let expected = share(log(0, "tau_s"), log(k, "tau_s"), log(last, "tau_s"));
        assert!((across - expected).abs() < 1e-4, "{k}");
        let up = share(curve[0].1, curve[k].1, curve[last].1);
        let expected = share(
            log(0, "measured"),
            log(k, "measured"),
            log(last, "measured"),
        );
        assert!((up - expected).abs() < 1e-3, "{k}: {up}, {expected}");
        let up = share(residual[0].1, residual[k].1, residual[1].1);
        let expected = share(z(0), z(k), z(1));
        assert!((up - expected).abs() < 1e-3, "{k}: {up}, {expected}");
    }
    let words = drawing
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    let words: Vec<&str> = words
        .filter_map(|node| node.text())
        .map(str::trim)
        .collect();
    for expected in [
        "gz: five terms",
        "Allan deviation σ, deg/s",
        "residual, std. errors",
        "averaging time τ",
        "measured ± std. error",
        "model",
        "angle random walk",
        "0.1",
        "1 s",
        "worst octave: +57",
    ] {
        assert!(words.contains(&expected), "{expected}: {words:?}");
    }
}

#[test]
fn picture_of_all_axes_decodes_and_has_letters_without_any_font_installed() {
    let folder = TempDir::new().unwrap();
    let arguments = ["plot", ADIS16405, "--output", "curve.png"];
    output(folder.path(), &arguments);
    let bytes = fs::read(folder.path().join("curve.png")).unwrap();
    let picture = Pixmap::decode_png(&bytes).unwrap();
    output(folder.path(), &["plot", ADIS16405, "--output", "CURVE.SVG"]);
    let text = fs::read_to_string(folder.path().join("CURVE.SVG")).unwrap();
    let drawing = Document::parse(&text).unwrap();
    let size = |name| {
        drawing
            .root_element()
            .attribute(name)
            .unwrap()
            .parse::<u32>()
            .unwrap()
    };
    assert_eq!(picture.width(), 2 * size("width"));
    assert_eq!(picture.height(), 2 * size("height"));
    // The title of each of the three axes has dark pixels in its line and none above.
    let dark = |rows: std::ops::Range<u32>| {
        let pixels = rows.flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
        pixels
            .filter(|(x, y)| picture.pixel(*x, *y).unwrap().green() < 128)
            .count()
    };
    for axis in 0..3 {
        let top = axis * picture.height() / 3;
        assert_eq!(dark(top..top + 30), 0);
        assert!(dark(top + 40..top + 80) > 500);
    }
}

#[test]
fn pictures_that_cannot_be_drawn_are_refused() {
    let folder = TempDir::new().unwrap();
    let absent = ["plot", ADIS16405, "--axis", "gq", "--output", "curve.svg"];
    for (arguments, message) in rows! {
        &["plot", ADIS16405, "--output", "curve.jpg"][..], "curve.jpg: a picture must end in .svg or .png; rename the output";
        &["plot", ADIS16405, "--output", "curve"], "a picture must end in .svg or .png";
        &["plot", ADIS16405, "--output", "absent/curve.svg"], "its folder does not exist";
        &["plot", "absent.csv", "--output", "curve.svg"], "absent.csv: no such file";
        &absent, "there is no axis \"gq\"; choose from gx, gy, gz";
    } {
        let refused = refusal(folder.path(), arguments);
        assert!(refused.contains(message), "{refused}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn drawing_is_well_formed_for_any_name_of_an_axis() {
    let folder = TempDir::new().unwrap();
    let name = "<g x=\"\">&amp;\u{1}\u{fffe}</g>";
    let mut curves: Value = serde_json::from_str(&fs::read_to_string(ADIS16405).unwrap()).unwrap();
    curves["axes"][0]["axis"] = name.into();
    fs::write(folder.path().join("curve.json"), curves.to_string()).unwrap();
    for file in ["curve.svg", "curve.png"] {
        output(folder.path(), &["plot", "curve.json", "--output", file]);
    }
    let text = fs::read_to_string(folder.path().join("curve.svg")).unwrap();
    let drawing = Document::parse(&text).unwrap();
    let shown = format!("{}: five", name.replace(['\u{1}', '\u{fffe}'], " "));
    let mut words = drawing.descendants().filter_map(|node| node.text());
    assert!(words.any(|words| words.trim().starts_with(&shown)));
}
