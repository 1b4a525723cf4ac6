//! The commands of a workstation, for which a page has no use: it would only become larger.

use super::{certify, completions, decode, lot, schema, simulate};
use allanite_log::failure::Failure;
use clap::Subcommand;
use std::io::Write;

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    Simulate(simulate::Arguments),
    Certify(certify::Arguments),
    Decode(decode::Arguments),
    Lot(lot::Arguments),
    Schema(schema::Arguments),
    Completions(completions::Arguments),
}

impl Command {
    /// Runs the command. `line` is the whole command line, for its completions.
    ///
    /// # Errors
    /// For bad input of any kind, and when standard output cannot be written.
    pub(super) fn run(
        &self,
        line: impl FnOnce() -> clap::Command,
        output: &mut impl Write,
    ) -> Result<(), Failure> {
        match self {
            Self::Simulate(arguments) => simulate::run(arguments, output),
            Self::Certify(arguments) => certify::run(arguments, output),
            Self::Decode(arguments) => decode::run(arguments, output),
            Self::Lot(arguments) => lot::run(arguments, output),
            Self::Schema(arguments) => schema::run(arguments, output),
            Self::Completions(arguments) => completions::run(arguments, line(), output),
        }
    }
}
