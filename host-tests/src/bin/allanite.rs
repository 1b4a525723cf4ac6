//! The command line of allanite.

use clap::Parser;
use host_tests::{
    command::CommandLine,
    failure::{self, Failure},
};
use std::process::ExitCode;

fn main() -> ExitCode {
    match CommandLine::parse().run() {
        Ok(()) | Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(failure) => {
            failure::report(failure);
            ExitCode::from(2)
        }
    }
}
