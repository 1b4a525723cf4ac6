//! `schema`: prints the JSON schema of what a command prints with `--json`.

use super::{decode, examples, input::many, lot};
use allanite_host::{
    compare::compared::Compared, diagnose::diagnosed::Diagnosed, fit::fitted::Fitted,
};
use allanite_log::failure::Failure;
use clap::{Args, ValueEnum};
use std::io::{self, Write};

/// Print the JSON schema of what a command prints with --json
///
/// The schema is made from the types that the command prints, in JSON Schema 2020-12. New versions may add properties.
#[derive(Debug, Args)]
#[command(after_help = examples::SCHEMA)]
pub(super) struct Arguments {
    /// The command
    command: Command,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Command {
    Fit,
    Compare,
    Diagnose,
    Decode,
    Lot,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let schema = match arguments.command {
        Command::Fit => many::schema::<Vec<Fitted>>("Output of `allanite fit --json`"),
        Command::Compare => many::schema::<Vec<Compared>>("Output of `allanite compare --json`"),
        Command::Diagnose => many::schema::<Vec<Diagnosed>>("Output of `allanite diagnose --json`"),
        Command::Decode => decode::schema("Output of `allanite decode --json`"),
        Command::Lot => lot::schema("Output of `allanite lot --json`"),
    };
    let printed = serde_json::to_writer_pretty(&mut *output, &schema);
    let printed = printed.map_err(io::Error::from);
    printed
        .and_then(|()| writeln!(output))
        .map_err(|error| Failure::standard_output(&error))
}
