//! The glossary of the manual and the effects of the catalogue, for pages on which words explain themselves.

use allanite::effect::EXPLAINED;
use allanite_host::words::plain;
use serde::Serialize;
use std::borrow::Cow;

const GLOSSARY: &str = include_str!("../../../../doc/glossary.md");

/// A word with its names.
#[derive(Debug, PartialEq, Serialize)]
pub(in crate::command) struct Word {
    names: Vec<Cow<'static, str>>,
    meaning: String,
}

/// The words of the glossary, and behind them the effects that it does not have. Names of one letter are symbols, which explain nothing.
pub(in crate::command) fn words() -> Vec<Word> {
    let rows = GLOSSARY.lines().skip_while(|line| !line.starts_with("|--"));
    let rows = rows.skip(1).filter_map(|line| {
        let (names, meaning) = line.trim().strip_prefix('|')?.split_once('|')?;
        let names = names.split(',').map(str::trim).enumerate();
        let names = names.filter(|(at, name)| *at == 0 || name.chars().count() > 1);
        Some(Word {
            names: names.map(|(_, name)| name.into()).collect(),
            meaning: meaning.trim_end_matches('|').trim().replace('*', ""),
        })
    });
    let mut words: Vec<Word> = rows.collect();
    for effect in EXPLAINED {
        let name = plain(effect.description().name);
        if words
            .iter()
            .all(|word| !word.names.contains(&name.as_str().into()))
        {
            words.push(Word {
                names: vec![name.into()],
                meaning: effect.explanation().what.to_owned(),
            });
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_a_word_with_its_names() {
        let words = words();
        assert!(words.len() > 30);
        let named = |name: &str| words.iter().find(|word| word.names.contains(&name.into()));
        let walk = named("angle random walk").unwrap();
        assert!(
            !walk.names.contains(&"N".into())
                && walk.meaning.starts_with("White noise of the rate.")
        );
        for name in [
            "χ²",
            "p",
            "degrees of freedom",
            "Allan deviation",
            "95 % interval",
        ] {
            assert!(
                named(name).is_some_and(|word| !word.meaning.contains(['|', '*'])),
                "{name}"
            );
        }
    }
}
