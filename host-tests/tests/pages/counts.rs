//! Counts and lists on pages are those of the sources.

use crate::{
    commands::{self, Studies},
    page::{files, module_documentation, pages, text},
};
use allanite::{
    effect::{CATALOGUE, IEEE_952},
    sensor::{self, Adis16470, bmi270},
};
use std::collections::BTreeSet;

/// Numbers that pages write as words.
const NUMBERS: [&str; 21] = [
    "zero",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
    "thirteen",
    "fourteen",
    "fifteen",
    "sixteen",
    "seventeen",
    "eighteen",
    "nineteen",
    "twenty",
];

/// A number in digits or in words.
fn number(word: &str) -> Option<usize> {
    let word = word.to_lowercase();
    let named = NUMBERS.iter().position(|name| *name == word);
    word.parse().ok().or(named)
}

/// The sensors that are described. Two of them are not in the list: that of a description with an image to upload, and that
/// of a driver of its own.
fn sensors() -> usize {
    let others = [size_of_val(&bmi270), size_of::<fn(Adis16470<()>)>()];
    sensor::CATALOGUE.len() + others.len()
}

/// The sensors whose FIFO is described.
fn fifos() -> usize {
    let described = sensor::CATALOGUE.iter();
    described.filter(|sensor| sensor.fifo.is_some()).count()
}

/// The names of the cores of which the budgets have figures.
fn cores() -> BTreeSet<String> {
    let budgets: serde_json::Value =
        serde_json::from_str(&text("host-tests/budgets.json")).expect("JSON");
    let cores = budgets["cores"].as_array().expect("cores");
    let names = cores.iter().map(|core| core["core"].as_str());
    names.map(|name| name.expect("a name").to_owned()).collect()
}

/// The numbers that stand before a phrase, on any page.
fn numbers_before(phrase: &str) -> Vec<(String, usize)> {
    let phrase: Vec<&str> = phrase.split(' ').collect();
    let mut found = Vec::new();
    for page in pages() {
        let prose = page.prose();
        let words: Vec<&str> = prose
            .split_whitespace()
            .map(|word| word.trim_matches([',', '.', ';', ':', '*', '(', ')']))
            .collect();
        for window in words.windows(phrase.len() + 1) {
            if window[1..] == phrase {
                found.extend(number(window[0]).map(|number| (page.path.clone(), number)));
            }
        }
    }
    found
}

#[test]
fn counts_are_those_of_the_sources() {
    // Studies ran on two cores of a machine.
    for (phrase, counts, least) in [
        ("sensors are described", &[sensors()][..], 2),
        ("sensors", &[sensors()], 2),
        ("IMUs on SPI", &[sensors()], 1),
        ("of them with their FIFO", &[fifos()], 3),
        ("effects in the catalogue", &[CATALOGUE.len()], 1),
        ("cores", &[cores().len(), 2], 3),
    ] {
        let found = numbers_before(phrase);
        assert!(found.len() >= least, "{phrase}: {found:?}");
        let wrong: Vec<_> = found
            .iter()
            .filter(|(_, number)| !counts.contains(number))
            .collect();
        assert!(
            wrong.is_empty(),
            "{phrase}: {wrong:?} instead of {counts:?}"
        );
    }
}

/// The rows of a table of a page whose header begins so, each as its cells.
fn table(page: &str, header: &str) -> Vec<Vec<String>> {
    let lines = page.lines().skip_while(|line| !line.starts_with(header));
    let rows = lines.skip(2).take_while(|line| line.starts_with('|'));
    let rows = rows.map(|line| {
        let cells = line.trim().trim_matches('|').split('|');
        cells.map(|cell| cell.trim().to_owned()).collect()
    });
    let rows: Vec<Vec<String>> = rows.collect();
    assert!(!rows.is_empty(), "no table `{header}`");
    rows
}

/// The first words of the pieces of code in a column of a table.
fn code_in(rows: &[Vec<String>], column: usize) -> BTreeSet<String> {
    let cells = rows.iter().map(|row| row[column].as_str());
    let code = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    let words = code.filter_map(|code| code.split(' ').next());
    words.map(str::to_owned).collect()
}

#[test]
fn the_manual_lists_every_command() {
    let rows = table(&text("host-tests/README.md"), "| command | what it does |");
    let commands: BTreeSet<String> = commands::commands().into_iter().collect();
    assert_eq!(code_in(&rows, 0), commands);
}

#[test]
fn the_manual_lists_every_format_of_export() {
    let rows = table(&text("host-tests/doc/commands.md"), "| `--format` |");
    let help = commands::help("export");
    let values = help.split("--format <FORMAT>\n").nth(1).expect("formats");
    let values = values.split("\n      --").next().expect("their end");
    let values = values
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- "));
    let values = values.filter_map(|line| line.split(':').next());
    let values: BTreeSet<String> = values.map(str::to_owned).collect();
    assert_eq!(code_in(&rows, 0), values);
}

#[test]
fn the_manual_lists_every_effect_beyond_the_five_terms() {
    let rows = table(&text("host-tests/doc/effects.md"), "| effect | shape |");
    let five: BTreeSet<&str> = IEEE_952.iter().map(|effect| effect.name()).collect();
    let names = CATALOGUE.iter().map(|effect| effect.name());
    let names = names.filter(|name| !five.contains(name));
    assert_eq!(code_in(&rows, 0), names.map(str::to_owned).collect());
}

#[test]
fn the_page_of_sensors_lists_every_description() {
    let page = module_documentation("src/sensor/mod.rs");
    let rows = table(&page, "| sensor | rate");
    assert_eq!(rows.len(), sensors() - 1);
    let with = rows
        .iter()
        .filter(|row| row.last().expect("a cell") != "no");
    assert_eq!(with.count(), fifos());
}

#[test]
fn the_page_of_costs_has_every_core_in_both_precisions() {
    let rows = table(&text("host-tests/doc/firmware.md"), "| core | precision |");
    for precision in ["single", "double"] {
        let shown = rows.iter().filter(|row| row[1] == precision);
        let shown: BTreeSet<String> = shown.map(|row| row[0].clone()).collect();
        assert_eq!(shown, cores(), "{precision}");
    }
}

#[test]
fn the_page_of_studies_names_every_study() {
    let page = text("host-tests/doc/studies/README.md");
    let code: BTreeSet<&str> = page
        .split('`')
        .skip(1)
        .step_by(2)
        .filter_map(|code| code.split(' ').next_back())
        .collect();
    let studies = Studies::read();
    let missing: Vec<_> = studies
        .names
        .iter()
        .filter(|name| !code.contains(name.as_str()))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn the_page_of_robustness_lists_every_fuzz_target() {
    let rows = table(&text("host-tests/doc/robustness.md"), "| target | input |");
    let targets = files("rs").into_iter().filter_map(|path| {
        let name = path.strip_prefix("host-tests/fuzz/targets/")?;
        name.strip_suffix(".rs").map(str::to_owned)
    });
    assert_eq!(code_in(&rows, 0), targets.collect());
}

#[test]
fn numbers_are_read_in_digits_and_in_words() {
    assert_eq!(number("14"), Some(14));
    assert_eq!(number("Seven"), Some(7));
    assert_eq!(number("thousand"), None);
}
