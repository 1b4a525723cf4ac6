//! The pages, and the code in them.

use std::{fs, path::Path};

/// The root of the repository.
pub(crate) const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The file whose documentation is the page of the crate.
pub(crate) const CRATE_PAGE: &str = "src/lib.rs";

/// A page: its path from the root, and its text in Markdown.
pub(crate) struct Page {
    pub(crate) path: String,
    pub(crate) text: String,
}

impl Page {
    /// The text without the blocks of code.
    pub(crate) fn prose(&self) -> String {
        let outside = self.text.split("```").step_by(2);
        outside.collect::<Vec<_>>().join("\n")
    }

    /// The code of the page: each line of its blocks, and each piece of code in its sentences, which may go over two lines.
    pub(crate) fn code(&self) -> Vec<String> {
        let mut found = Vec::new();
        for (at, part) in self.text.split("```").enumerate() {
            if at % 2 == 1 {
                found.extend(part.lines().skip(1).map(str::to_owned));
                continue;
            }
            for paragraph in part.split("\n\n") {
                let code = paragraph.split('`').skip(1).step_by(2);
                found.extend(code.map(|code| code.replace('\n', " ")));
            }
        }
        found
    }
}

/// The text of a file, whose path counts from the root.
pub(crate) fn text(path: &str) -> String {
    let text = fs::read_to_string(Path::new(ROOT).join(path));
    text.unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The documentation at the head of a file of Rust.
pub(crate) fn module_documentation(path: &str) -> String {
    let text = text(path);
    let lines = text.lines().filter_map(|line| line.strip_prefix("//!"));
    let lines = lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
    lines.collect::<Vec<_>>().join("\n")
}

/// All pages.
pub(crate) fn pages() -> Vec<Page> {
    let mut pages = vec![Page {
        path: CRATE_PAGE.to_owned(),
        text: module_documentation(CRATE_PAGE),
    }];
    for path in files("md") {
        let text = text(&path);
        pages.push(Page { path, text });
    }
    assert!(pages.len() > 35, "{} pages", pages.len());
    pages
}

/// The files of the project whose names end so, with their paths from the root.
pub(crate) fn files(extension: &str) -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["", "src", "host-tests"] {
        walk(folder, !folder.is_empty(), &mut found);
    }
    let end = format!(".{extension}");
    found.retain(|path| path.ends_with(&end));
    found.sort();
    found
}

/// Adds the files of a folder, and if wanted those of the folders in it. What is built and what is hidden is left out.
fn walk(folder: &str, is_deep: bool, found: &mut Vec<String>) {
    let entries = fs::read_dir(Path::new(ROOT).join(folder)).expect("a folder");
    for entry in entries.map(|entry| entry.expect("an entry")) {
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if folder.is_empty() {
            name.clone()
        } else {
            format!("{folder}/{name}")
        };
        let is_folder = entry.file_type().expect("a type").is_dir();
        match is_folder {
            true if is_deep && name != "target" && !name.starts_with('.') => {
                walk(&path, is_deep, found);
            }
            true => {}
            false => found.push(path),
        }
    }
}
