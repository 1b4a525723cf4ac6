//! `diagnose`: finds the effects of a curve that the five terms do not describe.

pub(super) mod arguments;

use crate::command::{
    examples,
    input::many::{self, FilesArguments, Findings},
};
use allanite_host::diagnose::{diagnosed::Diagnosed, json, text};
use allanite_log::failure::Failure;
use arguments::DiagnosisSettings;
use clap::Args;
use std::{
    io::{self, Write},
    path::Path,
};

/// Find, one by one, the physical effects that are missing from the five IEEE-952 terms
///
/// The Allan deviation and the power spectral density (PSD) of a record are searched for lines, resonances, filters (low
/// pass, notch, and the CIC or boxcar that is called decimation filter here) and correlated noise. Saturation, motion and
/// faults of the logger are reported first.
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
