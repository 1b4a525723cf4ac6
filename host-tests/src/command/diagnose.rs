//! `diagnose`: which effects a curve has that the five terms lack.

use super::{diagnose_json, diagnose_text, diagnosed::DiagnosisArguments};
use crate::failure::Failure;
use clap::Args;
use std::io::Write;

/// Find the physical effects that the five IEEE-952 terms lack, one after the other
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    diagnosis: DiagnosisArguments,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let diagnosed = arguments.diagnosis.diagnosed()?;
    let printed = if arguments.json {
        diagnose_json::print(&diagnosed, output)
    } else {
        diagnose_text::print(&diagnosed, output)
    };
    printed.map_err(|error| Failure::standard_output(&error))
}
