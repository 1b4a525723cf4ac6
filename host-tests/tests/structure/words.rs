//! Finds the words of verdicts in the strings of source files.

use crate::{script::Files, source::File};
use proc_macro2::{TokenStream, TokenTree};
use syn::{
    LitStr, Macro,
    visit::{self, Visit},
};

/// What only the catalogue of verdicts may say. A key of a document or of a column, which is a word alone, is not a phrase.
pub(crate) const PHRASES: [&str; 11] = [
    "adequate ",
    " adequate",
    "explain the record",
    "explain a part of the record",
    "too short to judge",
    "too few octaves to judge",
    "part unexplained",
    "no effect is missing",
    "is not stationary",
    "not_stationary",
    "five terms suffice",
];

/// The phrases in a text.
fn phrases(text: &str) -> impl Iterator<Item = &'static str> {
    PHRASES
        .into_iter()
        .filter(move |phrase| text.contains(phrase))
}

/// The phrases in the strings of a file in Rust, those of macros included. Comments, which become attributes, do not count.
pub(crate) fn rust(file: &File) -> Vec<&'static str> {
    let mut strings = Strings(Vec::new());
    for item in &file.items {
        strings.visit_item(item);
    }
    strings.0.iter().flat_map(|text| phrases(text)).collect()
}

struct Strings(Vec<String>);

impl Strings {
    fn add_tokens(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.add_tokens(group.stream()),
                TokenTree::Literal(literal) => {
                    if let Ok(text) = syn::parse_str::<LitStr>(&literal.to_string()) {
                        self.0.push(text.value());
                    }
                }
                _ => {}
            }
        }
    }
}

impl<'ast> Visit<'ast> for Strings {
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_lit_str(&mut self, text: &'ast LitStr) {
        self.0.push(text.value());
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.add_tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}

/// The phrases in other files: in the strings of code, and in all text of pages. Comments and documentation do not count.
pub(crate) fn others(files: &Files) -> Vec<String> {
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
                let said = match name.ends_with(".html") {
                    true => line.to_owned(),
                    false => strings.collect::<Vec<_>>().join("\n"),
                };
                found.extend(phrases(&said).map(|phrase| format!("{name}: {phrase:?}")));
            }
        }
    }
    found
}
