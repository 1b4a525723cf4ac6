//! What `plot` draws of a record over time agrees with the log, and a record that is not valid says so first.

use crate::INVALID;
use crate::drawing::{
    coordinate, dots, drawn, elements, frames, labels, labels_below, part, simulate,
};
use allanite_host::verdict::{INVALID_CURVE, on_badge};
use program::{json, number, output};
use roxmltree::Document;
use std::{fs, path::Path};
use tempfile::TempDir;

/// Changes the rates of a log: the first column of every row after the header.
pub(crate) fn change(folder: &Path, mut disturb: impl FnMut(usize, f64) -> f64) {
    let path = folder.join("log.csv");
    let text = fs::read_to_string(&path).unwrap();
    let mut row = 0;
    let lines = text.lines().map(|line| {
        let (rate, rest) = line.split_once(',').unwrap_or((line, ""));
        let Ok(rate) = rate.parse::<f64>() else {
            return line.to_owned();
        };
        row += 1;
        let comma = if rest.is_empty() { "" } else { "," };
        format!("{}{comma}{rest}", disturb(row - 1, rate))
    });
    let lines: Vec<String> = lines.collect();
    fs::write(path, lines.join("\n") + "\n").unwrap();
}

/// The numbers in a column of a log.
fn column(folder: &Path, column: usize) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("log.csv")).unwrap();
    let cells = text
        .lines()
        .filter_map(|line| line.split(',').nth(column)?.parse().ok());
    cells.collect()
}

/// The mean of every block of a record of 2^16 samples.
fn means(values: &[f64]) -> Vec<f64> {
    let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
    values.chunks(1024).map(mean).collect()
}

#[test]
fn the_rate_over_time_has_block_means_a_temperature_and_events() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["thermal:slope=0.001,kelvin=10,period_s=300"],
    );
    // 400 s of 655 s.
    change(folder.path(), |at, rate| {
        rate + if at < 40_000 { 0.0 } else { 0.2 }
    });
    let arguments = ["log.csv", "--covariates", "temp_C", "--what", "rate"];
    let text = drawn(folder.path(), &arguments);
    let drawing = Document::parse(&text).unwrap();
    let part = part(&drawing, "rate");
    assert!(labels_below(part) >= 2);
    let frames = frames(part);
    assert_eq!(frames.len(), 3, "rate, noise and temperature");
    assert!(frames.iter().all(|frame| labels(part, *frame).len() >= 2));
    let dots = dots(part, frames[0]);
    assert_eq!(dots.len(), 64);
    let means = means(&column(folder.path(), 0));
    let (from, to) = (0, 63);
    for (dot, mean) in dots.iter().zip(&means) {
        let share = (dot.1 - dots[from].1) / (dots[to].1 - dots[from].1);
        let expected = (mean - means[from]) / (means[to] - means[from]);
        assert!((share - expected).abs() < 2e-3, "{share} {expected}");
    }
    let words: Vec<&str> = elements(part, "text", "")
        .into_iter()
        .filter_map(|text| text.text())
        .map(str::trim)
        .collect();
    for expected in ["rate − mean, deg/s", "noise, deg/s", "temp_C", "time, min"] {
        assert!(words.contains(&expected), "{expected}: {words:?}");
    }
    assert!(
        words.iter().any(|words| words.starts_with("step, +0.")),
        "{words:?}"
    );
    // The event is drawn at its time.
    let diagnosis = json(
        folder.path(),
        &["diagnose", "log.csv", "--covariates", "temp_C"],
    );
    let events = diagnosis["axes"][0]["events"].as_array().unwrap();
    let lines = elements(part, "line", "event");
    assert_eq!(lines.len(), events.len());
    let per_second = (dots[63].0 - dots[0].0) / (63.0 * 10.24);
    for (line, event) in lines.iter().zip(events) {
        let expected = dots[0].0 + per_second * (number(&event["at_s"]) - 5.12);
        let x = coordinate(line, "x1");
        assert!((x - expected).abs() < 0.1, "{x} {expected}");
    }
}

