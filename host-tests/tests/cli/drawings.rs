//! What `plot` draws of the spectrum agrees with the figures of the diagnosis.

use crate::drawing::{
    coordinate, dots, drawn, elements, frames, labels, labels_below, part, simulate,
};
use program::{ADIS16405, json, number, refusal};
use roxmltree::Document;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// The bins of the last model of a diagnosis, in order of their frequencies.
fn bins(diagnosis: &Value, axis: usize) -> Vec<Value> {
    let mut bins = diagnosis["axes"][axis]["spectrum"]
        .as_array()
        .unwrap()
        .clone();
    bins.sort_by(|one, other| {
        number(&one["frequency_hz"]).total_cmp(&number(&other["frequency_hz"]))
    });
    bins
}

/// The points of a path, in pieces.
fn pieces(path: &str) -> Vec<Vec<(f64, f64)>> {
    let pieces = path.split('M').filter(|piece| !piece.trim().is_empty());
    let point = |text: &str| {
        let (x, y) = text.trim().split_once([',', ' ']).unwrap();
        (x.trim().parse().unwrap(), y.trim().parse().unwrap())
    };
    pieces
        .map(|piece| piece.split('L').map(point).collect())
        .collect()
}

#[test]
fn bins_their_errors_and_the_line_of_the_model_are_those_of_the_diagnosis() {
    let folder = TempDir::new().unwrap();
    let diagnosis = json(folder.path(), &["diagnose", ADIS16405]);
    let curves: Value = serde_json::from_str(&fs::read_to_string(ADIS16405).unwrap()).unwrap();
    let levels = curves["axes"][2]["spectrum"]["levels"].as_array().unwrap();
    let bins = bins(&diagnosis, 2);
    let text = drawn(folder.path(), &[ADIS16405, "--axis", "gz"]);
    let drawing = Document::parse(&text).unwrap();
    let part = part(&drawing, "spectrum");
    let [curve, residual] = frames(part)[..] else {
        panic!("two panels")
    };
    let (dots, residuals) = (dots(part, curve), dots(part, residual));
    let bars = elements(part, "line", "bar");
    assert_eq!([dots.len(), residuals.len(), bars.len()], [bins.len(); 3]);
    let value = |at: usize, key: &str| number(&bins[at][key]);
    let root = |at: usize, key: &str| 0.5 * value(at, key).ln();
    // Two bins give the scales, and all others must agree.
    let last = bins.len() - 1;
    let high = (0..bins.len()).max_by(|a, b| root(*a, "density").total_cmp(&root(*b, "density")));
    let scale = (dots[high.unwrap()].1 - dots[last].1)
        / (root(high.unwrap(), "density") - root(last, "density"));
    let y = |root: f64| dots[last].1 + scale * (root - super_root(&bins[last]));
    let x = |at: usize| value(at, "frequency_hz").ln();
    let label = labels(part, residual);
    let (end, top) = (label[0].0.parse::<f64>().unwrap(), label[0].1);
    let zero = label.iter().find(|(words, _)| words == "0").unwrap().1;
    let model = elements(part, "path", "model")[0].attribute("d").unwrap();
    let line: Vec<_> = pieces(model);
    let (mut inflated, mut checked) = (0, 0);
    for (at, dot) in dots.iter().enumerate() {
        let across = (dot.0 - dots[0].0) / (dots[last].0 - dots[0].0);
        assert!(
            (across - (x(at) - x(0)) / (x(last) - x(0))).abs() < 1e-4,
            "{at}"
        );
        assert!((dot.1 - y(root(at, "density"))).abs() < 0.05, "{at}");
        let share = (value(at, "z") / 3.0).asinh() / (end / 3.0).asinh();
        let expected = zero + share * (top - zero);
        assert_eq!(residuals[at].0, dot.0);
        assert!(
            (residuals[at].1 - expected).abs() < 0.05,
            "{at}: {expected}"
        );
        // The error of the mean of segments follows from their scatter, which the spectral kurtosis gives.
        let block = &bins[at]["block"];
        let level = levels
            .iter()
            .find(|level| level["block"] == *block)
            .unwrap();
        let densities = level["density"].as_array().unwrap();
        let place = densities.iter().position(|one| *one == bins[at]["density"]);
        let kurtosis = number(&level["kurtosis"][place.unwrap()]);
        let n = number(&level["segments"]);
        let error = (kurtosis * n / (n + 1.0) / (18.0 / 19.0 * n)).sqrt();
        let expected = [1.0 - error, 1.0 + error].map(|factor| {
            let y = y(root(at, "density") + 0.5 * factor.ln());
            y.clamp(curve[1] + 9.0, curve[3] - 9.0)
        });
        let bar = [coordinate(&bars[at], "y1"), coordinate(&bars[at], "y2")];
        for (drawn, expected) in bar.into_iter().zip(expected) {
            assert!((drawn - expected).abs() < 0.1, "{at}: {drawn} {expected}");
        }
        inflated += usize::from(kurtosis > 1.5);
        // The line passes through the density that the model has in the bin.
        let expected = y(root(at, "expected"));
        let ends = line.iter().find(|piece| {
            let near = |x: f64| (x - dot.0).abs() < 0.02;
            piece[0].0 <= dot.0 + 0.02
                && piece[piece.len() - 1].0 >= dot.0 - 0.02
                && (piece.iter().any(|point| near(point.0)) || piece.len() > 2)
        });
        let Some(piece) = ends else { continue };
        let after = piece
            .iter()
            .position(|point| point.0 >= dot.0 - 0.02)
            .unwrap();
        let [from, to] = [piece[after.saturating_sub(1)], piece[after]];
        let part = if to.0 > from.0 {
            (dot.0 - from.0) / (to.0 - from.0)
        } else {
            1.0
        };
        let drawn = from.1 + part * (to.1 - from.1);
        assert!((drawn - expected).abs() < 0.5, "{at}: {drawn} {expected}");
        checked += 1;
    }
    assert!(checked > last - 4, "{checked}");
    // The hump wanders, so that its bins scatter more than those of steady noise.
    assert!(inflated > 3, "{inflated}");
}

