//! Finds floating-point numbers in a file.

use crate::source::File;
use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::{
    LitFloat, Macro,
    visit::{self, Visit},
};

/// Types of floating-point numbers.
const TYPES: [&str; 3] = ["f32", "f64", "Real"];

/// The floating-point numbers and their types that a file names.
pub(crate) fn floats(file: &File) -> Vec<String> {
    let mut floats = Floats(Vec::new());
    for item in &file.items {
        floats.visit_item(item);
    }
    floats.0
}

struct Floats(Vec<String>);

impl Floats {
    fn add_tokens(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Ident(word) => self.visit_ident(&word),
                TokenTree::Group(group) => self.add_tokens(group.stream()),
                TokenTree::Literal(literal) => {
                    if let Ok(number) = syn::parse_str::<LitFloat>(&literal.to_string()) {
                        self.visit_lit_float(&number);
                    }
                }
                TokenTree::Punct(_) => {}
            }
        }
    }
}

impl<'ast> Visit<'ast> for Floats {
    fn visit_ident(&mut self, word: &'ast Ident) {
        if TYPES.iter().any(|name| word == name) {
            self.0.push(word.to_string());
        }
    }

    fn visit_lit_float(&mut self, number: &'ast LitFloat) {
        self.0.push(number.to_string());
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.add_tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}
