//! What a drawing of `plot` has where.

use program::output;
use roxmltree::{Document, Node};
use std::{fs, path::Path};

pub(crate) fn coordinate(node: &Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// Draws an input and returns the text of the drawing.
pub(crate) fn drawn(folder: &Path, arguments: &[&str]) -> String {
    let plot = [&["plot"], arguments, &["--output", "drawing.svg"]].concat();
    assert!(output(folder, &plot).contains("wrote drawing.svg: "));
    fs::read_to_string(folder.join("drawing.svg")).unwrap()
}

/// Writes the log of a consumer gyro, 2^16 samples at 100 Hz, with hidden effects.
pub(crate) fn simulate(folder: &Path, effects: &[&str]) {
    let simulate = ["simulate", "mems", "--duration", "655.36", "--seed", "5"];
    let effects = effects.iter().flat_map(|effect| ["--effect", *effect]);
    let effects: Vec<&str> = effects.collect();
    output(
        folder,
        &[&simulate[..], &effects, &["--output", "log.csv"]].concat(),
    );
}

/// The part of a drawing with this class.
pub(crate) fn part<'a>(drawing: &'a Document<'a>, class: &str) -> Node<'a, 'a> {
    let mut groups = drawing.descendants();
    let found = groups.find(|node| node.attribute("class") == Some(class));
    found.unwrap_or_else(|| panic!("{class}"))
}

/// The elements of a part with a tag and, if it is not empty, a class.
pub(crate) fn elements<'a>(part: Node<'a, 'a>, tag: &str, class: &str) -> Vec<Node<'a, 'a>> {
    let elements = part.descendants().filter(|node| node.has_tag_name(tag));
    let elements =
        elements.filter(|node| class.is_empty() || node.attribute("class") == Some(class));
    elements.collect()
}

/// The frames of a part's panels, from the top: left, top, right and bottom.
pub(crate) fn frames(part: Node) -> Vec<[f64; 4]> {
    let frames = elements(part, "rect", "").into_iter();
    let frames = frames.filter(|rect| rect.attribute("fill") == Some("none"));
    let [x, y, wide, high] = ["x", "y", "width", "height"];
    frames
        .map(|rect| {
            let [x, y, wide, high] = [x, y, wide, high].map(|name| coordinate(&rect, name));
            [x, y, x + wide, y + high]
        })
        .collect()
}

/// The centres of the dots that lie in a frame.
pub(crate) fn dots(part: Node, frame: [f64; 4]) -> Vec<(f64, f64)> {
    let circles = elements(part, "circle", "").into_iter();
    let circles = circles.filter(|circle| circle.attribute("r") == Some("3.5"));
    let centres = circles.map(|circle| (coordinate(&circle, "cx"), coordinate(&circle, "cy")));
    let inside = |&(x, y): &(f64, f64)| {
        (frame[0]..=frame[2]).contains(&x) && (frame[1]..=frame[3]).contains(&y)
    };
    centres.filter(inside).collect()
}

/// The labels left of a frame, with their heights.
pub(crate) fn labels(part: Node, frame: [f64; 4]) -> Vec<(String, f64)> {
    let words = elements(part, "text", "").into_iter();
    let left = words.filter(|text| text.attribute("text-anchor") == Some("end"));
    let left = left.filter(|text| (frame[1]..=frame[3] + 4.0).contains(&coordinate(text, "y")));
    left.map(|text| {
        let words = text.text().unwrap().trim().replace('−', "-");
        (words, coordinate(&text, "y") - 4.0)
    })
    .collect()
}

/// The labels below a part's last frame.
pub(crate) fn labels_below(part: Node) -> usize {
    let bottom = frames(part).last().unwrap()[3];
    let words = elements(part, "text", "").into_iter();
    let below = words.filter(|text| (coordinate(text, "y") - bottom - 19.0).abs() < 0.1);
    below.count()
}
