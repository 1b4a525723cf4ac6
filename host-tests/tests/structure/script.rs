//! Finds which file of Python or JavaScript imports which.

use crate::import::Graph;
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// Files by their names, with what is in them.
pub(crate) type Files = BTreeMap<String, String>;

/// The files below a folder whose names end so.
pub(crate) fn files(folder: &Path, end: &str) -> Files {
    let mut found = Files::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in
            fs::read_dir(&next).unwrap_or_else(|error| panic!("{}: {error}", next.display()))
        {
            let path = entry.unwrap().path();
            // What was built is no file of the project.
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(end) {
                let name = path
                    .strip_prefix(folder)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                found.insert(name, fs::read_to_string(&path).unwrap());
            }
        }
    }
    found
}

/// The modules that a file of Python imports, also where only types are checked: `from . import a, b` and `from .a import B` of
/// the package, and `import allanite.a`.
pub(crate) fn python(files: &Files, package: &str) -> Graph {
    let imported = |text: &str| -> BTreeSet<String> {
        let mut names = BTreeSet::new();
        for line in statements(text) {
            let line = line.trim();
            if let Some((of, what)) = line
                .strip_prefix("from ")
                .and_then(|rest| rest.split_once(" import "))
            {
                let of = of
                    .strip_prefix(package)
                    .map_or(of, |rest| if rest.is_empty() { "." } else { rest });
                match of.strip_prefix('.') {
                    Some("") => {
                        names.extend(what.trim_matches(['(', ')']).split(',').map(first_word));
                    }
                    Some(module) => _ = names.insert(module.to_owned()),
                    None => {}
                }
            } else if let Some(modules) = line.strip_prefix("import ") {
                let modules = modules.split(',').map(first_word);
                names.extend(modules.filter_map(|name| {
                    Some(name.strip_prefix(package)?.strip_prefix('.')?.to_owned())
                }));
            }
        }
        names
            .iter()
            .map(|name| format!("{}.py", name.replace('.', "/")))
            .filter(|name| files.contains_key(name))
            .collect()
    };
    files
        .iter()
        .map(|(name, text)| (name.clone(), imported(text)))
        .collect()
}

/// The lines of a text, with what stands in parentheses on one line.
fn statements(text: &str) -> Vec<String> {
    let mut statements: Vec<String> = Vec::new();
    let mut open = false;
    for line in text.lines() {
        match statements.last_mut() {
            Some(last) if open => last.push_str(line.trim()),
            _ => statements.push(line.to_owned()),
        }
        let begins = line.trim_start().starts_with("from ") && line.trim_end().ends_with('(');
        open = (open || begins) && !line.contains(')');
    }
    statements
}

fn first_word(text: &str) -> String {
    text.split_whitespace()
        .next()
        .unwrap_or_default()
        .to_owned()
}

/// The files that a file of JavaScript imports: `import … from "./a.js"`, `import "./a.js"`, `import("./a.js")`,
/// `importScripts("a.js")` and `export … from "./a.js"`.
pub(crate) fn javascript(files: &Files) -> Graph {
    let imported = |name: &str, text: &str| -> BTreeSet<String> {
        let folder = Path::new(name).parent().unwrap_or(Path::new(""));
        let mut found = BTreeSet::new();
        for line in text.lines().map(str::trim) {
            let is_import = line.starts_with("import ")
                || line.starts_with("export ")
                || line.contains("import(")
                || line.contains("importScripts(");
            if !is_import {
                continue;
            }
            for part in line
                .split(['"', '\'', '`'])
                .filter(|part| part.ends_with(".js"))
            {
                let mut path = folder.to_owned();
                for step in part.split('/') {
                    match step {
                        "." | "" => {}
                        ".." => _ = path.pop(),
                        step => path.push(step),
                    }
                }
                found.insert(path.to_string_lossy().into_owned());
            }
        }
        found.retain(|name| files.contains_key(name));
        found
    };
    files
        .iter()
        .map(|(name, text)| (name.clone(), imported(name, text)))
        .collect()
}
