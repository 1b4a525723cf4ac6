//! The pages are written in plain sentences: words that stand for a mannerism of this project stay rare.

use crate::page::{Page, files, pages, text};

/// A mannerism: the phrases that count for it, and how many of them a thousand words of all pages may have.
struct Mannerism {
    phrases: &'static [&'static str],
    most: f64,
}

/// Each of these words has a use, and a bar that leaves room for it. What to write instead:
///
/// * "told": reported, detected, recognised, distinguished, given;
/// * "beside": with, next to, in addition to, compared with;
/// * "so that": a new sentence, or "therefore";
/// * "whoever": the reader, you;
/// * "blamed", "a wrong word": reported, a wrong effect;
/// * "in the place of", "stands for": replaces, instead of, is;
/// * "takes off", "takes for": subtracts, treats as.
const MANNERISMS: [Mannerism; 6] = [
    Mannerism {
        phrases: &["told", "tell", "tells", "telling", "beside"],
        most: 0.3,
    },
    Mannerism {
        phrases: &["so that"],
        most: 0.3,
    },
    Mannerism {
        phrases: &["whoever", "nobody", "somebody", "everybody"],
        most: 0.1,
    },
    Mannerism {
        phrases: &["blamed", "blames", "wrong word", "wrong words"],
        most: 0.0,
    },
    Mannerism {
        phrases: &["in the place of", "stands for", "stand for", "stood for"],
        most: 0.1,
    },
    Mannerism {
        phrases: &["takes off", "take off", "takes for", "taken for"],
        most: 0.1,
    },
];

/// The words of a page, in small letters and without punctuation.
fn words(page: &Page) -> Vec<String> {
    let prose = page.prose();
    let words = prose.split(|c: char| !(c.is_alphanumeric() || c == '\'' || c == '-'));
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

/// How often a phrase stands in a row of words.
fn count(words: &[String], phrase: &str) -> usize {
    let phrase: Vec<&str> = phrase.split(' ').collect();
    let windows = words.windows(phrase.len());
    windows.filter(|window| *window == phrase).count()
}

#[test]
fn mannerisms_are_rare() {
    let pages: Vec<(String, Vec<String>)> = pages()
        .iter()
        .map(|page| (page.path.clone(), words(page)))
        .collect();
    let all: usize = pages.iter().map(|(_, words)| words.len()).sum();
    assert!(all > 30_000, "{all} words");
    for Mannerism { phrases, most } in MANNERISMS {
        let places: Vec<(&String, usize)> = pages
            .iter()
            .map(|(path, words)| {
                let counts = phrases.iter().map(|phrase| count(words, phrase));
                (path, counts.sum())
            })
            .filter(|(_, count)| *count > 0)
            .collect();
        let found: usize = places.iter().map(|(_, count)| count).sum();
        assert!(
            found as f64 <= most * all as f64 / 1000.0,
            "{phrases:?} stand {found} times in {all} words: {places:?}"
        );
    }
}

/// How many words of [`MANNERISMS`]' first row a thousand words of the documentation in the sources may have.
const IN_SOURCES: f64 = 0.7;

#[test]
fn the_first_mannerism_is_rare_in_the_documentation_of_sources() {
    let (mut all, mut found) = (0, 0);
    for path in files("rs").iter().filter(|path| path.starts_with("src/")) {
        let source = text(path);
        let lines = source.lines().map(str::trim_start);
        let comments = lines.filter_map(|line| {
            line.strip_prefix("///")
                .or_else(|| line.strip_prefix("//!"))
        });
        let page = Page {
            path: path.clone(),
            text: comments.collect::<Vec<_>>().join("\n"),
        };
        let words = words(&page);
        let phrases = MANNERISMS[0].phrases.iter();
        all += words.len();
        found += phrases.map(|phrase| count(&words, phrase)).sum::<usize>();
    }
    assert!(all > 50_000, "{all} words");
    assert!(
        found as f64 <= IN_SOURCES * all as f64 / 1000.0,
        "{found} in {all} words"
    );
}

#[test]
fn a_phrase_is_found_across_lines_and_not_in_code() {
    let page = Page {
        path: String::new(),
        text: "It is written so\nthat, so  that.\n```\nso that\n```\n".to_owned(),
    };
    assert_eq!(count(&words(&page), "so that"), 2);
}
