//! Links of pages lead to what is there, and every page is linked.

use crate::{
    files::folder,
    page::{ROOT, pages, text},
};
use std::{collections::BTreeSet, path::Path};

/// The project's page, and that of the published crate.
const README: &str = "README.md";
const PUBLISHED: &str = "src/README.md";

/// Pages that are no part of the manual, but linked from it.
const LINKED: [&str; 3] = [
    "host-tests/README.md",
    "host-tests/CONTRIBUTING.md",
    "src/python/README.md",
];

/// What a page links to or draws: a file, and a place in it or nothing.
fn links(page: &str) -> impl Iterator<Item = (&str, &str)> {
    let targets = page.split("](").skip(1);
    let targets = targets.filter_map(|rest| rest.split(')').next());
    let targets = targets.filter(|target| !target.contains("://"));
    targets.map(|target| target.split_once('#').unwrap_or((target, "")))
}

/// The names by which links find the headings of a page.
fn places(page: &str) -> impl Iterator<Item = String> {
    let headings = page.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| {
        let heading = line.trim_start_matches('#').trim().to_lowercase();
        let kept = heading
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    })
}

#[test]
fn what_pages_link_exists() {
    let (mut checked, mut missing) = (0, Vec::new());
    // A link of the crate's page leads to an item.
    for page in pages().iter().filter(|page| page.path.ends_with(".md")) {
        let prose = page.prose();
        for (file, place) in links(&prose) {
            let path = match file {
                "" => page.path.clone(),
                file => folder(page).join(file).to_string_lossy().into_owned(),
            };
            checked += 1;
            let is_there = Path::new(ROOT).join(&path).exists();
            let has_place = || places(&text(&path)).any(|heading| heading == place);
            if !is_there || (!place.is_empty() && path.ends_with(".md") && !has_place()) {
                missing.push(format!("{}: {file}#{place}", page.path));
            }
        }
    }
    assert!(checked > 150, "{checked} links");
    assert!(missing.is_empty(), "not there:\n{}", missing.join("\n"));
}

#[test]
fn every_page_is_linked() {
    let pages = pages();
    let mut linked = BTreeSet::new();
    for page in &pages {
        let files = page.prose();
        let files = links(&files).map(|(file, _)| Path::new(ROOT).join(folder(page)).join(file));
        linked.extend(files.filter_map(|file| file.canonicalize().ok()));
    }
    let manual = pages.iter().map(|page| page.path.as_str());
    let manual = manual.filter(|path| path.starts_with("host-tests/doc/"));
    for path in manual.chain(LINKED) {
        let file = Path::new(ROOT).join(path).canonicalize().expect("a page");
        assert!(linked.contains(&file), "no page links to {path}");
    }
}

/// A registry shows this page apart from any repository, so that no link of its own leads anywhere. What it names is in
/// the package, and the project's page, whose links reach the repository, is not.
#[test]
fn the_published_page_links_nothing_that_is_not_published() {
    let listed = xtask::firmware::cargo()
        .args([
            "package",
            "--package",
            "allanite",
            "--list",
            "--allow-dirty",
        ])
        .output()
        .expect("cargo");
    assert!(listed.status.success(), "{listed:?}");
    let listed = String::from_utf8(listed.stdout).expect("names");
    let files: Vec<_> = listed.lines().collect();
    let page = text(PUBLISHED);
    assert_eq!(links(&page).next(), None);
    for file in ["LICENSE-APACHE", "LICENSE-MIT"] {
        assert!(page.contains(file) && files.contains(&file), "{file}");
    }
    assert!(
        files.contains(&PUBLISHED) && !files.contains(&README),
        "{files:?}"
    );
}
