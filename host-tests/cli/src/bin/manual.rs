//! Writes the pages of `man` of the program `allanite` and of each of its commands to a folder, for `cargo xtask dist`.

use allanite_cli::command::CommandLine;
use clap::CommandFactory as _;
use std::{env, io, process::ExitCode};

fn main() -> ExitCode {
    let Some(folder) = env::args_os().nth(1) else {
        eprintln!("manual: name the folder to write to");
        return ExitCode::from(2);
    };
    let written: io::Result<()> = clap_mangen::generate_to(CommandLine::command(), &folder);
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("manual: {}: {error}", folder.display());
            ExitCode::from(2)
        }
    }
}
