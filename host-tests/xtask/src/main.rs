//! The tasks of the project: see `cargo xtask --help`.

use clap::Parser;
use std::process::ExitCode;
use xtask::CommandLine;

fn main() -> ExitCode {
    match CommandLine::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}
