//! A page of `report` shows its finding on the first screen, fits on paper, and can be used by everybody.

use crate::page::{embedded, opened, reported, simulate};
use program::{ADIS16405, number};
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

#[test]
fn the_first_screen_has_the_finding_in_words_beside_its_place_in_a_picture() {
    let folder = TempDir::new().unwrap();
    reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    for (width, height) in [(1280, 800), (390, 844)] {
        browser.resize(width, height);
        let seen = browser.value(
            "(() => { const box = (name) => document.querySelector(`.summary li ${name}`).getBoundingClientRect(); \
             return ['.picture .figure', '.picture .worst', '.picture .worst-label', 'p'].map(box) \
             .map((one) => [one.left, one.right, one.top, one.bottom, one.width]); })()",
        );
        for one in seen.as_array().unwrap() {
            let [left, right, top, bottom, wide] = [0, 1, 2, 3, 4].map(|at| number(&one[at]));
            assert!(wide > 0.0 && left >= 0.0 && top >= 0.0, "{seen}");
            assert!(
                right <= f64::from(width) && bottom <= f64::from(height),
                "{width}: {seen}"
            );
        }
        let label = browser
            .value("document.querySelector('.summary li .picture .worst-label').textContent");
        assert!(label.as_str().unwrap().contains("std. errors"), "{label}");
    }
    // The name of an axis leads to it, with the focus on its step.
    browser.click(".summary li:nth-child(3) a");
    assert_eq!(browser.value("document.activeElement.id"), "axis-2-step-0");
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn an_axis_takes_at_most_two_pages_of_paper_with_its_first_and_last_model_beside_each_other() {
    let folder = TempDir::new().unwrap();
    let effects = [
        "resonance:frequency_hz=18,quality=20,rms=0.05",
        "resonance:frequency_hz=31,quality=25,rms=0.05",
    ];
    simulate(folder.path(), &effects);
    for (input, axes) in [(ADIS16405, 3), ("log.csv", 1)] {
        reported(folder.path(), &[input]);
        let mut browser = opened(folder.path());
        for paper in [[8.27, 11.69], [8.5, 11.0]] {
            let size = json!({ "paperWidth": paper[0], "paperHeight": paper[1] });
            let pdf = browser.call("Page.printToPDF", size);
            let pages = pages(pdf["data"].as_str().unwrap());
            assert!(
                pages >= axes && pages <= 2 * axes,
                "{pages} pages of {axes} axes"
            );
        }
        browser.emulate("print", "light");
        browser.resize(700, 1000);
        let pair = browser.value(
            "[...document.querySelectorAll('#axis-0 .pair > *')].map((one) => { \
             const box = one.getBoundingClientRect(); return [box.left, box.top, one.querySelectorAll('.figure').length]; })",
        );
        let [first, last] = [&pair[0], &pair[1]];
        assert!(number(&last[0]) > number(&first[0]) + 200.0, "{pair}");
        assert_eq!(first[1], last[1]);
        assert_eq!((&first[2], &last[2]), (&json!(2), &json!(2)));
        assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
    }
}

/// The number of pages of a PDF in base 64.
fn pages(data: &str) -> usize {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digit = |byte: u8| DIGITS.iter().position(|other| *other == byte).unwrap_or(0) as u32;
    let bytes: Vec<u8> = data
        .as_bytes()
        .chunks(4)
        .flat_map(|four| {
            let all = four.iter().fold(0, |all, byte| (all << 6) | digit(*byte));
            let [_, bytes @ ..] = all.to_be_bytes();
            bytes
        })
        .collect();
    let text = String::from_utf8_lossy(&bytes);
    let pages = text
        .match_indices("/Type /Page")
        .filter(|(at, found)| !text[at + found.len()..].starts_with('s'));
    pages.count()
}

#[test]
fn two_resonances_have_lines_of_two_colours_and_bars_of_chi_squared_count_decades() {
    let folder = TempDir::new().unwrap();
    let effects = [
        "resonance:frequency_hz=18,quality=20,rms=0.05",
        "resonance:frequency_hz=31,quality=25,rms=0.05",
    ];
    simulate(folder.path(), &effects);
    let diagnosis = reported(folder.path(), &["log.csv"]);
    let text = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let steps = diagnosis["axes"][0]["steps"].as_array().unwrap();
    let shares =
        embedded(&text)["axes"][0]["steps"][steps.len() - 1]["figures"][1]["shares"].clone();
    let resonances = shares.as_array().unwrap().iter();
    let resonances: Vec<&Value> = resonances
        .filter(|share| share["effect"] == "resonance")
        .collect();
    assert_eq!(resonances.len(), 2, "{shares}");
    let mut browser = opened(folder.path());
    browser.click(&format!("#axis-0-step-{}", steps.len() - 1));
    let colours = browser.value(
        "[...document.querySelectorAll('#axis-0 .legend li')].filter((one) => one.textContent.startsWith('resonance')) \
         .map((one) => [one.textContent, getComputedStyle(one.querySelector('line')).stroke])",
    );
    assert_eq!(colours.as_array().unwrap().len(), 2, "{colours}");
    assert_ne!(colours[0][1], colours[1][1]);
    for (at, resonance) in resonances.iter().enumerate() {
        let frequency_hz = number(&resonance["frequency_hz"]);
        let words = colours[at][0].as_str().unwrap();
        let shown: f64 = words.split(' ').nth(2).unwrap().parse().unwrap();
        assert!((shown / frequency_hz - 1.0).abs() < 1e-3, "{words}");
    }
    // The drawings of `plot` have them too.
    let drawing = crate::drawing::drawn(folder.path(), &["log.csv"]);
    let drawing = roxmltree::Document::parse(&drawing).unwrap();
    let strokes: Vec<&str> = drawing
        .descendants()
        .filter_map(|node| node.attribute("stroke"))
        .collect();
    assert!(strokes.contains(&"#005f73"), "the colour of a second line");

    // A factor of 1000 is three decades long, and the axis of the bars says how long a decade is.
    let bars = browser.value(
        "(() => { const scale = logarithmicBars([{ chi2: 100000, dof: 20 }, { chi2: 100, dof: 20 }]); \
         const width = (chi2) => parseFloat(scale.bar(chi2, 20).querySelector('.fill').getAttribute('width')); \
         const labels = [...scale.axis().querySelectorAll('text')].map((one) => one.textContent); \
         return [width(100000), width(100), labels.join(' '), fallInWords(100000, 100)]; })()",
    );
    assert_eq!(bars, json!([100, 40, "1 10 100 1000 10⁴ 10⁵", "÷ 1 000"]));
    let fell = browser.text("#axis-0-step-1 .fell");
    let factor: f64 = fell.replace(['÷', ' '], "").parse().unwrap();
    let expected = number(&steps[0]["chi2"]) / number(&steps[1]["chi2"]);
    assert!((factor / expected - 1.0).abs() < 0.01, "{fell} {expected}");
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn every_control_has_a_name_is_large_enough_and_is_reached_by_the_tab_key() {
    let folder = TempDir::new().unwrap();
    reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    assert_eq!(browser.nameless(), Vec::<String>::new());
    for (width, scheme) in [(390, "light"), (1280, "dark")] {
        browser.emulate("screen", scheme);
        browser.resize(width, 844);
        assert_eq!(browser.small_targets(), json!([]), "{width}");
    }
    // The tables are reached too, once they are open.
    browser.value("document.querySelectorAll('.points').forEach((one) => { one.open = true; })");
    let stages = browser.value("document.querySelectorAll('.stage').length");
    let mut reached = std::collections::BTreeSet::new();
    browser.value("document.activeElement.blur()");
    for _ in 0..400 {
        browser.press("Tab");
        let focused = browser.value(
            "(() => { const one = document.activeElement; if (one === document.body) return null; \
             const { outlineStyle, outlineWidth } = getComputedStyle(one); \
             return [[...document.querySelectorAll('*')].indexOf(one), one.className, outlineStyle, parseFloat(outlineWidth)]; })()",
        );
        if focused.is_null() {
            break;
        }
        // The focus is visible everywhere.
        assert!(
            focused[2] == "solid" && number(&focused[3]) >= 2.0,
            "{focused}"
        );
        if !reached.insert(focused[0].as_u64().unwrap()) {
            break;
        }
    }
    let wanted = browser.value(
        "(() => { const all = [...document.querySelectorAll('*')]; \
         return all.filter((one) => one.matches('a, button:not(:disabled), summary, [tabindex=\"0\"]') && one.tabIndex >= 0 \
         && one.checkVisibility()).map((one) => all.indexOf(one)); })()",
    );
    let wanted: Vec<u64> = wanted
        .as_array()
        .unwrap()
        .iter()
        .map(|at| at.as_u64().unwrap())
        .collect();
    assert!(
        wanted.len() > 40 && stages == 6,
        "{} {stages}",
        wanted.len()
    );
    let missed: Vec<&u64> = wanted.iter().filter(|at| !reached.contains(at)).collect();
    assert!(missed.is_empty(), "{missed:?}");
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
