//! Finds the words of verdicts outside the files that define them.

use crate::script::Files;
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use syn::{
    Expr, ExprLit, Item, Lit, LitStr, Macro,
    visit::{self, Visit},
};

/// Pieces of verdicts that are also said of other things.
const ORDINARY: [&str; 5] = [
    "and more",
    "not decided",
    "not valid",
    "record longer",
    "see `diagnose`",
];

/// What stands for a part of a sentence that differs from record to record.
const HOLE: char = '\0';

/// The words of verdicts, as the files say them that define them.
pub(crate) struct Catalogue {
    /// The word for a model that explains the record, and what only sentences of the catalogue may say.
    pub(crate) word: String,
    pub(crate) phrases: Vec<String>,
    /// Sentences as the words between their holes.
    sentences: Vec<Vec<Vec<String>>>,
    /// The names of verdicts in files.
    pub(crate) names: BTreeSet<String>,
}

impl Catalogue {
    /// The catalogue of sentences, and the file of the library that gives verdicts their names.
    pub(crate) fn of(sentences: &[Item], names: &[Item]) -> Self {
        let constants = constants(sentences);
        let mut whole: Vec<String> = strings(sentences)
            .iter()
            .map(|text| filled(text, &constants))
            .collect();
        whole.sort();
        whole.dedup();
        let mut phrases: Vec<String> = whole
            .iter()
            .flat_map(|text| text.split([HOLE, ',', ';', ':', '.', '(', ')']))
            .map(|piece| piece.trim().to_owned())
            .filter(|piece| piece.contains(' ') && !ORDINARY.contains(&&**piece))
            .collect();
        phrases.sort();
        phrases.dedup();
        let sentences = whole
            .iter()
            .map(|text| text.split(HOLE).map(words).collect());
        let names = strings(names)
            .into_iter()
            .chain(constants.get("NOT_STATIONARY").cloned());
        Self {
            word: constants["ADEQUATE"].clone(),
            phrases,
            sentences: sentences.collect(),
            names: names.collect(),
        }
    }

    /// The phrases in a text, and the word in a sentence. A text that is the word alone is a key of a document or of a column.
    fn phrases<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a str> {
        let is_said = text != self.word && words(text).contains(&self.word);
        let phrases = self
            .phrases
            .iter()
            .filter(|phrase| text.contains(&***phrase));
        phrases
            .chain(is_said.then_some(&self.word))
            .map(String::as_str)
    }

    /// The phrases in the strings of a file in Rust, those of macros included, and names of verdicts that something is compared
    /// with. Comments, which become attributes, do not count.
    pub(crate) fn in_rust(&self, items: &[Item]) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        let mut visitor = Strings::default();
        items.iter().for_each(|item| visitor.visit_item(item));
        for text in &visitor.all {
            found.extend(self.phrases(text).map(str::to_owned));
        }
        // What is said of a limit is another verdict.
        let has = |called: &[String], word: &str| called.iter().any(|text| text == word);
        let of_records = visitor.macros.iter();
        for called in of_records.filter(|one| has(one, "verdict") && !has(one, "limits")) {
            found.extend(
                called
                    .iter()
                    .filter(|text| self.names.contains(*text))
                    .cloned(),
            );
        }
        found
    }

    /// The phrases in other files: in the strings of code, and in all text of pages. Comments and documentation do not count.
    pub(crate) fn in_others(&self, files: &Files) -> Vec<String> {
        let mut found = Vec::new();
        for (name, text) in files {
            let mut in_documentation = false;
            for line in text.lines() {
                let quotes = line.matches("\"\"\"").count();
                let is_said = !in_documentation && quotes == 0;
                in_documentation ^= quotes == 1;
                let is_comment = ["//", "#", "*", "<!--"]
                    .iter()
                    .any(|begin| line.trim_start().starts_with(begin));
                if is_said && !is_comment {
                    let strings = line.split(['"', '\'', '`']).skip(1).step_by(2);
                    let said: Vec<&str> = match name.ends_with(".html") {
                        true => vec![line],
                        false => strings.collect(),
                    };
                    let said = said.iter().flat_map(|text| self.phrases(text));
                    found.extend(said.map(|phrase| format!("{name}: {phrase:?}")));
                }
            }
        }
        found
    }

    /// The lines of a page's blocks that are nearly, but not quite, sentences of the catalogue.
    pub(crate) fn outdated<'a>(&self, page: &'a str) -> Vec<&'a str> {
        let blocks = page.split("```").skip(1).step_by(2);
        let lines = blocks.flat_map(|block| block.lines().skip(1));
        lines.filter(|line| self.is_outdated(line)).collect()
    }

    fn is_outdated(&self, line: &str) -> bool {
        let words = words(line);
        // A part of a sentence may be one, too.
        let near = self.sentences.iter();
        let near = near.filter(|sentence| is_near(sentence, &words));
        let longest = near.max_by_key(|sentence| sentence.concat().len());
        longest.is_some_and(|sentence| !is_said(sentence, &words))
    }
}

