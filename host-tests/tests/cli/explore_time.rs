//! The page of `explore`: what follows the temperature is taken out, the record is seen over time and cut there, and words explain
//! themselves.

use crate::{
    browser::Browser,
    whole_page::{choose, empty, explored, settle},
};
use program::{json, number, output};
use serde_json::{Value, json};
use std::{
    path::Path,
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

fn chi2(browser: &mut Browser) -> f64 {
    settle(browser);
    assert_eq!(browser.text("#problem"), "");
    number(&browser.value("answer.chi2"))
}

/// Writes the log of a gyro whose rate follows its temperature and has a line.
fn warm(folder: &Path) {
    let simulate = ["simulate", "mems", "--duration", "1200", "--seed", "7"];
    let effects = [
        "--effect",
        "sinusoid:frequency_hz=17,amplitude=0.05",
        "--effect",
        "thermal:slope=0.05,kelvin=5,period_s=300",
        "--output",
        "warm.csv",
    ];
    output(folder, &[&simulate[..], &effects].concat());
}

/// The box of an element: left, top, width and height.
fn middle([left, top, width, height]: [f64; 4]) -> [f64; 2] {
    [left + width / 2.0, top + height / 2.0]
}

#[test]
fn what_follows_the_temperature_is_taken_out_and_the_last_model_is_that_of_the_diagnosis() {
    let folder = TempDir::new().unwrap();
    warm(folder.path());
    let log = folder.path().join("warm.csv");
    let Some(url) = explored(folder.path(), &[log.to_str().unwrap()]) else {
        return;
    };
    let diagnosis = json(folder.path(), &["diagnose", "warm.csv"]);
    let steps = diagnosis["axes"][0]["steps"].as_array().unwrap();
    let last = number(&steps[steps.len() - 1]["chi2"]);
    let mut browser = Browser::start();
    browser.resize(1280, 900);
    browser.open(&url);
    let five = chi2(&mut browser);
    // The error of the five terms is that of the diagnosis: χ², and what follows the temperature.
    let error = number(&browser.value("answer.error"));
    assert!(
        (error / number(&steps[0]["error"]) - 1.0).abs() < 1e-6,
        "{error}"
    );
    assert!(browser.text("#error").contains("of what follows temp_C"));
    browser.click("#covariate");
    settle(&mut browser);
    let cool = number(&browser.value("answer.error"));
    assert!(cool < error, "{cool} {error}");
    assert_eq!(chi2(&mut browser), cool);
    let model = browser.text("#model");
    assert!(
        model.contains("temp") && model.ends_with("taken out"),
        "{model}"
    );
    assert!(
        browser
            .text("#command-line")
            .starts_with("allanite diagnose ")
    );
    browser.click("#undo");
    assert_eq!(chi2(&mut browser), five);
    // The model of the diagnosis has the line and the temperature, and its χ².
    browser.click("#adopt");
    let adopted = chi2(&mut browser);
    assert!((adopted / last - 1.0).abs() < 1e-6, "{adopted} {last}");
    assert_eq!(browser.value("state.takenOut"), true);
    // The address has both.
    let address = browser.value("location.href");
    let mut other = Browser::start();
    other.open(address.as_str().unwrap());
    assert!((chi2(&mut other) / adopted - 1.0).abs() < 1e-3);
    assert_eq!(other.value("byId('covariate').checked"), true);

    // The course and the spectrogram are over the same times, and the fine spectrum lies behind the bins.
    let strips = browser.value("document.querySelectorAll('#course .frame').length");
    assert!(number(&strips) >= 3.0, "{strips}");
    let lines = browser.value("document.querySelectorAll('#places .fine').length");
    assert_eq!(lines, 1);
    let said = browser.text("#spectrogram p");
    assert!(said.contains("a row 0.3906 Hz"), "{said}");
    // The brightest row is the line, as the picture shows it.
    let brightest = browser.value(
        "(() => { const { cells, rows, row_hz: wide } = data.records[0].spectrogram; \
         const level = (row) => { let sum = 0; for (let at = row; at < cells.length; at += rows) sum += LEVELS.indexOf(cells[at]); return sum; }; \
         const all = Array.from({ length: rows - 2 }, (_, row) => row + 2); \
         return wide * all.reduce((best, row) => (level(row) > level(best) ? row : best), 2); })()",
    );
    assert!((number(&brightest) - 17.0).abs() < 0.4, "{brightest}");
    assert_eq!(browser.nameless(), Vec::<String>::new());
    for browser in [browser, other] {
        assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
    }
}

#[test]
fn a_part_of_a_dropped_log_is_chosen_by_a_drag_and_left_out_or_kept_alone() {
    let folder = TempDir::new().unwrap();
    warm(folder.path());
    let Some(page) = empty(folder.path()) else {
        return;
    };
    let mut browser = Browser::start();
    browser.resize(1280, 900);
    browser.open(&format!("file://{}", page.display()));
    choose(&mut browser, &[&folder.path().join("warm.csv")]);
    let samples = |browser: &mut Browser| {
        let size = browser.value("data?.records[0].size ?? ''");
        size.as_str().unwrap().to_owned()
    };
    let wait = |browser: &mut Browser, wanted: &str| {
        let begin = Instant::now();
        while !samples(browser).starts_with(wanted) {
            assert!(
                begin.elapsed() < Duration::from_secs(60),
                "{}",
                samples(browser)
            );
            thread::sleep(Duration::from_millis(20));
        }
        chi2(browser)
    };
    wait(&mut browser, "120000 samples");
    // A drag over the middle of the course.
    let [left, top, width, height] = browser.sight("#course svg");
    let place = |share: f64| [left + width * share, top + height / 3.0];
    browser.drag(place(0.4), place(0.6));
    let chosen = browser.value("chosen");
    let [from, to] = [0, 1].map(|at| number(&chosen[at]));
    assert!(
        (350.0..550.0).contains(&from) && (600.0..800.0).contains(&to),
        "{chosen}"
    );
    assert_eq!(
        browser.value("document.querySelectorAll('.chosen').length"),
        1
    );
    browser.click("#cut-drop");
    let options = browser.value("byId('options').value");
    let options = options.as_str().unwrap();
    assert!(options.starts_with("--drop "), "{options}");
    let (_, range) = options.split_once(' ').unwrap();
    let cut = output(
        folder.path(),
        &["explore", "--session", "warm.csv", "--drop", range],
    );
    let cut: Value = serde_json::from_str(&cut).unwrap();
    let size = cut["page"]["records"][0]["size"]
        .as_str()
        .unwrap()
        .to_owned();
    assert!(!size.starts_with("120000 "), "{size}");
    wait(&mut browser, &size);
    // The fields choose as the drag does, and the whole log comes back.
    browser.click("#cut-none");
    wait(&mut browser, "120000 samples");
    browser.value("for (const [id, time] of [['cut-from', 100], ['cut-to', 700]]) { byId(id).value = time; byId(id).dispatchEvent(new Event('input')); }");
    browser.click("#cut-keep");
    wait(&mut browser, "6000");
    assert_eq!(
        browser.value("byId('options').value"),
        "--from 100s --to 700s"
    );
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn a_page_without_the_log_says_the_command_that_cuts_it() {
    let folder = TempDir::new().unwrap();
    warm(folder.path());
    let log = folder.path().join("warm.csv");
    let Some(url) = explored(folder.path(), &[log.to_str().unwrap()]) else {
        return;
    };
    let mut browser = Browser::start();
    browser.resize(390, 844);
    browser.open(&url);
    chi2(&mut browser);
    browser.value("choose([100, 200], true)");
    browser.click("#cut-drop");
    let said = browser.text("#cut-said");
    assert!(said.ends_with("warm.csv --drop 100s..200s"), "{said}");
    let wide = browser.value("document.documentElement.scrollWidth");
    assert!(number(&wide) <= 390.0, "{wide}");
    assert_eq!(browser.small_targets(), json!([]));

    // A word explains itself by the mouse, by the focus and by a finger.
    let word = "#error .gloss";
    let hidden = "byId('meaning').hidden";
    assert_eq!(browser.value(hidden), true);
    let place = middle(browser.sight(word));
    browser.mouse("mouseMoved", place);
    assert_eq!(browser.value(hidden), false);
    let meaning = browser.text("#meaning");
    assert!(
        meaning.starts_with("χ² – The sum of squared differences"),
        "{meaning}"
    );
    browser.mouse("mouseMoved", [5.0, 5.0]);
    assert_eq!(browser.value(hidden), true);
    browser.value(&format!("document.querySelector('{word}').focus()"));
    assert_eq!(browser.value(hidden), false);
    browser.press("Escape");
    assert_eq!(browser.value(hidden), true);
    // A machine that is busy may still scroll when the finger comes, so that it taps again, as a reader does.
    let begin = Instant::now();
    while browser.value(hidden) != false {
        assert!(begin.elapsed() < Duration::from_secs(30), "not explained");
        let place = middle(browser.sight(word));
        browser.touch(&[&[place]]);
        thread::sleep(Duration::from_millis(200));
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
