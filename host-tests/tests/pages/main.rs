//! The pages are true where a program can check them, and written in the words of the field.
//!
//! Pages are the Markdown files of the project and the documentation of the crate. The tests of the command line run the
//! examples that pages show (`tests/cli/readme.rs`); these tests read.

mod commands;
mod counts;
mod files;
#[cfg(unix)]
mod hook;
mod links;
mod page;
mod voice;
mod words;
