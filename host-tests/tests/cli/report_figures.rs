//! The figures of a page of `report` agree with the diagnosis, and show where an error falls.

use crate::{
    browser::Browser,
    page::{embedded, opened, reported, simulate, steps},
};
use program::{ADIS16405, number};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// The positions of residuals in the figure of an axis' spectrum, from -1 to 1, and the labels of their axis.
const RESIDUALS: &str = "(() => {
    const figure = document.querySelector('#axis-2 .figure.spectrum');
    const [, frame] = [...figure.querySelectorAll('.frame')].map((one) => one.getBBox());
    const inset = 9, middle = frame.y + frame.height / 2, half = frame.height / 2 - inset;
    const dots = [...figure.querySelectorAll('.dot')].map((dot) => dot.cy.baseVal.value);
    const labels = [...figure.querySelectorAll('.up')].map((text) => [text.textContent, text.y.baseVal[0].value]);
    return [dots.filter((y) => y > frame.y).map((y) => (middle - y) / half), labels.filter(([, y]) => y > frame.y)];
})()";

#[test]
fn the_spectrum_is_drawn_on_one_scale_in_all_steps_and_agrees_with_the_diagnosis() {
    let folder = TempDir::new().unwrap();
    let diagnosis = reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    let axis = &diagnosis["axes"][2];
    let mut scales = Vec::new();
    let mut largest = Vec::new();
    for step in 0..steps(axis).len() {
        if step == 0 {
            browser.click("#axis-2-step-0");
        } else {
            browser.press("ArrowDown");
        }
        let model = browser.text("#axis-2 .model");
        assert_eq!(model.matches(" + ").count(), step, "{model}");
        let shown = browser.value(RESIDUALS);
        let dots: Vec<f64> = shown[0].as_array().unwrap().iter().map(number).collect();
        assert_eq!(dots.len(), axis["spectrum"].as_array().unwrap().len());
        assert!(dots.iter().all(|dot| dot.abs() <= 1.0), "{dots:?}");
        largest.push(dots.iter().fold(0.0, |most: f64, dot| most.max(dot.abs())));
        scales.push(shown[1].clone());
    }
    assert!(
        scales.windows(2).all(|pair| pair[0] == pair[1]),
        "{scales:?}"
    );
    // The error is seen to fall.
    assert!(
        largest.windows(2).all(|pair| pair[1] < pair[0]),
        "{largest:?}"
    );
    let top = |label: &Value| -> f64 { label[0].as_str().unwrap().parse().unwrap_or(0.0) };
    let labels = scales[0].as_array().unwrap();
    assert!(labels.len() >= 3, "{labels:?}");
    let end = labels.iter().map(top).fold(0.0, f64::max);
    let last = browser.value(RESIDUALS);
    let mut bins: Vec<&Value> = axis["spectrum"].as_array().unwrap().iter().collect();
    bins.sort_by(|one, other| {
        number(&one["frequency_hz"]).total_cmp(&number(&other["frequency_hz"]))
    });
    for (dot, bin) in last[0].as_array().unwrap().iter().zip(bins) {
        let expected = (number(&bin["z"]) / 3.0).asinh() / (end / 3.0).asinh();
        assert!((number(dot) - expected).abs() < 1e-3, "{dot}: {bin}");
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn a_line_that_the_allan_curve_hides_brings_the_spectrum_to_the_front() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &["sinusoid:frequency_hz=33,amplitude=0.05"]);
    reported(folder.path(), &["log.csv"]);
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let axis = &embedded(&page)["axes"][0];
    assert_eq!(axis["frames"][1]["quantity"], "spectrum");
    assert_eq!(axis["steps"][1]["front"], 1);
    let mut browser = opened(folder.path());
    browser.emulate("screen", "light");
    browser.resize(390, 844);
    browser.click("#axis-0 [aria-label='Next step']");
    let top = |browser: &mut Browser, figure: &str| {
        let top = format!("document.querySelector('{figure}').getBoundingClientRect().top");
        number(&browser.value(&top))
    };
    let [spectrum, deviation, rate] = ["spectrum", "deviation", "rate"]
        .map(|figure| top(&mut browser, &format!("#axis-0 .figure.{figure}")));
    assert!(spectrum < deviation && deviation < rate);
    // The rate and the noise over time have a dot for each of the blocks.
    let dots = browser.value("document.querySelectorAll('.figure.rate .dot').length");
    assert_eq!(dots, 128);
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
