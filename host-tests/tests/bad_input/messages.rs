//! The whole messages of all bad inputs, which are committed beside this file.

use std::{collections::HashMap, fs, path::PathBuf};

/// Writes the messages anew if this variable is set.
const RENEW: &str = "ALLANITE_RENEW_MESSAGES";

/// What stands for the temporary folder in a message.
pub(crate) const FOLDER: &str = "<folder>";

fn path() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests/bad_input/messages.txt"]
        .iter()
        .collect()
}

/// The names of the cases, in their order. Cases of one name are numbered.
pub(crate) fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut seen = HashMap::new();
    let mut number = |name: &'a str| {
        let number = seen.entry(name).or_insert(0);
        *number += 1;
        format!("{name}, {number}")
    };
    names.map(&mut number).collect()
}

/// Compares the messages of all cases with the committed ones, and returns what differs.
pub(crate) fn compare(names: &[String], messages: &[String]) -> Vec<String> {
    let mut made = String::new();
    for (name, message) in names.iter().zip(messages) {
        made += &format!("# {}\n{message}", name.escape_debug());
        if !made.ends_with('\n') {
            made.push('\n');
        }
    }
    if std::env::var_os(RENEW).is_some() {
        fs::write(path(), &made).unwrap();
    }
    let committed = fs::read_to_string(path()).unwrap_or_default();
    let cases = |text: &str| -> Vec<String> {
        let parts = text.split("\n# ");
        parts.map(|part| part.trim().to_owned()).collect()
    };
    let (made, committed) = (cases(&made), cases(&committed));
    let mut wrong: Vec<String> = made
        .iter()
        .zip(&committed)
        .filter(|(made, committed)| made != committed)
        .map(|(made, committed)| format!("{made}\n  instead of\n{committed}"))
        .collect();
    if made.len() != committed.len() {
        wrong.push(format!(
            "{} messages instead of {}",
            made.len(),
            committed.len()
        ));
    }
    if !wrong.is_empty() {
        wrong.push(format!(
            "If they are right: {RENEW}=1 cargo test -p host-tests --test bad_input"
        ));
    }
    wrong
}