#[test]
fn a_temperature_is_drawn_in_its_unit_whether_it_was_asked_for_or_not() {
    let folder = TempDir::new().unwrap();
    let effect = "thermal:slope=0.001,kelvin=10,period_s=300";
    simulate(folder.path(), &[effect]);
    let means = means(&column(folder.path(), 1));
    let swing = means.iter().copied().fold(f64::MIN, f64::max) - means[0];
    assert!(swing > 5.0, "{swing}");
    let options: [&[&str]; 3] = [&[], &["--covariates", "temp_C"], &["--no-covariates"]];
    for asked in options {
        let text = drawn(
            folder.path(),
            &[&["log.csv", "--what", "rate"], asked].concat(),
        );
        let drawing = Document::parse(&text).unwrap();
        let part = part(&drawing, "rate");
        let frames = frames(part);
        if asked == ["--no-covariates"] {
            assert_eq!(frames.len(), 2, "rate and noise");
            continue;
        }
        assert_eq!(frames.len(), 3, "rate, noise and temperature");
        let labels = labels(part, frames[2]);
        let [(low, from), (high, to)] = [labels.first(), labels.last()].map(|label| {
            let (words, y) = label.unwrap();
            (words.parse::<f64>().unwrap(), *y)
        });
        let dots = dots(part, frames[2]);
        assert_eq!(dots.len(), 64);
        for (dot, mean) in dots.iter().zip(&means) {
            let value = low + (high - low) * (dot.1 - from) / (to - from);
            assert!((value - mean).abs() < 0.01 * swing, "{value} {mean}");
        }
    }
}

#[test]
fn motion_is_an_event_of_the_picture() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    // From 300 s on the gyro is turned to and fro for 20 s.
    change(folder.path(), |at, rate| match at {
        30_000..32_000 => rate + 20.0 * (0.01 * at as f64).sin(),
        _ => rate,
    });
    let text = drawn(folder.path(), &["log.csv", "--what", "rate"]);
    assert!(text.contains("The curve is not valid: "));
    let drawing = Document::parse(&text).unwrap();
    let part = part(&drawing, "rate");
    let lines = elements(part, "line", "event");
    assert_eq!(lines.len(), 1);
    let dots = dots(part, frames(part)[0]);
    let per_second = (dots[63].0 - dots[0].0) / (63.0 * 10.24);
    let at_s = 5.12 + (coordinate(&lines[0], "x1") - dots[0].0) / per_second;
    assert!((at_s - 300.0).abs() < 5.0, "{at_s}");
    assert!(text.contains(">\nmotion\n<"));
}

#[test]
fn a_record_that_is_not_valid_says_so_first() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    change(
        folder.path(),
        |at, rate| if at == 12_345 { 500.0 } else { rate },
    );
    let text = drawn(folder.path(), &["log.csv"]);
    let drawing = Document::parse(&text).unwrap();
    let first = drawing.descendants().find(|node| node.has_tag_name("text"));
    let first = first.unwrap().text().unwrap().trim().to_owned();
    assert!(first.starts_with("The curve is not valid: "), "{first}");
    let printed = output(folder.path(), &["diagnose", "log.csv"]);
    let first = printed.lines().next().unwrap();
    assert!(first.contains(": not valid: "), "{first}");
    assert!(
        printed.contains(&format!("\n{INVALID_CURVE}: ")),
        "{printed}"
    );
    output(
        folder.path(),
        &["report", "log.csv", "--output", "page.html"],
    );
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    let (_, lead) = page.split_once(on_badge(INVALID)).unwrap();
    assert!(lead.contains(&format!("<p>{INVALID_CURVE}: ")), "no lead");
    simulate(folder.path(), &[]);
    let text = drawn(folder.path(), &["log.csv"]);
    assert!(!text.contains("not valid"));
}
