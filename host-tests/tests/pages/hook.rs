//! The hook that git runs on the text of a commit.

use crate::page::ROOT;
use std::{fs, path::Path, process::Command};

/// Whether the hook accepts a text.
fn accepts(text: &str) -> bool {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = folder.path().join("text");
    fs::write(&file, text).expect("a file");
    let hook = Path::new(ROOT).join("host-tests/hooks/commit-msg");
    let run = Command::new(hook).arg(&file).output();
    run.expect("the hook starts").status.success()
}

#[test]
fn a_subject_has_at_most_60_characters_of_any_script() {
    for character in ["a", "χ", "²", "→"] {
        let subject = |length| character.repeat(length);
        assert!(accepts(&subject(60)), "{character}");
        assert!(!accepts(&subject(61)), "{character}");
    }
    let long = "a".repeat(200);
    assert!(accepts(&format!("\n# {long}\nA subject\n\n{long}\n")));
    assert!(accepts(&format!("Merge branch '{long}'")));
}