/// The words of a text, without what is between them.
fn words(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Whether a line has the pieces of a sentence one behind another.
fn is_said(sentence: &[Vec<String>], line: &[String]) -> bool {
    let mut rest = line;
    sentence
        .iter()
        .filter(|piece| !piece.is_empty())
        .all(|piece| {
            let place = rest.windows(piece.len()).position(|window| window == piece);
            let behind = place.and_then(|at| rest.get(at + piece.len()..));
            rest = behind.unwrap_or_default();
            behind.is_some()
        })
}

/// Whether a line has, in order, four of five words of a sentence of at least five.
fn is_near(sentence: &[Vec<String>], line: &[String]) -> bool {
    let words = sentence.concat();
    // The longest common subsequence with each beginning of the line.
    let mut longest = vec![0; words.len() + 1];
    for said in line {
        let mut before = 0;
        for (at, word) in words.iter().enumerate() {
            let above = longest[at + 1];
            longest[at + 1] = if word == said {
                before + 1
            } else {
                above.max(longest[at])
            };
            before = above;
        }
    }
    words.len() >= 5 && 5 * longest[words.len()] >= 4 * words.len()
}

/// The strings that are constants of a file.
fn constants(items: &[Item]) -> BTreeMap<String, String> {
    let constants = items.iter().filter_map(|item| match item {
        Item::Const(item) => match &*item.expr {
            Expr::Lit(ExprLit {
                lit: Lit::Str(text),
                ..
            }) => Some((item.ident.to_string(), text.value())),
            _ => None,
        },
        _ => None,
    });
    constants.collect()
}

/// A string of `format!` with its constants, and holes in the place of everything else between braces.
fn filled(text: &str, constants: &BTreeMap<String, String>) -> String {
    let mut filled = String::new();
    for (at, part) in text.split(['{', '}']).enumerate() {
        match (at % 2, constants.get(part)) {
            (0, _) => filled.push_str(part),
            (_, Some(constant)) => filled.push_str(constant),
            _ => filled.push(HOLE),
        }
    }
    filled
}

/// The strings of a file.
fn strings(items: &[Item]) -> Vec<String> {
    let mut strings = Strings::default();
    items.iter().for_each(|item| strings.visit_item(item));
    strings.all
}

/// All strings, and those of each macro.
#[derive(Default)]
struct Strings {
    all: Vec<String>,
    macros: Vec<Vec<String>>,
}

/// Adds the strings of tokens.
fn add_tokens(tokens: TokenStream, strings: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => add_tokens(group.stream(), strings),
            TokenTree::Literal(literal) => {
                if let Ok(text) = syn::parse_str::<LitStr>(&literal.to_string()) {
                    strings.push(text.value());
                }
            }
            _ => {}
        }
    }
}

impl<'ast> Visit<'ast> for Strings {
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_lit_str(&mut self, text: &'ast LitStr) {
        self.all.push(text.value());
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        let mut strings = Vec::new();
        add_tokens(called.tokens.clone(), &mut strings);
        self.all.extend_from_slice(&strings);
        self.macros.push(strings);
        visit::visit_macro(self, called);
    }
}
