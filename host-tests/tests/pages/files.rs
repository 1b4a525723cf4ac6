//! Every file and folder that a page names is there.

use crate::page::{Page, ROOT, files, pages};
use std::{collections::BTreeSet, path::Path};

/// The folders with which a path from the root begins.
const TOP: [&str; 3] = ["src", "host-tests", ".cargo"];

/// Names of files that a page may name alone are those with one of these endings.
const ALONE: [&str; 2] = [".rs", ".md"];

/// The folder of a page, from the root.
pub(crate) fn folder(page: &Page) -> &Path {
    Path::new(&page.path).parent().expect("a file in a folder")
}

/// The words of code that name a file or a folder. Words with a part to fill in are left out.
fn paths(code: &str) -> impl Iterator<Item = &str> {
    let words = code.split_whitespace();
    let words = words.map(|word| word.trim_start_matches(['(', '"', '\'']));
    let words = words.map(|word| word.trim_end_matches([',', ';', ':', '.', ')', '"', '\'']));
    let words = words.map(|word| word.trim_start_matches("./"));
    words.filter(|word| !word.contains(['*', '…', '<', '$', '=']))
}

/// Whether a word of code is a path from the root or from the folder of a page.
fn is_path(word: &str) -> bool {
    word.split_once('/')
        .is_some_and(|(first, _)| TOP.contains(&first))
}

#[test]
fn files_that_pages_name_exist() {
    let names: BTreeSet<String> = ["rs", "md"]
        .iter()
        .flat_map(|extension| files(extension))
        .filter_map(|path| path.rsplit('/').next().map(str::to_owned))
        .collect();
    let (mut checked, mut missing) = (0, Vec::new());
    for page in pages() {
        let root = Path::new(ROOT);
        for word in page.code().iter().flat_map(|code| paths(code)) {
            let is_there = if is_path(word) {
                root.join(word).exists() || root.join(folder(&page)).join(word).exists()
            } else if !word.contains('/') && ALONE.iter().any(|end| word.ends_with(end)) {
                names.contains(word)
            } else {
                continue;
            };
            checked += 1;
            if !is_there {
                missing.push(format!("{}: {word}", page.path));
            }
        }
    }
    assert!(checked > 60, "{checked} paths");
    assert!(missing.is_empty(), "not there:\n{}", missing.join("\n"));
}

#[test]
fn paths_are_words_of_code_without_parts_to_fill_in() {
    let found: Vec<_> = paths("cp ./src/a.rs, host-tests/*.md `x").collect();
    assert_eq!(found, ["cp", "src/a.rs", "`x"]);
    assert!(is_path("src/a.rs") && !is_path("parts/a.rs") && !is_path("src"));
}
