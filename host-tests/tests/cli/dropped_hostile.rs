//! Hostile logs on the page without a server: each is answered in little time, asks nobody, and runs no script of its own.

use crate::{
    bad_input::corpus,
    browser::Browser,
    whole_page::{choose, empty},
};
use std::{
    fs,
    path::{Path, PathBuf},
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// The longest time to an answer.
const LONGEST: Duration = Duration::from_secs(10);

/// What the page is asked to do, in turn.
const COMMANDS: [&str; 3] = ["explore", "report", "diagnose"];

/// A page that waits for logs.
struct Waiting {
    browser: Browser,
    folder: TempDir,
}

impl Waiting {
    fn new() -> Option<Self> {
        let folder = TempDir::new().unwrap();
        let page = empty(folder.path())?;
        let mut browser = Browser::start();
        browser.open(&format!("file://{}", page.display()));
        Some(Self { browser, folder })
    }

    /// Writes a file, chooses it, and returns the time to the answer.
    fn answer(&mut self, name: &str, bytes: &[u8], command: &str, options: &str) -> Duration {
        let file: PathBuf = self.folder.path().join(name);
        fs::write(&file, bytes).unwrap();
        self.browser.value(&format!(
            "byId('command').value = {command:?}; byId('options').value = {options:?}; byId('status').textContent = ''; byId('logs').value = ''; true"
        ));
        let begun = Instant::now();
        choose(&mut self.browser, &[Path::new(&file)]);
        loop {
            let state = self.browser.value("byId('status').textContent");
            let state = state.as_str().unwrap_or_default();
            if state.starts_with("done") || state.starts_with("ended") {
                break;
            }
            assert!(
                begun.elapsed() < 10 * LONGEST,
                "{command} {name}: no end: {state}"
            );
            thread::sleep(Duration::from_millis(5));
        }
        let taken = begun.elapsed();
        fs::remove_file(file).unwrap();
        taken
    }

    /// Nobody was asked, and nothing of a log ran.
    fn is_alone(&mut self, after: &str) {
        let requests = "performance.getEntriesByType('resource').filter((one) => !/^(blob|data):/.test(one.name)).length";
        assert_eq!(self.browser.value(requests), 0, "{after}");
        assert_eq!(
            self.browser.value("typeof window.hit"),
            "undefined",
            "{after}"
        );
        // Nobody gives a page hundreds of logs within a minute, and the browser says so.
        let complaints = &mut self.browser.complaints;
        complaints.retain(|complaint| !complaint.contains("Throttling navigation"));
        assert_eq!(*complaints, [""; 0], "{after}");
    }
}

#[test]
fn no_name_in_a_dropped_log_runs() {
    let Some(mut page) = Waiting::new() else {
        return;
    };
    let names = [
        "<img src=x onerror=top.hit=1>",
        "</script><script>top.hit=1</script>",
        "\"\"><svg onload=top.hit=1>",
        "${top.hit=1}",
    ];
    let rows: String = (0..3000_i64)
        .map(|n| format!("{0},{0}\n", n * n % 97))
        .collect();
    for name in names {
        let text = format!("# rate_hz=100 unit=deg/s scale=0.01\n\"{name}\",\"gy {name}\"\n{rows}");
        for command in COMMANDS {
            let file = format!("{}.csv", name.replace('/', "\u{2215}"));
            page.answer(&file, text.as_bytes(), command, "--columns 1,2");
            page.is_alone(&format!("{command} of {name}"));
            let shown = page.browser.value("document.body.innerText");
            assert!(
                shown
                    .as_str()
                    .is_some_and(|text| text.contains("top.hit=1")),
                "{command} {name}"
            );
        }
    }
}

mod thorough {
    use super::*;

    /// The program of the command line gets the whole corpus; the page, which has the same readers, every fourth log of it.
    const SHARE: usize = 4;

    #[test]
    fn logs_of_the_corpus_are_answered_by_the_page() {
        let Some(mut page) = Waiting::new() else {
            return;
        };
        let (mut answered, mut slowest) = (0, (Duration::ZERO, String::new()));
        for (number, case) in corpus().into_iter().enumerate().step_by(SHARE) {
            let (files, arguments) = case.parts();
            let ([(name, bytes)], [command, rest @ ..]) = (files, arguments) else {
                continue;
            };
            if name.contains('/') || !["diagnose", "export"].contains(&command.as_str()) {
                continue;
            }
            let options: Vec<&str> = rest
                .iter()
                .map(String::as_str)
                .filter(|word| word != name)
                .collect();
            let command = match command.as_str() {
                "export" => "export",
                _ => COMMANDS[number / SHARE % COMMANDS.len()],
            };
            let taken = page.answer(name, bytes, command, &options.join(" "));
            page.is_alone(case.name());
            answered += 1;
            if taken > slowest.0 {
                slowest = (
                    taken,
                    format!("{command} of {}, case {number}", case.name()),
                );
            }
        }
        println!(
            "{answered} logs: at most {:.1} s, {}",
            slowest.0.as_secs_f64(),
            slowest.1
        );
        assert!(
            answered > 1500 && slowest.0 < LONGEST,
            "{answered}: {slowest:?}"
        );
    }
}
