//! The command line of allanite.

use allanite_cli::command::{CommandLine, usage};
use allanite_log::failure::{self, Failure};
use clap::Parser;
use std::{
    io::{self, Write as _},
    process::ExitCode,
};

fn main() -> ExitCode {
    #[cfg(feature = "tables")]
    if let Some(status) = allanite_log::answer_about_table() {
        return status;
    }
    let line = match CommandLine::try_parse() {
        Ok(line) => line,
        Err(error) if error.use_stderr() => {
            failure::report(usage::failure(&error));
            return ExitCode::from(2);
        }
        // This is the help or the version.
        Err(error) => {
            let printed = error.print().and_then(|()| io::stdout().flush());
            return match printed.map_err(|error| Failure::standard_output(&error)) {
                Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
                Err(failure) => {
                    failure::report(failure);
                    ExitCode::from(2)
                }
            };
        }
    };
    match line.run() {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Limit { is_exceeded: true }) => ExitCode::from(1),
        Err(Failure::Limit { is_exceeded: false }) => ExitCode::from(3),
        Err(failure) => {
            failure::report(failure);
            ExitCode::from(2)
        }
    }
}
