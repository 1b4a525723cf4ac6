//! `completions`: prints the script with which a shell completes commands and options.

use crate::command::examples;
use allanite_log::failure::Failure;
use clap::{Args, Command};
use clap_complete::{Shell, generate};
use std::io::Write;

/// Print a shell's completion script, to be sourced or put where the shell looks for it
#[derive(Debug, Args)]
#[command(after_help = examples::COMPLETIONS)]
pub(super) struct Arguments {
    /// The shell
    shell: Shell,
}

/// Runs the command.
pub(super) fn run(
    arguments: &Arguments,
    mut command: Command,
    output: &mut impl Write,
) -> Result<(), Failure> {
    // The script is generated in memory, where writing cannot fail; standard output can be closed.
    let mut script = Vec::new();
    generate(arguments.shell, &mut command, "allanite", &mut script);
    output
        .write_all(&script)
        .map_err(|error| Failure::standard_output(&error))
}
