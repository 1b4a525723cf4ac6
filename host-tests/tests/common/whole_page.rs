//! The page that carries the program: empty, and with the records of `explore`.

use crate::browser::Browser;
use program::output;
use serde_json::json;
use std::{
    path::{Path, PathBuf},
    thread,
    time::{Duration, Instant},
};

/// Builds the empty page into a folder; `None` where rustup cannot add the compiler for pages, and Debian's builds the images.
pub(crate) fn empty(folder: &Path) -> Option<PathBuf> {
    if let Err(error) = xtask::page::compiler() {
        eprintln!("left out, because there is no compiler for pages: {error:#}");
        return None;
    }
    let page = folder.join("allanite.html");
    xtask::page::page(&page).unwrap();
    Some(page)
}

/// Writes the page of `explore` with these arguments, and returns its address.
pub(crate) fn explored(folder: &Path, arguments: &[&str]) -> Option<String> {
    let empty = empty(folder)?;
    let written = folder.join("explore.html");
    let [empty, written] = [&empty, &written].map(|path| path.to_str().unwrap());
    let explore = [
        &["explore", "--page", empty, "--output", written],
        arguments,
    ]
    .concat();
    assert_eq!(output(Path::new("."), &explore).trim(), written);
    Some(format!("file://{written}"))
}

/// Waits until the page shows the answer to its last question.
pub(crate) fn settle(browser: &mut Browser) {
    let begin = Instant::now();
    while browser.value("!fits.busy && answer !== null") != true {
        assert!(
            begin.elapsed() < Duration::from_secs(60),
            "no answer: {}",
            browser.text("#problem")
        );
        thread::sleep(Duration::from_millis(5));
    }
}

/// Chooses files as a user does in a dialogue, or as a drop does.
pub(crate) fn choose(browser: &mut Browser, files: &[&Path]) {
    let document = browser.call("DOM.getDocument", json!({}));
    let found = json!({ "nodeId": document["root"]["nodeId"], "selector": "#logs" });
    let input = browser.call("DOM.querySelector", found);
    browser.call(
        "DOM.setFileInputFiles",
        json!({ "nodeId": input["nodeId"], "files": files }),
    );
}
