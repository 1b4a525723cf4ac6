//! The words of data sheets and of the literature lead to what they mean here.

use crate::page::{CRATE_PAGE, module_documentation, text};
use program::rows;
use std::process::Command;

const GLOSSARY: &str = "host-tests/doc/glossary.md";

/// Words of data sheets, of IEEE Std 952 and of NIST SP 1065. Each is the name of exactly one row of the glossary.
const WORDS: [&str; 26] = [
    "ARW",
    "angle random walk",
    "rate noise density",
    "in-run bias stability",
    "bias stability",
    "bias instability",
    "VRW",
    "velocity random walk",
    "rate random walk",
    "PSD",
    "power spectral density",
    "ASD",
    "ADEV",
    "overlapping Allan deviation",
    "EDF",
    "equivalent degrees of freedom",
    "averaging factor",
    "CIC",
    "cascaded integrator-comb",
    "boxcar",
    "block history",
    "trend",
    "saturation",
    "clipping",
    "gap filling",
    "confidence interval",
];

/// The pages and helps on which somebody looks for these words first. `allanite X` is the help of a command.
const PLACES: [(&str, &[&str]); 9] = rows! {
    "README.md",
        &["ARW", "rate noise density", "in-run bias stability", "overlapping Allan deviation", "NIST SP 1065", "PSD", "Welch"];
    "src/README.md", &["ARW", "rate noise density", "in-run bias stability", "overlapping Allan deviation", "PSD"];
    CRATE_PAGE,
        &["ARW", "rate noise density", "in-run bias stability", "VRW", "overlapping Allan", "SP 1065", "PSD", "Welch", "EDF",
            "block history", "saturation", "gap filling"];
    "host-tests/doc/reading.md", &["ARW", "in-run bias stability", "VRW", "ADEV", "PSD", "ASD", "EDF", "saturation"];
    "host-tests/doc/effects.md", &["CIC", "boxcar", "block history", "trend"];
    "host-tests/doc/metrology.md", &["EDF", "PSD", "Welch", "SP 1065", "gap filling", "block history"];
    "allanite fit", &["ARW", "rate noise density", "in-run bias stability", "VRW", "EDF"];
    "allanite measure", &["overlapping Allan", "SP 1065", "PSD", "Welch", "block history", "gap filling"];
    "allanite diagnose", &["PSD", "CIC", "boxcar", "saturation"];
};

/// The names of each row of the glossary, in small letters.
fn rows() -> Vec<Vec<String>> {
    let glossary = text(GLOSSARY);
    let rows = glossary.lines().skip_while(|line| !line.starts_with("|--"));
    let rows = rows.skip(1).filter_map(|line| {
        let (names, _) = line.strip_prefix('|')?.split_once('|')?;
        let names = names.split(',').map(|name| name.trim().to_lowercase());
        Some(names.collect())
    });
    rows.collect()
}

#[test]
fn each_word_of_a_data_sheet_is_one_row_of_the_glossary() {
    let rows = rows();
    assert!(rows.len() > 40, "{} rows", rows.len());
    for word in WORDS {
        let word = word.to_lowercase();
        let found = rows.iter().filter(|names| names.contains(&word)).count();
        assert_eq!(found, 1, "rows of {GLOSSARY} that are named `{word}`");
    }
}

#[test]
fn rows_of_the_glossary_have_names_of_their_own() {
    let mut names: Vec<String> = rows().concat();
    names.sort();
    let twice: Vec<_> = names.windows(2).filter(|pair| pair[0] == pair[1]).collect();
    assert!(twice.is_empty(), "{twice:?}");
}

/// A text in small letters, with single blanks.
fn even(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").to_lowercase()
}

#[test]
fn words_of_data_sheets_stand_where_they_are_looked_for() {
    for (place, words) in PLACES {
        let text = match place.strip_prefix("allanite ") {
            Some(command) => {
                let help = Command::new(env!("CARGO_BIN_EXE_allanite"))
                    .args([command, "--help"])
                    .output()
                    .expect("the program starts");
                String::from_utf8(help.stdout).expect("text")
            }
            None if place == CRATE_PAGE => module_documentation(place),
            None => text(place),
        };
        let text = even(&text);
        let missing: Vec<_> = words
            .iter()
            .filter(|word| !text.contains(&word.to_lowercase()))
            .collect();
        assert!(missing.is_empty(), "{place} lacks {missing:?}");
    }
}
