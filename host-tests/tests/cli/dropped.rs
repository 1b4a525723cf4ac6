//! The page without a server: a log that is dropped on it gives what the command line gives, byte by byte.

use crate::{
    browser::Browser,
    whole_page::{choose, empty},
};
use program::{command, output};
use serde_json::json;
use std::{
    fs, thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// The largest page, in bytes.
const MOST: u64 = 1_690_000;

/// How long a command may take in the page, on a machine that is busy with other tests.
const PATIENCE: Duration = Duration::from_secs(120);

/// Asks for a command with options, as the form does, and waits for its end. Returns the state, what it printed, and its notes.
fn ask(browser: &mut Browser, command: &str, options: &str) -> [String; 3] {
    let fill = format!(
        "byId('command').value = {command:?}; byId('options').value = {options:?}; byId('status').textContent = ''; \
         byId('ask').requestSubmit(); true"
    );
    browser.value(&fill);
    ended(browser)
}

fn ended(browser: &mut Browser) -> [String; 3] {
    let begun = Instant::now();
    loop {
        let state = browser.value("byId('status').textContent");
        let state = state.as_str().unwrap_or_default().to_owned();
        if state.starts_with("done") || state.starts_with("ended") {
            let shown = ["output", "errors"].map(|id| {
                let text = browser.value(&format!("byId('{id}').textContent"));
                text.as_str().unwrap_or_default().to_owned()
            });
            let [output, errors] = shown;
            return [state, output, errors];
        }
        assert!(begun.elapsed() < PATIENCE, "no end: {state}");
        thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_dropped_log_gives_what_the_command_line_gives_and_nothing_leaves_the_page() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let Some(page) = empty(folder) else { return };
    let bytes = page.metadata().unwrap().len();
    assert!(bytes <= MOST, "{bytes}");
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "600",
        "--axes",
        "3",
        "--seed",
        "3",
        "--effect",
        "sinusoid:frequency_hz=31,amplitude=0.05",
        "--effect",
        "thermal:slope=0.02,kelvin=5,period_s=200",
        "--output",
        "log.csv",
    ];
    output(folder, &simulate);
    output(folder, &["measure", "log.csv", "--output", "curve.json"]);
    fs::write(folder.join("bad.csv"), "gx,gy,gz\n1,2,3\n4,no,6\n").unwrap();

    let mut browser = Browser::start();
    browser.open(&format!("file://{}", page.display()));
    assert_eq!(browser.nameless(), [""; 0]);
    assert_eq!(browser.small_targets(), json!([]));
    for input in ["log.csv", "curve.json"] {
        let path = folder.join(input);
        choose(&mut browser, &[&path]);
        let [state, ..] = ended(&mut browser);
        assert!(state.starts_with("done"), "{state}");
        for (name, options) in [
            ("fit", &["--json"][..]),
            ("diagnose", &["--json"]),
            ("diagnose", &[]),
            ("compare", &["--with", "sinusoid:frequency_hz~31"]),
            ("export", &["--format", "kalibr"]),
        ] {
            let [state, printed, _] = ask(&mut browser, name, &options.join(" "));
            assert!(state.starts_with("done"), "{input} {name}: {state}");
            let expected = output(folder, &[&[name, input], options].concat());
            assert!(printed == expected, "{input} {name} {options:?}");
        }
        // A page carries no other.
        ask(&mut browser, "report", "--plain");
        let shown = browser.value("byId('report').srcdoc");
        let plain = ["report", input, "--plain", "--output", "report.html"];
        output(folder, &plain);
        let expected = fs::read_to_string(folder.join("report.html")).unwrap();
        assert!(shown == expected, "{input}");
        let framed = browser.value("byId('report').hidden");
        assert_eq!(framed, false);
    }
    // Two files are fitted together, one after the other.
    let both = ["log.csv", "curve.json"].map(|name| folder.join(name));
    choose(&mut browser, &[&both[0], &both[1]]);
    ended(&mut browser);
    let [_, printed, _] = ask(&mut browser, "fit", "--json");
    assert_eq!(
        printed,
        output(folder, &["fit", "log.csv", "curve.json", "--json"])
    );

    // What cannot be read has its one line, and the page goes on.
    choose(&mut browser, &[&folder.join("bad.csv")]);
    ended(&mut browser);
    let [state, printed, errors] = ask(&mut browser, "fit", "");
    assert!(state.starts_with("ended with status 2"), "{state}");
    assert_eq!(printed, "");
    let refused = command(folder, &["fit", "bad.csv"]).output().unwrap();
    assert_eq!(errors, String::from_utf8(refused.stderr).unwrap());

    let requests = "performance.getEntriesByType('resource').filter((one) => !/^(blob|data):/.test(one.name)).length";
    assert_eq!(browser.value(requests), 0);
    assert_eq!(browser.complaints, [""; 0]);
}
