//! The tasks of the project: see `cargo xtask --help`.

use clap::Parser;
use host_tests::xtask::CommandLine;
use std::process::ExitCode;

fn main() -> ExitCode {
    match CommandLine::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}