fn super_root(bin: &Value) -> f64 {
    0.5 * number(&bin["density"]).ln()
}

#[test]
fn all_steps_share_the_scales_and_every_dot_lies_inside_its_frame() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["resonance:frequency_hz=20,quality=20,rms=0.05"],
    );
    let mut shared: Option<Vec<_>> = None;
    for (input, axis) in [(ADIS16405, "gz"), ("log.csv", "gx")] {
        shared = None;
        for step in ["0", "1", "2"] {
            let text = drawn(folder.path(), &[input, "--axis", axis, "--step", step]);
            let drawing = Document::parse(&text).unwrap();
            let mut scales = Vec::new();
            for class in ["deviation", "spectrum", "rate"] {
                if class == "rate" && input == ADIS16405 {
                    continue;
                }
                let part = part(&drawing, class);
                assert!(labels_below(part) >= 2, "{class}");
                for frame in frames(part) {
                    let labels = labels(part, frame);
                    assert!(labels.len() >= 2, "{class}: {labels:?}");
                    let dots = dots(part, frame);
                    assert!(dots.len() >= 15, "{class}: {}", dots.len());
                    for (x, y) in dots {
                        let [left, top, right, bottom] = frame;
                        assert!(x - 3.5 > left && x + 3.5 < right, "{class}: {x}");
                        assert!(y - 3.5 > top && y + 3.5 < bottom, "{class}: {y}");
                    }
                    scales.push(labels);
                }
                let bars = elements(part, "line", "bar").into_iter();
                let bars = bars.map(|bar| {
                    let ends = ["y1", "y2"].map(|name| bar.attribute(name).unwrap());
                    (ends.join(" "), coordinate(&bar, "x1"))
                });
                // The bars are the data's, so that they are the same in all steps too.
                scales.push(bars.collect());
            }
            let first = shared.get_or_insert_with(|| scales.clone());
            assert_eq!(*first, scales, "{input}, step {step}");
        }
    }
    assert!(shared.is_some());
}

#[test]
fn models_are_smooth_between_octaves() {
    let folder = TempDir::new().unwrap();
    let text = drawn(
        folder.path(),
        &[ADIS16405, "--axis", "gx", "--what", "deviation"],
    );
    let drawing = Document::parse(&text).unwrap();
    let part = part(&drawing, "deviation");
    let model = elements(part, "path", "model")[0].attribute("d").unwrap();
    let points = pieces(model).concat();
    // No bend of the line is sharper than ten degrees.
    for three in points.windows(3) {
        let angle = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1).atan2(b.0 - a.0).to_degrees();
        let bend = angle(three[1], three[2]) - angle(three[0], three[1]);
        assert!(bend.abs() < 10.0, "{three:?}: {bend}");
    }
    assert!(points.len() > 10, "{}", points.len());
}

#[test]
fn parts_are_chosen_and_a_curve_file_has_no_rate_over_time() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    for (what, shown) in [
        ("spectrum", &["spectrum"][..]),
        ("rate,deviation", &["deviation", "rate"]),
    ] {
        let text = drawn(folder.path(), &["log.csv", "--what", what]);
        for class in ["deviation", "spectrum", "rate"] {
            let has = text.contains(&format!("class=\"{class}\""));
            assert_eq!(has, shown.contains(&class), "{what}: {class}");
        }
    }
    let arguments = ["plot", ADIS16405, "--what", "rate", "--output", "no.svg"];
    let refused = refusal(folder.path(), &arguments);
    assert!(
        refused.contains("nothing of what is to be drawn"),
        "{refused}"
    );
    assert!(!folder.path().join("no.svg").exists());
}
