//! `ask`: the questions of the page of `explore`, which runs this program for each of them.

use super::{question::What, session::Session};
use allanite_log::failure::{Failure, Place};
use clap::Args;
use std::{
    io::{Read, Write},
    path::PathBuf,
};

/// The largest session, in bytes. Chosen by hand: a record takes 40 kB.
const LARGEST: u64 = 1 << 28;

/// Answer a question of the page of explore
#[derive(Debug, Args)]
pub(in crate::command) struct Arguments {
    /// What is asked for
    what: What,
    /// The model and the records, in JSON
    question: String,
    /// What `explore --session` printed
    session: PathBuf,
}

/// Runs the command.
pub(in crate::command) fn run(
    arguments: &Arguments,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let path = &arguments.session;
    let (file, _) = allanite_log::regular_file::open(path)?;
    let mut text = Vec::new();
    file.take(LARGEST)
        .read_to_end(&mut text)
        .map_err(|error| Place::file(path).io(&error))?;
    let answer = Session::parse(&text)?.ask(arguments.what, arguments.question.as_bytes())?;
    output
        .write_all(&answer)
        .map_err(|error| Failure::standard_output(&error))
}
