//! Tests the page of `explore`: in a browser, effects are added and moved by hand as a user does it.

use crate::{
    browser::Browser,
    whole_page::{self, explored, settle},
};
use program::{ADIS16405, json, number, output, refusal};
use serde_json::{Value, json};
use std::{
    fs,
    path::Path,
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// Opens the page and waits for its first answer, which moves what can be clicked.
fn open(browser: &mut Browser, url: &str) {
    browser.open(url);
    settle(browser);
}

/// The χ² that the page shows.
fn chi2(browser: &mut Browser) -> f64 {
    settle(browser);
    assert_eq!(browser.text("#problem"), "");
    let text = browser.text("#error .chi2 strong");
    text.parse().unwrap_or_else(|_| panic!("{text}"))
}

/// χ² of an axis as `compare` computes it.
fn compared(arguments: &[&str], axis: usize) -> f64 {
    let arguments = [&["compare"], arguments].concat();
    number(&json(Path::new("."), &arguments)["axes"][axis]["chi2"])
}

/// χ² of an axis for the command line that the page shows.
fn as_the_command_says(browser: &mut Browser, axis: usize) -> f64 {
    settle(browser);
    let command = browser.text("#command-line");
    let words: Vec<&str> = command.split(' ').collect();
    assert_eq!(words[..2], ["allanite", "compare"], "{command}");
    compared(&words[2..], axis)
}

/// Presses the mouse on the thumb of a slider, moves it over the whole slider and then to where χ² was least.
fn drag_to_the_minimum(browser: &mut Browser, slider: &str) {
    let place = |browser: &mut Browser| {
        let place = browser.value(&format!(
            "(() => {{ const slider = document.querySelector('{slider}'); slider.scrollIntoView({{ block: 'center' }}); \
             const box = slider.getBoundingClientRect(); \
             const at = (slider.value - slider.min) / (slider.max - slider.min); \
             return [box.x, box.width, box.x + 8 + at * (box.width - 16), box.y + box.height / 2]; }})()"
        ));
        [0, 1, 2, 3].map(|at| number(&place[at]))
    };
    let [left, width, thumb, y] = place(browser);
    let mouse = |browser: &mut Browser, kind: &str, x: f64| {
        let buttons = u8::from(kind == "mouseMoved");
        let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
        browser.call("Input.dispatchMouseEvent", event);
    };
    mouse(browser, "mousePressed", thumb);
    let mut least = (f64::INFINITY, left);
    let mut look = |browser: &mut Browser, x: f64| {
        mouse(browser, "mouseMoved", x);
        let now = chi2(browser);
        if now < least.0 {
            least = (now, x);
        }
        least.1
    };
    let mut best = left;
    for step in 0..=40 {
        best = look(browser, left + width * f64::from(step) / 40.0);
    }
    let middle = best;
    for step in -8..=8 {
        best = look(browser, middle + f64::from(step));
    }
    mouse(browser, "mouseMoved", best);
    mouse(browser, "mouseReleased", best);
    assert_eq!(chi2(browser), least.0);
}

#[test]
fn a_sinusoid_is_dragged_to_the_minimum_and_the_filter_lowers_chi_squared_as_compare_computes_it() {
    let folder = TempDir::new().unwrap();
    let Some(url) = explored(folder.path(), &[ADIS16405]) else {
        return;
    };
    let mut browser = Browser::start();
    open(&mut browser, &url);
    browser.click("#records tbody tr:nth-child(3) input[type=radio]");
    let five = chi2(&mut browser);
    assert_eq!(
        format!("{five:.1}"),
        format!("{:.1}", compared(&[ADIS16405], 2))
    );

    browser.click("[data-effect=sinusoid]");
    chi2(&mut browser);
    drag_to_the_minimum(&mut browser, ".effect input[type=range]");
    let value = browser.value("state.added[0].values[0]");
    let frequency_hz = number(&value);
    assert!((19.0..20.5).contains(&frequency_hz), "{frequency_hz}");
    let with = format!("sinusoid:frequency_hz={value}");
    let line = chi2(&mut browser);
    let expected = compared(&[ADIS16405, "--with", &with], 2);
    assert_eq!(format!("{line:.1}"), format!("{expected:.1}"));
    assert!(line < 0.3 * five, "{line}, {five}");
    // What the sinusoid did to the coefficients stands beside: it is one move from 0.4 Hz, so from the first position.
    let change = browser.text("#coefficients tr[data-effect=sinusoid] .change");
    assert!(
        change.ends_with('%') || change.contains("measured"),
        "{change}"
    );

    browser.click("[data-effect=decimation_filter]");
    chi2(&mut browser);
    // The button of the filter that looks for its best shape.
    browser.click(".effect:last-child .options button:nth-of-type(1)");
    let filter = chi2(&mut browser);
    assert!(filter < 0.5 * line, "{filter}, {line}");
    let expected = as_the_command_says(&mut browser, 2);
    assert!(
        (filter / expected - 1.0).abs() < 1e-3,
        "{filter}, {expected}"
    );
    // Fitted from there on, the line finds the minimum of the likelihood, which is near that of the deviance.
    browser.click("#effect-0-fit");
    let both = chi2(&mut browser);
    assert!(both <= 1.01 * filter, "{both}, {filter}");
    let expected = as_the_command_says(&mut browser, 2);
    assert!((both / expected - 1.0).abs() < 1e-3, "{both}, {expected}");

    // The address has all of it.
    let address = browser.value("location.href");
    let mut other = Browser::start();
    other.open(address.as_str().unwrap());
    assert!((chi2(&mut other) / both - 1.0).abs() < 1e-3);
    assert_eq!(
        other.value("document.querySelectorAll('.effect').length"),
        2
    );

    for _ in 0..2 {
        browser.click("#undo");
    }
    let undone = chi2(&mut browser);
    browser.click("#undo");
    assert_eq!(chi2(&mut browser), line);
    browser.click("#redo");
    assert_eq!(chi2(&mut browser), undone);
    browser.click("#reset");
    assert_eq!(chi2(&mut browser), five);
    for browser in [browser, other] {
        assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
    }
}

#[test]
fn fast_changes_do_not_pile_up_and_keys_and_labels_do_what_the_mouse_does() {
    let folder = TempDir::new().unwrap();
    let Some(url) = explored(folder.path(), &[ADIS16405]) else {
        return;
    };
    let mut browser = Browser::start();
    open(&mut browser, &url);
    chi2(&mut browser);
    browser.value("document.querySelector('[data-effect=resonance]').focus()");
    browser.value("document.activeElement.click()");
    chi2(&mut browser);
    let before = browser.value("state.added[0].values[0]");
    // The first slider has the focus, and a key moves it.
    assert_eq!(browser.value("document.activeElement.type"), "range");
    for _ in 0..20 {
        browser.press("ArrowRight");
    }
    chi2(&mut browser);
    let after = browser.value("state.added[0].values[0]");
    assert!(number(&after) > 1.02 * number(&before), "{before}, {after}");
    let spoken = browser.value("document.activeElement.getAttribute('aria-valuetext')");
    assert!(spoken.as_str().unwrap().ends_with(" Hz"), "{spoken}");
    browser.value(
        "window.open_now = 0; window.most = 0; window.sent = 0; const original = questions.run.bind(questions); \
         questions.run = async (...all) => { open_now += 1; sent += 1; most = Math.max(most, open_now); \
         try { return await original(...all); } finally { open_now -= 1; } }; 0",
    );
    browser.value(
        "(() => { const slider = document.activeElement; for (let k = 0; k < 200; k += 1) { \
         slider.value = 1500 + 5 * k; slider.dispatchEvent(new Event('input')); } })()",
    );
    let last = chi2(&mut browser);
    assert_eq!(browser.value("most"), 1);
    assert!(number(&browser.value("sent")) < 10.0);
    let with = browser.value("withText(state.added[0])");
    let expected = compared(&[ADIS16405, "--with", with.as_str().unwrap()], 0);
    assert_eq!(format!("{last:.1}"), format!("{expected:.1}"));
    // The result is told to a screen reader once it rests, and every control has a name.
    let begin = Instant::now();
    let wanted = format!("χ² {last:.1}");
    while !browser
        .value("document.getElementById('said').textContent")
        .as_str()
        .unwrap()
        .starts_with(&wanted)
    {
        assert!(begin.elapsed() < Duration::from_secs(10));
        thread::sleep(Duration::from_millis(50));
    }
    let nameless = browser.value(
        "[...document.querySelectorAll('input, button, select')].filter((one) => \
         !(one.labels?.length || one.getAttribute('aria-label') || one.textContent.trim())).length",
    );
    assert_eq!(nameless, 0);
    // A wrong number is refused in a line, and the next change goes on.
    browser.value("change(null, (of) => { of.added[0].values[0] = -1; })");
    settle(&mut browser);
    let problem = browser.text("#problem");
    assert!(
        problem.contains("frequency_hz=-1 is impossible"),
        "{problem}"
    );
    browser.click("#undo");
    assert_eq!(chi2(&mut browser), last);
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn one_record_is_fitted_and_another_judges_and_the_diagnosis_is_asked() {
    let folder = TempDir::new().unwrap();
    for (seed, amplitude, name) in [("2", "0.03", "before.csv"), ("3", "0.0001", "after.csv")] {
        let effect = format!("sinusoid:frequency_hz=7.7,amplitude={amplitude}");
        let simulate = ["simulate", "mems", "--duration", "327.68", "--seed", seed];
        output(
            folder.path(),
            &[&simulate[..], &["--effect", &effect, "--output", name]].concat(),
        );
    }
    let paths = ["before.csv", "after.csv"].map(|name| folder.path().join(name));
    let [before, after] = paths.each_ref().map(|path| path.to_str().unwrap());
    let Some(url) = explored(folder.path(), &[before, after]) else {
        return;
    };
    let mut browser = Browser::start();
    open(&mut browser, &url);
    let five = chi2(&mut browser);
    browser.click("#records tbody tr:nth-child(2) input[type=checkbox]");
    chi2(&mut browser);
    let judged = number(&browser.value("answer.judged[0].chi2"));
    assert!(judged > 200.0, "{judged}");
    assert!(number(&browser.value("document.querySelectorAll('.deviation .other').length")) > 10.0);

    let lead = browser.text("#lead-words");
    assert!(lead.contains("missing effect: sinusoid"), "{lead}");
    let diagnosis = json(Path::new("."), &["diagnose", before]);
    let steps = diagnosis["axes"][0]["steps"].as_array().unwrap();
    let last = &steps[steps.len() - 1]["effects"][5]["parameters"]["frequency_hz"];
    browser.click("#adopt");
    let adopted = chi2(&mut browser);
    let frequency_hz = number(&browser.value("state.added[0].values[0]"));
    assert!(
        (frequency_hz / number(last) - 1.0).abs() < 5e-4,
        "{frequency_hz}, {last}"
    );
    assert!(adopted < 0.5 * five);
    // The line of the first record is not in the second one, where the line makes it worse.
    assert!(number(&browser.value("answer.judged[0].chi2")) > judged);
    assert!((as_the_command_says(&mut browser, 0) / adopted - 1.0).abs() < 1e-3);
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);

    for (scheme, width) in [("light", 400), ("dark", 400), ("dark", 1200)] {
        browser.emulate("screen", scheme);
        browser.resize(width, 900);
        let wide = browser.value("document.documentElement.scrollWidth");
        assert!(
            number(&wide) <= f64::from(width),
            "{wide} pixels of {width}"
        );
        let clipped = browser.value(
            "[...document.querySelectorAll('p, td, th, dd, li, h2, h3, label, button')]\
             .filter((one) => one.scrollWidth > one.clientWidth + 1 && one.clientWidth > 1)\
             .map((one) => one.textContent)",
        );
        assert_eq!(clipped, Value::Array(Vec::new()), "{width}");
        // Nothing lies outside the page on its right either.
        let outside = browser.value(
            "[...document.querySelectorAll('td, th, input, button, select')].filter((one) => \
             one.getBoundingClientRect().right > document.documentElement.clientWidth + 1).map((one) => one.outerHTML)",
        );
        assert_eq!(outside, Value::Array(Vec::new()), "{width}");
    }
    // The program of this machine answers what the one in the page does, to the last bit.
    let session = output(Path::new("."), &["explore", "--session", before, after]);
    fs::write(folder.path().join("session.json"), session).unwrap();
    let asked = |what: &str, question: &str| {
        output(folder.path(), &["ask", what, question, "session.json"])
    };
    let shown = browser.value("[JSON.stringify(question(state)), JSON.stringify(answer)]");
    let own = asked("fit", shown[0].as_str().unwrap());
    // The browser writes 25.0 as 25.
    let own = format!("JSON.stringify(JSON.parse({}))", Value::from(own));
    assert!(browser.value(&own) == shown[1]);
    let question = json!({ "record": 0, "judged": [1], "with": ["sinusoid:frequency_hz=7.7"] });
    let question = question.to_string();
    let drawing = asked("drawing", &question);
    let drawing = roxmltree::Document::parse(&drawing).expect("SVG");
    assert!(
        drawing
            .descendants()
            .filter(|node| node.has_tag_name("circle"))
            .count()
            > 100
    );
    let table = asked("table", &question);
    let mut rows = csv::ReaderBuilder::new();
    let mut rows = rows.comment(Some(b'#')).from_reader(table.as_bytes());
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let answer: Value = serde_json::from_str(&asked("fit", &question)).unwrap();
    let drawn = &answer["records"][0]["measured"];
    for (row, (x, measured)) in rows.iter().zip(
        drawn["x"]
            .as_array()
            .unwrap()
            .iter()
            .zip(drawn["measured"].as_array().unwrap()),
    ) {
        assert_eq!((&row[0], &row[1]), ("gx of before.csv", "deviation"));
        for (text, drawn) in [(&row[2], x), (&row[3], measured)] {
            assert!((text.parse::<f64>().unwrap() / number(drawn) - 1.0).abs() < 1e-4);
        }
    }
    assert!(
        rows.iter()
            .any(|row| &row[0] == "gx of after.csv" && &row[1] == "spectrum")
    );
}

#[test]
fn a_report_carries_the_program_with_which_its_reader_tries_an_effect() {
    let folder = TempDir::new().unwrap();
    let Some(empty) = whole_page::empty(folder.path()) else {
        return;
    };
    let written = folder.path().join("report.html");
    let report = |options: &[&str]| {
        let files = ["report", ADIS16405, "--output", written.to_str().unwrap()];
        let said = output(Path::new("."), &[&files, options].concat());
        (said, fs::read_to_string(&written).unwrap())
    };
    let (said, plain) = report(&["--plain"]);
    assert!(
        said.contains("`explore` changes the effects by hand"),
        "{said}"
    );
    assert!(plain.len() < 500_000 && !plain.contains("id=\"explorer\""));
    let (said, page) = report(&["--page", empty.to_str().unwrap()]);
    assert!(
        said.contains("where effects can be tried by hand"),
        "{said}"
    );
    assert!(page.len() < plain.len() + 1_750_000, "{}", page.len());

    let both = [
        "report",
        ADIS16405,
        "--max-effects",
        "1",
        "--output",
        "x.html",
    ];
    let page_option = ["--page", empty.to_str().unwrap()];
    let refused = refusal(folder.path(), &[&both[..], &page_option].concat());
    assert!(
        refused.contains("--max-effects; omit one of them"),
        "{refused}"
    );

    // The report is what it was, and its link opens the other state of the page.
    let mut browser = Browser::start();
    browser.open(&format!("file://{}", written.display()));
    assert_eq!(browser.text("#try"), "Try effects on these records");
    assert_eq!(browser.small_targets(), json!([]));
    let shown = browser.text(".summary");
    browser.value("location.href = byId('try').href");
    let begin = Instant::now();
    while browser.value("document.querySelector('#catalogue li') === null") != false {
        assert!(begin.elapsed() < Duration::from_secs(60), "not opened");
        thread::sleep(Duration::from_millis(20));
    }
    let five = chi2(&mut browser);
    // The page shows one digit behind the point.
    let same = |shown: f64, computed: f64| (shown - computed).abs() < 0.06;
    assert!(same(five, compared(&[ADIS16405], 0)), "{five}");
    // What the report found is one click away, and explains the record.
    browser.click("#adopt");
    settle(&mut browser);
    let found = as_the_command_says(&mut browser, 0);
    assert!(chi2(&mut browser) < five / 10.0);
    assert!(same(chi2(&mut browser), found), "{found}");
    let words = browser.text("#lead-words");
    assert!(
        shown.contains("decimation filter") && words.contains("decimation filter"),
        "{shown} {words}"
    );
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
