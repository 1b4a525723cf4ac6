//! The commands of `allanite`.

#[cfg(not(target_family = "wasm"))]
mod certified;
#[cfg(not(target_family = "wasm"))]
mod certify;
mod compare;
#[cfg(not(target_family = "wasm"))]
mod completions;
#[cfg(not(target_family = "wasm"))]
mod decode;
pub(crate) mod diagnose;
mod examples;
pub mod explore;
mod export;
mod fit;
mod input;
mod known_filter;
#[cfg(not(target_family = "wasm"))]
mod lot;
mod measure;
mod merge;
mod output;
mod plot;
mod report;
#[cfg(not(target_family = "wasm"))]
mod schema;
#[cfg(not(target_family = "wasm"))]
mod simulate;
pub mod usage;
mod watch;
#[cfg(not(target_family = "wasm"))]
mod workstation;

use allanite_log::failure::Failure;
use clap::{Parser, Subcommand};
use input::standard_input;
use output::{progress, temporary, wrapped::Wrapped};
use std::io::{self, BufWriter, Write};

/// Noise coefficients of gyros and accelerometers, from recorded logs or from curves.
///
/// Exit status: 0 on success; 2 for bad input, with one line on standard error that names the file, the
/// row and the remedy. If only some of several files are bad, the others are processed and printed, and
/// each bad file has its own line. With `fit --limit`, 1 if a coefficient exceeds its limit, and 3 if one is not known to
/// keep it.
///
/// The environment variable NO_COLOR turns colours off.
#[derive(Debug, Parser)]
#[command(name = "allanite", version, max_term_width = 100)]
pub struct CommandLine {
    /// Print only results and failures, without progress and notes
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    // A page has no use for the next two either, which stand first all the same.
    #[cfg(not(target_family = "wasm"))]
    Measure(measure::Arguments),
    #[cfg(not(target_family = "wasm"))]
    Merge(merge::Arguments),
    Fit(fit::Arguments),
    Export(export::Arguments),
    Compare(compare::Arguments),
    Diagnose(diagnose::Arguments),
    Explore(explore::Arguments),
    #[command(hide = true)]
    Ask(explore::ask::Arguments),
    Watch(watch::Arguments),
    Report(report::Arguments),
    Plot(plot::Arguments),
    /// What a page has no use for.
    #[cfg(not(target_family = "wasm"))]
    #[command(flatten)]
    Workstation(workstation::Command),
}

impl CommandLine {
    /// Runs the command; results go to standard output, everything else to standard error.
    ///
    /// # Errors
    /// For bad input of any kind, and when standard output cannot be written.
    pub fn run(&self) -> Result<(), Failure> {
        if self.quiet {
            progress::be_quiet();
        }
        // A recording that is interrupted is saved instead.
        if !matches!(self.command, Command::Watch(_)) {
            temporary::remove_when_interrupted();
        }
        let done = self.run_command();
        standard_input::forget();
        done
    }

    fn run_command(&self) -> Result<(), Failure> {
        let mut output = Wrapped::new(BufWriter::new(io::stdout().lock()));
        match &self.command {
            #[cfg(not(target_family = "wasm"))]
            Command::Measure(arguments) => measure::run(arguments, &mut output),
            #[cfg(not(target_family = "wasm"))]
            Command::Merge(arguments) => merge::run(arguments, &mut output),
            Command::Fit(arguments) => fit::run(arguments, &mut output),
            Command::Export(arguments) => export::run(arguments, &mut output),
            Command::Compare(arguments) => compare::run(arguments, &mut output),
            Command::Diagnose(arguments) => diagnose::run(arguments, &mut output),
            Command::Explore(arguments) => explore::run(arguments, &mut output),
            Command::Ask(arguments) => explore::ask::run(arguments, &mut output),
            Command::Watch(arguments) => watch::run(arguments, &mut output),
            Command::Report(arguments) => report::run(arguments, &mut output),
            Command::Plot(arguments) => plot::run(arguments, &mut output),
            #[cfg(not(target_family = "wasm"))]
            Command::Workstation(command) => {
                command.run(<Self as clap::CommandFactory>::command, &mut output)
            }
        }?;
        output
            .flush()
            .map_err(|error| Failure::standard_output(&error))
    }
}
