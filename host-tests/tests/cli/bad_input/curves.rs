//! Bad curve files: one of each kind, and those that are hostile. `curve_file.rs` tests every message.

use super::case::{Case, refused};
use program::ADIS16405;
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
    let texts: Vec<(String, &str)> = table! {
        "[".repeat(100_000) => "not a curve file";
        text[..text.len() / 2].into() => "not a curve file: EOF";
        with("/format", json!("\u{1b}[2J")) => "the format is";
        with("/version", json!(99)) => "a.json: the format has version 99, but this program reads versions 1 to 6; ";
        with("/axes/0/rate_hz", json!(1e300)) => "rate_hz 1.000e300 is impossible";
        with("/axes/0/rate_per_count", json!(1e-300)) => follows;
        with("/axes/0/unit", json!("furlong/s")) => "unknown variant";
        with("/axes/0/samples", json!(u64::MAX)) => "samples are impossible";
        with("/axes/0/octaves/1/sum", json!(0)) => follows;
        with("/axes/0/octaves/1/variance", json!(1e308)) => follows;
        with("/axes/0/octaves/1/tau_s", json!(1e308)) => "is not m / rate_hz";
        axes(65) => "the file has 65 axes, more than 64";
        axes(400) => "the file has 400 axes, more than 64";
    };
    let case = |(text, expected): (String, &str)| refused("a.json", text, "fit a.json", expected);
    let mut cases: Vec<Case> = texts.into_iter().map(case).collect();
    cases.extend(spectra(&good));
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
            "a.json: a curve file contains its rate",
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

/// Files of version 2 with hostile spectra.
fn spectra(good: &Value) -> Vec<Case> {
    let with = |place: &str, value: Value| {
        let mut changed = good.clone();
        let pointer = format!("/axes/0/spectrum/{place}");
        *changed.pointer_mut(&pointer).unwrap() = value;
        changed
    };
    // Numbers that JSON does not have.
    let written = |place: &str, number: &str| {
        let text = with(place, json!("here")).to_string();
        text.replacen("\"here\"", number, 1)
    };
    let levels = |change: &dyn Fn(&mut Vec<Value>)| {
        let mut changed = good["axes"][0]["spectrum"]["levels"].clone();
        change(changed.as_array_mut().unwrap());
        with("levels", changed).to_string()
    };
    let numbers = |count: usize| json!(vec![0.5; count]);
    let of_bins = "spectrum, block 1: the number of bins is impossible";
    let blocks = "the blocks of the levels are not 1, 8, 64";
    let few = "spectrum, block 1: there are too few segments";
    let mut short = good.clone();
    let octaves = short["axes"][0]["octaves"].as_array_mut().unwrap();
    octaves.truncate(3);
    let no_number = "not a curve file";
    let texts = table! {
        with("levels/0/density", numbers(27)).to_string() => of_bins;
        with("levels/0/density", numbers(1_000_000)).to_string() => of_bins;
        with("levels/0/kurtosis", numbers(0)).to_string() => of_bins;
        with("levels/0/kurtosis", numbers(29)).to_string() => of_bins;
        with("levels/0/density/3", json!(-1.0)).to_string() => "spectrum: ";
        with("levels/0/density/3", json!(null)).to_string() => no_number;
        written("levels/0/density/3", "NaN") => no_number;
        written("levels/0/density/3", "Infinity") => no_number;
        written("levels/0/density/3", "1e999") => "number out of range";
        with("levels/0/density/3", json!(1e300)).to_string() => "the densities contradict the octaves";
        with("levels/0/kurtosis/3", json!(-0.5)).to_string() => "spectrum: ";
        written("levels/0/kurtosis/3", "NaN") => no_number;
        with("levels/0/kurtosis/3", json!(1e9)).to_string() => "a spectral kurtosis is impossible";
        with("levels/0/segments", json!(0)).to_string() => few;
        with("levels/0/segments", json!(-1)).to_string() => no_number;
        with("levels/0/segments", json!(u64::MAX)).to_string() => no_number;
        with("levels/0/segments", json!(u32::MAX)).to_string() => "more segments than samples";
        with("levels/0/block", json!(0)).to_string() => blocks;
        with("levels/1/block", json!(3)).to_string() => blocks;
        with("levels/1/block", json!(64)).to_string() => blocks;
        levels(&|all| all.swap(0, 1)) => blocks;
        levels(&|all| drop(all.remove(0))) => blocks;
        levels(&|all| all.extend(vec![all[3].clone(); 1000])) => blocks;
        with("segment", json!(0)).to_string() => of_bins;
        with("segment", json!(63)).to_string() => "spectrum";
        with("segment", json!(128)).to_string() => of_bins;
        with("segment", json!(u32::MAX)).to_string() => of_bins;
        short.to_string() => "spectrum, block 8: there is no octave of this length";
    };
    let case =
        |(text, expected): (String, &str)| refused("a.json", text, "diagnose a.json", expected);
    let mut cases: Vec<Case> = texts.into_iter().map(case).collect();
    let zero = with("levels/0/density", json!(vec![0.0; 28])).to_string();
    cases.extend([
        refused("a.json", levels(&Vec::clear), "fit a.json", "").status(0),
        refused("a.json", zero, "diagnose a.json", "").ambiguous(),
    ]);
    cases
}
