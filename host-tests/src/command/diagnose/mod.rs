//! `diagnose`: which effects a curve has that the five terms lack.

pub(super) mod diagnosed;
pub(super) mod json;
pub(super) mod text;
pub(super) mod words;

use crate::{
    command::{
        examples,
        input::many::{self, FilesArguments, Findings},
    },
    failure::Failure,
};
use clap::Args;
use diagnosed::{Diagnosed, DiagnosisSettings};
use std::{
    io::{self, Write},
    path::Path,
};

/// Find the physical effects that the five IEEE-952 terms lack, one after the other
#[derive(Debug, Args)]
#[command(after_help = examples::DIAGNOSE)]
pub(super) struct Arguments {
    #[command(flatten)]
    files: FilesArguments,
    #[command(flatten)]
    settings: DiagnosisSettings,
}

impl Findings for Vec<Diagnosed> {
    type Document<'a> = json::Document<'a>;

    fn document(&self) -> Self::Document<'_> {
        json::document(self)
    }

    fn print(&self, output: &mut impl Write) -> io::Result<()> {
        text::print(self, output)
    }
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let work = |path: &Path| arguments.settings.diagnosed(path);
    many::run(&arguments.files, work, output)
}
