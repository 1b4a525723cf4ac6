//! The table of promises: what is promised stands where the table says, and the tests that it names exist.

use std::{collections::BTreeSet, fs, path::Path};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
const TABLE: &str = "host-tests/doc/promises.md";
const README: &str = "README.md";
const CRATE_PAGE: &str = "src/lib.rs";
/// The sources of the stages of a run, and of those of `--all` alone.
const STAGES: [&str; 3] = [
    "host-tests/xtask/src/test/mod.rs",
    "host-tests/xtask/src/test/lints.rs",
    "host-tests/xtask/src/python.rs",
];
const THOROUGH_STAGES: [&str; 2] = [
    "host-tests/xtask/src/test/thorough.rs",
    "host-tests/xtask/src/test/publishing.rs",
];

/// A row of the table.
#[derive(Debug)]
struct Promise {
    words: String,
    from: String,
    /// The test of every run, and the proof.
    tests: [String; 2],
}

fn text(path: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The text on one line, without the marks of a comment.
fn joined(text: &str) -> String {
    let lines = text.lines().map(|line| line.trim_start_matches("//!"));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    words.join(" ")
}

fn promises(table: &str) -> Vec<Promise> {
    let rows = table.lines().filter(|line| line.starts_with("| "));
    let cells = rows.map(|row| {
        let cells = row.trim_matches('|').split(" | ");
        cells.map(|cell| cell.trim().to_owned()).collect()
    });
    let cells: Vec<Vec<String>> = cells.skip(1).collect();
    let promise = |cells: Vec<String>| match <[String; 4]>::try_from(cells) {
        Ok([words, from, first, second]) => Promise {
            words,
            from,
            tests: [first, second],
        },
        Err(cells) => panic!("a row has {} cells: {cells:?}", cells.len()),
    };
    cells.into_iter().map(promise).collect()
}

/// Why a name of a test or of a stage is wrong, or nothing. `may_be_thorough` allows what only `--all` runs.
fn complaint(name: &str, may_be_thorough: bool) -> Option<String> {
    if let Some(stage) = name.strip_prefix("stage `") {
        let stage = stage.trim_end_matches('`');
        let named = |files: &[&str]| files.iter().any(|file| has_stage(&text(file), stage));
        let is_there = named(&STAGES) || may_be_thorough && named(&THOROUGH_STAGES);
        return (!is_there).then(|| format!("there is no stage {stage:?} in this run"));
    }
    let (file, function) = name.trim_matches('`').split_once(": ")?;
    let source = text(file);
    let keyword = if file.ends_with(".py") { "def" } else { "fn" };
    let Some(place) = source.find(&format!("{keyword} {function}(")) else {
        return Some(format!("{file} has no test {function}"));
    };
    let is_thorough =
        file.contains("/thorough/") || module_of(&source[..place]).contains("mod thorough {");
    (is_thorough && !may_be_thorough).then(|| format!("only --all runs {function}"))
}

/// The text from the last declaration of a module at the left margin, or the end of the last one, to the end.
fn module_of(before: &str) -> &str {
    let begun = before.rfind("\nmod ").unwrap_or(0);
    let ended = before.rfind("\n}\n").unwrap_or(0);
    &before[begun.max(ended)..]
}

/// Whether a source of the chores names a stage; the names of fuzz targets and studies are parts of those of their stages.
fn has_stage(source: &str, stage: &str) -> bool {
    if let Some(target) = stage.strip_prefix("fuzzing of ") {
        let target = format!("{ROOT}/host-tests/fuzz/targets/{target}.rs");
        return source.contains("fuzzing of {target}") && Path::new(&target).exists();
    }
    if let Some(study) = stage.strip_prefix("the study ") {
        return source.contains("the study {}") && source.contains(&format!("\"{study}\""));
    }
    source.contains(&format!("\"{stage}\""))
}

#[test]
fn promises_stand_where_they_are_quoted_from_and_their_tests_exist() {
    let promises = promises(&text(TABLE));
    assert!(promises.len() > 25, "{} promises", promises.len());
    let mut complaints = Vec::new();
    for promise in &promises {
        if !joined(&text(&promise.from)).contains(&promise.words) {
            complaints.push(format!("{} does not say: {}", promise.from, promise.words));
        }
        let tests = promise.tests.iter().zip([false, true]);
        complaints.extend(tests.filter_map(|(name, proof)| complaint(name, proof)));
        if promise.tests.iter().any(|name| !name.contains('`')) {
            complaints.push(format!("no test of: {}", promise.words));
        }
    }
    assert!(complaints.is_empty(), "{TABLE}:\n{}", complaints.join("\n"));
}

/// The parts of a page that promise something: the goals of the README, and the sections of the crate's page.
fn parts(page: &str) -> Vec<String> {
    let page = text(page);
    match page.split_once("## Goals and non-goals") {
        Some((_, goals)) => {
            let goals = goals.split("\n## ").next().unwrap_or_default();
            goals.split("\n* ").skip(1).map(joined).collect()
        }
        None => {
            let lines = page.lines().filter(|line| line.starts_with("//!"));
            let mut sections: Vec<String> = Vec::new();
            for line in lines {
                // A line that an example hides begins in the same way as a title.
                let title = line.strip_prefix("//! # ");
                if title.is_some_and(|title| !title.contains(['(', '{', '=', ';', '}'])) {
                    sections.push(String::new());
                }
                if let Some(section) = sections.last_mut() {
                    *section += &format!("{line}\n");
                }
            }
            sections.iter().map(|section| joined(section)).collect()
        }
    }
}

#[test]
fn every_goal_and_every_section_has_a_promise_with_a_test() {
    let promises = promises(&text(TABLE));
    for (page, least) in [(README, 4), (CRATE_PAGE, 8)] {
        let parts = parts(page);
        assert!(parts.len() >= least, "{page}: {parts:?}");
        let without: BTreeSet<&String> = (parts.iter())
            .filter(|part| !promises.iter().any(|one| part.contains(&one.words)))
            .collect();
        assert!(
            without.is_empty(),
            "{TABLE} has no row for {page}: {without:#?}"
        );
    }
}

#[test]
fn what_is_wrong_in_the_table_is_found() {
    let good = "`host-tests/tests/structure/promises.rs: what_is_wrong_in_the_table_is_found`";
    assert_eq!(complaint(good, false), None);
    let missing = "`host-tests/tests/structure/promises.rs: nobody`";
    assert!(complaint(missing, true).is_some_and(|said| said.ends_with("has no test nobody")));
    let proof = "`host-tests/tests/images/thorough/boards.rs: boards_build_and_fit`";
    assert!(complaint(proof, false).is_some() && complaint(proof, true).is_none());
    assert_eq!(complaint("stage `format`", false), None);
    assert!(complaint("stage `fleets`", false).is_some());
    assert_eq!(complaint("stage `fleets`", true), None);
    assert!(complaint("stage `fuzzing of nothing`", true).is_some());
}
