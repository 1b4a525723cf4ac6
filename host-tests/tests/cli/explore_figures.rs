//! The figures of `explore`: a peak becomes a line, χ² falls in stairs, and many records are at hand on any screen.

use crate::{
    browser::Browser,
    whole_page::{self, explored},
};
use program::{ADIS16405, number, output};
use serde_json::json;
use std::{
    path::Path,
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

const SPECTRUM: &str = "#places .place:nth-child(2)";

/// Waits until the page shows the answer to its last question, which it was not refused.
fn settle(browser: &mut Browser) {
    whole_page::settle(browser);
    assert_eq!(browser.text("#problem"), "");
}

fn chi2(browser: &mut Browser) -> f64 {
    settle(browser);
    number(&browser.value("answer.chi2"))
}

/// The place of the window over the highest residual of the spectrum, and its frequency.
fn peak(browser: &mut Browser) -> ([f64; 2], f64) {
    let [left, top, width, _] = browser.sight(&format!("{SPECTRUM} .stage"));
    let found = browser.value(
        "(() => { const { drawn, scene } = figures.get('spectrum').plot; const [record] = scene.records; \
         const at = record.z.indexOf(Math.max(...record.z)); const x = record.points.x[at]; \
         return [drawn.sheet.x(drawn.across.at(x)) / drawn.sheet.width, x]; })()",
    );
    (
        [left + width * number(&found[0]) + 4.0, top + 100.0],
        number(&found[1]),
    )
}

/// Writes records of gyros with a line, one of them with a strong one.
fn records(folder: &Path, count: usize) -> Vec<String> {
    let files = (0..count).map(|at| {
        let seed = (at + 1).to_string();
        let name = format!("unit-{at:02}.csv");
        let simulate = ["simulate", "mems", "--duration", "20.48", "--seed", &seed];
        output(folder, &[&simulate[..], &["--output", &name]].concat());
        folder.join(name).to_str().unwrap().to_owned()
    });
    files.collect()
}

#[test]
fn a_peak_becomes_a_line_by_mouse_keys_and_finger_and_the_history_falls() {
    let folder = TempDir::new().unwrap();
    let Some(url) = explored(folder.path(), &[ADIS16405]) else {
        return;
    };
    let mut browser = Browser::start();
    browser.resize(1280, 900);
    browser.open(&url);
    settle(&mut browser);
    browser.value("change(null, (of) => { of.record = 2; })");
    let five = chi2(&mut browser);
    // The worst point has its ring in both panels.
    let rings = browser.value(&format!(
        "document.querySelectorAll('{SPECTRUM} .worst').length"
    ));
    assert_eq!(rings, 2);
    let (place, frequency_hz) = peak(&mut browser);
    browser.mouse("mouseMoved", place);
    browser.mouse("mousePressed", place);
    browser.mouse("mouseReleased", place);
    let line = chi2(&mut browser);
    assert!(line < 0.3 * five, "{line} {five}");
    let fitted =
        browser.value("[state.added[0].effect, state.added[0].values[0], state.added[0].fitted]");
    assert_eq!((&fitted[0], &fitted[2]), (&json!("sinusoid"), &json!(true)));
    assert!(
        (number(&fitted[1]) / frequency_hz - 1.0).abs() < 0.1,
        "{fitted} {frequency_hz}"
    );
    // The stairs have one step more, which is lower.
    let stairs = "document.querySelector('#history .stair').getAttribute('d')";
    let path = browser.value(stairs);
    let heights: Vec<f64> = path
        .as_str()
        .unwrap()
        .split(['M', 'L'])
        .filter(|part| !part.is_empty())
        .map(|part| part.split([' ', 'H']).nth(1).unwrap().parse().unwrap())
        .collect();
    assert!(heights.len() >= 2 && heights.is_sorted(), "{path}");
    assert!(
        heights[heights.len() - 1] > heights[heights.len() - 2] + 5.0,
        "{path}"
    );
    let label = browser.value("document.querySelector('#history svg').getAttribute('aria-label')");
    assert!(
        label.as_str().unwrap().contains(&format!("{line:.1}")),
        "{label}"
    );

    // The Enter key adds a line at the cursor.
    browser.click("#undo");
    assert_eq!(chi2(&mut browser), five);
    browser.value(&format!(
        "document.querySelector('{SPECTRUM} .stage').focus()"
    ));
    browser.press("Enter");
    assert!((chi2(&mut browser) / line - 1.0).abs() < 0.5);
    browser.click("#undo");
    settle(&mut browser);
    // A drag moves what is seen and adds nothing.
    let (place, _) = peak(&mut browser);
    browser.wheel(place, -300.0);
    browser.drag(place, [place[0] - 40.0, place[1]]);
    settle(&mut browser);
    assert_eq!(browser.value("state.added.length"), 0);
    // A finger sets the cursor, and the button below the figure adds the line.
    let (place, _) = peak(&mut browser);
    browser.touch(&[&[[place[0] - 4.0, place[1]]]]);
    settle(&mut browser);
    assert_eq!(browser.value("state.added.length"), 0);
    let words = browser.text(&format!("{SPECTRUM} .pick"));
    assert!(words.starts_with("Add a line at "), "{words}");
    let [x, y, width, height] = browser.sight(&format!("{SPECTRUM} .pick"));
    browser.touch(&[&[[x + width / 2.0, y + height / 2.0]]]);
    let begin = Instant::now();
    while browser.value("state.added.length") != 1 {
        assert!(begin.elapsed() < Duration::from_secs(10), "no line");
        thread::sleep(Duration::from_millis(10));
    }
    assert!(chi2(&mut browser) < 0.5 * five);
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn sixty_records_are_found_judged_and_seen_on_a_desk_and_on_a_phone() {
    let folder = TempDir::new().unwrap();
    let paths = records(folder.path(), 60);
    let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
    let Some(url) = explored(folder.path(), &paths) else {
        return;
    };
    let mut browser = Browser::start();
    browser.resize(1280, 900);
    browser.open(&url);
    settle(&mut browser);
    browser.click("#find-record");
    browser.call("Input.insertText", json!({ "text": "unit-4" }));
    assert_eq!(
        browser.value("document.querySelectorAll('#records tbody tr').length"),
        10
    );
    assert_eq!(browser.value("document.activeElement.id"), "find-record");
    browser.click("#judge-all");
    settle(&mut browser);
    assert_eq!(browser.value("answer.judged.length"), 10);
    browser.value("wanted = ''; showRecords()");
    browser.click("#judge-all");
    settle(&mut browser);
    assert_eq!(browser.value("answer.judged.length"), 59);
    assert_eq!(browser.nameless(), Vec::<String>::new());
    for (width, scheme) in [(390, "light"), (390, "dark"), (1280, "dark")] {
        browser.emulate("screen", scheme);
        browser.resize(width, 844);
        let wide = browser.value("document.documentElement.scrollWidth");
        assert!(
            number(&wide) <= f64::from(width),
            "{wide} pixels of {width}"
        );
        assert_eq!(browser.small_targets(), json!([]), "{width}");
        // The picture begins on the first screen, and the records are not longer than a screen.
        browser.value("scrollTo(0, 0)");
        let seen = browser.value(
            "[document.querySelector('#places .figure').getBoundingClientRect().top, document.querySelector('#records').offsetHeight]",
        );
        assert!(
            number(&seen[0]) < 600.0 && number(&seen[1]) < 844.0,
            "{width}: {seen}"
        );
    }
    browser.resize(1280, 900);
    browser.click("#judge-none");
    settle(&mut browser);
    assert_eq!(browser.value("answer.judged.length"), 0);
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
