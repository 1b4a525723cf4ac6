//! Bad curve files.

use super::case::{Case, refused};
use host_tests::program::ADIS16405;
use serde_json::{Value, json};
use std::fs;

pub(crate) fn cases() -> Vec<Case> {
    let text = fs::read_to_string(ADIS16405).unwrap();
    let good: Value = serde_json::from_str(&text).unwrap();
    let with = |pointer: &str, value: Value| {
        let mut changed = good.clone();
        *changed.pointer_mut(pointer).unwrap() = value;
        changed.to_string()
    };
    let axes = |count: usize| {
        let mut changed = good.clone();
        let first = good["axes"][0].clone();
        let one = |i| {
            let mut axis = first.clone();
            axis["axis"] = json!(format!("g{i}"));
            axis
        };
        changed["axes"] = (0..count).map(one).collect();
        changed.to_string()
    };
    let follows = "does not follow from the sum";
    let texts: Vec<(String, &str)> = vec![
        (String::new(), "not a curve file"),
        ("{}".into(), "missing field `format`"),
        ("[".repeat(100_000), "not a curve file"),
        ("[1, 2]".into(), "not a curve file"),
        (text[..text.len() / 2].into(), "not a curve file: EOF"),
        (format!("{text}{text}"), "trailing characters"),
        (text.replacen("100.0", "NaN", 1), "not a curve file"),
        (text.replacen("100.0", "1e999", 1), "number out of range"),
        (with("/format", json!("other")), "the format is \"other\""),
        (with("/format", json!("\u{1b}[2J")), "the format is"),
        (with("/version", json!(99)), "the format has version 99"),
        (with("/axes", json!([])), "the file has no axes"),
        (with("/axes/0/axis", json!("")), "axis 1 has no name"),
        (
            with("/axes/0/axis", json!("x".repeat(5000))),
            "axis 1: the name",
        ),
        (
            with("/axes/1/axis", good["axes"][0]["axis"].clone()),
            "two axes are named",
        ),
        (
            with("/axes/0/rate_hz", json!(0.0)),
            "rate_hz 0 is impossible",
        ),
        (
            with("/axes/0/rate_hz", json!(-1.0)),
            "rate_hz -1 is impossible",
        ),
        (
            with("/axes/0/rate_hz", json!(1e300)),
            "rate_hz 1.000e300 is impossible",
        ),
        (with("/axes/0/rate_hz", json!(50.0)), "is not m / rate_hz"),
        (with("/axes/0/rate_per_count", json!(1e300)), follows),
        (with("/axes/0/rate_per_count", json!(1e-300)), follows),
        (
            with("/axes/0/rate_per_count", json!(0.0)),
            "rate_per_count 0 is impossible",
        ),
        (with("/axes/0/unit", json!("furlong/s")), "unknown variant"),
        (
            with("/axes/0/samples", json!(u64::MAX)),
            "samples are impossible",
        ),
        (with("/axes/0/samples", json!(7)), "samples are impossible"),
        (
            with("/axes/0/gaps", json!(u64::MAX)),
            "samples are impossible",
        ),
        (
            with("/axes/0/octaves", json!([])),
            "a fit needs two octaves",
        ),
        (
            with("/axes/0/octaves/1/m", json!(3)),
            "is not a power of two",
        ),
        (
            with("/axes/0/octaves/1/m", json!(0)),
            "averaging factors must ascend",
        ),
        (
            with("/axes/0/octaves/1/differences", json!(5)),
            "are impossible",
        ),
        (with("/axes/0/octaves/1/sum", json!(0)), follows),
        (with("/axes/0/octaves/1/variance", json!(-1.0)), follows),
        (with("/axes/0/octaves/1/variance", json!(1e308)), follows),
        (
            with("/axes/0/octaves/1/tau_s", json!(1e308)),
            "is not m / rate_hz",
        ),
        (axes(65), "the file has 65 axes, more than 64"),
        (axes(400), "the file has 400 axes, more than 64"),
    ];
    let case = |(text, expected): (String, &str)| refused("a.json", text, "fit a.json", expected);
    let mut cases: Vec<Case> = texts.into_iter().map(case).collect();
    let many = "draw one axis with --axis, or an .svg";
    let named = with("/axes/0/axis", json!("a\u{1b}[31mb"));
    cases.extend([
        refused("a.json", named, "fit a.json", "").status(0),
        refused("a.json", axes(400), "plot a.json -o a.png", "more than 64"),
        refused("a.json", axes(8), "plot a.json -o a.png", many),
        refused(
            "a.json",
            text.as_str(),
            "plot a.json -o a.gif",
            "must end in .svg or .png",
        ),
        refused(
            "a.json",
            text.as_str(),
            "plot a.json --axis q -o a.svg",
            "there is no axis \"q\"",
        ),
        refused(
            "a.json",
            text.as_str(),
            "export -f c a.json -o a.json",
            "the output is also the input",
        ),
        refused(
            "a.json",
            text.as_str(),
            "fit a.json --rate 5",
            "contains its rate",
        ),
        refused(
            "a.json",
            text.as_str(),
            "diagnose a.json --covariates t",
            "has no covariates",
        ),
    ]);
    cases
}
