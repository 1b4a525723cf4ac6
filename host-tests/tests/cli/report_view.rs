//! The figures of a page of `report` answer: by mouse, fingers and keys they tell values, zoom and move, and the address
//! and a table keep what is seen.

use crate::{
    browser::Browser,
    page::{embedded, opened, reported},
};
use program::{ADIS16405, number};
use serde_json::Value;
use std::{
    fs, thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// The spectrum of the third axis, which has a line and a resonance.
const SPECTRUM: &str = "#axis-2 .place:nth-child(2)";

/// A page of `report` in a browser, and the data in it.
fn page(arguments: &[&str]) -> (TempDir, Browser, Value) {
    let folder = TempDir::new().unwrap();
    reported(folder.path(), arguments);
    let text = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let mut browser = opened(folder.path());
    browser.resize(1280, 900);
    (folder, browser, embedded(&text))
}

/// A part of what the cursor tells.
fn told(browser: &mut Browser, part: &str) -> String {
    browser.text(&format!("{SPECTRUM} .readout [data-part={part}] strong"))
}

/// The ends of the part of the spectrum that is seen, in Hz; `None` if it is all.
fn seen(browser: &mut Browser) -> Option<[f64; 2]> {
    let ends = browser.value("walks[2].views.spectrum.x");
    (!ends.is_null()).then(|| [number(&ends[0]), number(&ends[1])])
}

/// The first number of a text, with either minus.
fn first_number(text: &str) -> f64 {
    let word = text.split(' ').next().unwrap().replace('−', "-");
    word.parse().unwrap_or_else(|_| panic!("{text}"))
}

/// The place of the window over a frequency in the spectrum, in the middle of the curve's panel.
fn over(browser: &mut Browser, frequency_hz: f64) -> [f64; 2] {
    let [left, top, width, _] = browser.sight(&format!("{SPECTRUM} .stage"));
    let share = browser.value(&format!(
        "(() => {{ const {{ drawn }} = walks[2].plots[1]; return drawn.sheet.x(drawn.across.at({frequency_hz})) / drawn.sheet.width; }})()"
    ));
    [left + width * number(&share), top + 120.0]
}

/// The address of the page, once it rests.
fn address(browser: &mut Browser, part: &str) -> String {
    let begin = Instant::now();
    loop {
        let address = browser.value("location.href");
        let address = address.as_str().unwrap();
        if address.contains(part) {
            return address.to_owned();
        }
        assert!(
            begin.elapsed() < Duration::from_secs(10),
            "{part}: {address}"
        );
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn the_cursor_tells_the_same_values_by_mouse_by_finger_and_by_keys() {
    let (_folder, mut browser, data) = page(&[ADIS16405]);
    let frame = &data["axes"][2]["frames"][1];
    let figure = &data["axes"][2]["steps"][0]["figures"][1];
    let frequencies = frame["measured"]["x"].as_array().unwrap();
    let check = |browser: &mut Browser, at: usize| {
        let close = |part: &str, value: &Value, tolerance: f64| {
            let shown = first_number(part);
            let value = number(value);
            assert!(
                (shown - value).abs() <= tolerance * value.abs().max(0.05),
                "{part}: {value}"
            );
        };
        close(&told(browser, "across"), &frequencies[at], 6e-4);
        close(
            &told(browser, "measured"),
            &frame["measured"]["measured"][at],
            6e-4,
        );
        let bar = told(browser, "bar");
        let (lower, upper) = bar.split_once(" … ").unwrap();
        close(lower, &frame["measured"]["lower"][at], 6e-4);
        close(upper, &frame["measured"]["upper"][at], 6e-4);
        close(&told(browser, "model"), &figure["expected"][at], 6e-4);
        let z = first_number(&told(browser, "residual"));
        assert!((z - number(&figure["z"][at])).abs() <= 0.051, "{z}");
        // A screen reader is told the same.
        let spoken = browser.value(&format!(
            "document.querySelector('{SPECTRUM} .stage').getAttribute('aria-valuetext')"
        ));
        let residual = told(browser, "residual");
        assert!(spoken.as_str().unwrap().contains(&residual), "{spoken}");
    };
    let last = frequencies.len() - 1;
    let frequency = |at: usize| number(&frequencies[at]);
    // Far apart, so that half a pixel does not decide.
    let [mouse, finger] = [last - 3, 3];
    let place = over(&mut browser, frequency(mouse));
    browser.mouse("mouseMoved", place);
    check(&mut browser, mouse);
    let place = over(&mut browser, frequency(finger));
    browser.touch(&[&[place]]);
    check(&mut browser, finger);
    // A finger that moves along takes the cursor with it.
    let from = over(&mut browser, frequency(last));
    let to = over(&mut browser, frequency(finger));
    browser.touch(&[&[from], &[[to[0] + 60.0, to[1]]], &[to]]);
    check(&mut browser, finger);
    browser.value(&format!(
        "document.querySelector('{SPECTRUM} .stage').focus()"
    ));
    for (key, at) in [
        ("ArrowRight", finger + 1),
        ("ArrowLeft", finger),
        ("ArrowLeft", finger - 1),
        ("End", last),
        ("ArrowRight", last),
        ("ArrowLeft", last - 1),
        ("Home", 0),
    ] {
        browser.press(key);
        check(&mut browser, at);
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn wheel_fingers_and_keys_zoom_and_move_and_the_address_keeps_axis_step_and_part() {
    let (_folder, mut browser, _) = page(&[ADIS16405]);
    let begin = browser.value("walks[2].axis.frames[1].x");
    let [low, high] = [number(&begin[0]), number(&begin[1])];
    let ratio = |[from, to]: [f64; 2]| to / from;
    let centre = 20.0;
    let place = over(&mut browser, centre);
    browser.mouse("mouseMoved", place);
    browser.wheel(place, -240.0);
    let wheeled = seen(&mut browser).expect("a part");
    assert!(ratio(wheeled) < 0.6 * ratio([low, high]), "{wheeled:?}");
    // What is under the pointer stays there.
    let after = over(&mut browser, centre);
    assert!((after[0] - place[0]).abs() < 3.0, "{after:?} {place:?}");
    // The ticks are those of the part, and its points are as high as the panel.
    let ticks = browser.value(&format!(
        "[...document.querySelectorAll('{SPECTRUM} .across')].map((one) => Number(one.textContent))"
    ));
    let ticks: Vec<f64> = ticks.as_array().unwrap().iter().map(number).collect();
    assert!(ticks.len() >= 3, "{ticks:?}");
    assert!(
        ticks
            .iter()
            .all(|tick| (wheeled[0]..=wheeled[1]).contains(tick)),
        "{ticks:?}"
    );
    // Dragging to the left shows what is on the right.
    let [left, right] = [over(&mut browser, centre), over(&mut browser, 0.9 * centre)];
    browser.drag(right, left);
    let dragged = seen(&mut browser).expect("a part");
    assert!(dragged[0] < wheeled[0], "{dragged:?} {wheeled:?}");
    let expected = wheeled[0] * 0.9;
    assert!((dragged[0] / expected - 1.0).abs() < 0.02, "{dragged:?}");

    // The address has step, part and scale, and opens them again.
    browser.click("#axis-2-step-1");
    browser.click(&format!("{SPECTRUM} [data-tool=across]"));
    let kept = address(&mut browser, "spectrum.across=linear");
    assert!(kept.contains("#axis=2&step=1&spectrum="), "{kept}");
    let mut other = Browser::start();
    other.open(&kept);
    let again = seen(&mut other).expect("a part");
    for (one, other) in again.iter().zip(dragged) {
        assert!((one / other - 1.0).abs() < 1e-4, "{again:?} {dragged:?}");
    }
    assert_eq!(
        other.value("walks.map((walk) => walk.step)"),
        serde_json::json!([0, 0, 1])
    );
    assert_eq!(other.value("walks[2].views.spectrum.linearAcross"), true);
    let top = other.value("document.querySelector('#axis-2').getBoundingClientRect().top");
    assert!(number(&top).abs() < 2.0, "{top}");

    // Keys: 0 shows all, + and - zoom, and the arrows move the cursor and what is seen with it.
    browser.value(&format!(
        "document.querySelector('{SPECTRUM} .stage').focus()"
    ));
    browser.press("0");
    assert_eq!(seen(&mut browser), None);
    browser.press("End");
    browser.press("+");
    browser.press("+");
    let zoomed = seen(&mut browser).expect("a part");
    assert!((zoomed[1] / high - 1.0).abs() < 1e-6, "{zoomed:?}");
    assert!(zoomed[0] > low);
    browser.press("Home");
    let moved = seen(&mut browser).expect("a part");
    assert!((moved[0] / low - 1.0).abs() < 1e-6, "{moved:?}");
    browser.press("-");
    browser.press("-");
    assert_eq!(seen(&mut browser), None);
    // Buttons do the same, without a wheel or keys.
    let [out, all] = ["out", "reset"].map(|name| format!("{SPECTRUM} [data-tool={name}]"));
    browser.click(&format!("{SPECTRUM} [data-tool=in]"));
    assert!(seen(&mut browser).is_some());
    browser.click(&all);
    assert_eq!(seen(&mut browser), None);
    assert_eq!(
        browser.value(&format!("document.querySelector('{out}').disabled")),
        true
    );
    // Two fingers that part zoom, and the page does not scroll.
    let [x, y] = over(&mut browser, centre);
    let scrolled = browser.value("scrollY");
    let apart = |by: f64| [[x - by, y], [x + by, y]];
    browser.touch(&[&apart(25.0), &apart(40.0), &apart(60.0), &apart(75.0)]);
    let pinched = seen(&mut browser).expect("a part");
    let whole = browser.value("walks[2].plots[1].part().ends");
    let part = number(&whole[1]) - number(&whole[0]);
    assert!((part - 25.0 / 75.0).abs() < 0.1, "{part}: {pinched:?}");
    assert_eq!(browser.value("scrollY"), scrolled);
    for browser in [browser, other] {
        assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
    }
}

#[test]
fn a_wheel_scrolls_the_page_where_nothing_is_zoomed() {
    let (_folder, mut browser, _) = page(&[ADIS16405]);
    let place = over(&mut browser, 20.0);
    let before = number(&browser.value("scrollY"));
    browser.wheel(place, 200.0);
    let begin = Instant::now();
    while number(&browser.value("scrollY")) <= before {
        assert!(
            begin.elapsed() < Duration::from_secs(10),
            "the page does not scroll"
        );
        thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(seen(&mut browser), None);
}

#[test]
fn an_axis_is_linear_on_request() {
    let (_folder, mut browser, _) = page(&[ADIS16405]);
    let middle = "(() => { const { drawn } = walks[2].plots[1]; return [drawn.across.value(0.5), drawn.up.value(0)]; })()";
    let [low, high] = {
        let ends = browser.value("walks[2].axis.frames[1].x");
        [number(&ends[0]), number(&ends[1])]
    };
    let logarithmic = number(&browser.value(middle)[0]);
    assert!((logarithmic / (low * high).sqrt() - 1.0).abs() < 1e-9);
    for name in ["across", "up"] {
        let tool = format!("{SPECTRUM} [data-tool={name}]");
        browser.click(&tool);
        let pressed = browser.value(&format!("document.querySelector('{tool}').ariaPressed"));
        assert_eq!(pressed, "true");
    }
    let linear = browser.value(middle);
    assert!((number(&linear[0]) / (0.5 * (low + high)) - 1.0).abs() < 1e-9);
    assert_eq!(linear[1], 0);
    // The model's line bends between its points.
    let points = browser.value(&format!(
        "document.querySelector('{SPECTRUM} .line.model').getAttribute('d').split('L').length"
    ));
    assert!(number(&points) > 100.0, "{points}");
}

#[test]
fn octaves_and_bins_are_a_table_and_a_file_that_runs_no_formula() {
    let folder = TempDir::new().unwrap();
    let mut curves: Value = serde_json::from_str(&fs::read_to_string(ADIS16405).unwrap()).unwrap();
    curves["axes"][2]["axis"] = "=HYPERLINK(\"http://x\")".into();
    fs::write(folder.path().join("curves.json"), curves.to_string()).unwrap();
    reported(folder.path(), &["curves.json"]);
    let text = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let data = embedded(&text);
    let mut browser = opened(folder.path());
    let downloads = folder.path().to_str().unwrap();
    browser.call(
        "Browser.setDownloadBehavior",
        serde_json::json!({ "behavior": "allow", "downloadPath": downloads }),
    );
    browser.click(&format!("{SPECTRUM} .points summary"));
    let frame = &data["axes"][2]["frames"][1];
    let bins = frame["measured"]["x"].as_array().unwrap();
    // The browser tells a little later that the table was opened.
    let rows = format!("document.querySelectorAll('{SPECTRUM} .points tbody tr').length");
    let begin = Instant::now();
    while browser.value(&rows) == 0 {
        assert!(begin.elapsed() < Duration::from_secs(10), "no rows");
        thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(browser.value(&rows), bins.len());
    let failing = browser.text(&format!("{SPECTRUM} .failing"));
    let worst = data["axes"][2]["steps"][0]["figures"][1]["worst"]
        .as_u64()
        .unwrap() as usize;
    assert!((first_number(&failing.replace('\t', " ")) / number(&bins[worst]) - 1.0).abs() < 6e-4);
    browser.click(&format!("{SPECTRUM} .points button"));
    let file = folder.path().join("HYPERLINK-http-x-bins.csv");
    let begin = Instant::now();
    while !file.exists() {
        assert!(begin.elapsed() < Duration::from_secs(20), "no download");
        thread::sleep(Duration::from_millis(50));
    }
    let mut reader = csv::Reader::from_path(&file).unwrap();
    assert_eq!(&reader.headers().unwrap()[2], "frequency_hz");
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), bins.len());
    let figure = &data["axes"][2]["steps"][0]["figures"][1];
    for (at, row) in rows.iter().enumerate() {
        // The name is text, and a negative number stays a number.
        assert_eq!(&row[0], "'=HYPERLINK(\"http://x\")");
        let numbers = [
            (2, &bins[at]),
            (4, &frame["measured"]["measured"][at]),
            (7, &figure["expected"][at]),
            (8, &figure["z"][at]),
        ];
        for (column, value) in numbers {
            let shown: f64 = row[column].parse().unwrap();
            assert!((shown / number(value) - 1.0).abs() < 1e-5, "{row:?}");
        }
    }
    assert!(rows.iter().any(|row| row[8].starts_with('-')));
    for (field, safe) in [
        ("+1e5", "+1e5"),
        ("-2.5", "-2.5"),
        ("+cmd", "'+cmd"),
        ("@x", "'@x"),
        ("-1+2", "'-1+2"),
        ("\t=1", "'\t=1"),
        ("a,b", "\"a,b\""),
    ] {
        let shown = browser.value(&format!("csvField({})", Value::from(field)));
        assert_eq!(shown, safe);
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
