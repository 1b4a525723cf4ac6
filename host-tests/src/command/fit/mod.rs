//! `fit`: computes the coefficients of curves.

pub(super) mod fitted;
pub(super) mod json;
mod summary;
pub(super) mod table;

use crate::{
    command::{
        examples,
        input::{
            many::{self, FilesArguments, Findings},
            record::{self, LogArguments},
        },
        known_filter::KnownFilter,
    },
    failure::Failure,
};
use clap::Args;
use fitted::{Fitted, MethodName};
use std::{
    io::{self, Write},
    path::Path,
};

/// Fit the five IEEE-952 coefficients to a log or a curve
#[derive(Debug, Args)]
#[command(after_help = examples::FIT)]
pub(super) struct Arguments {
    #[command(flatten)]
    files: FilesArguments,
    /// Method that weights the octaves
    #[arg(long, default_value = "covariance")]
    method: MethodName,
    #[command(flatten)]
    filter: KnownFilter,
    #[command(flatten)]
    about_log: LogArguments,
}

impl Findings for Vec<Fitted> {
    type Document<'a> = json::Document<'a>;

    fn document(&self) -> Self::Document<'_> {
        json::document(self)
    }

    fn print(&self, output: &mut impl Write) -> io::Result<()> {
        table::print(self, output)
    }

    fn print_many(found: &[(&Path, Self)], output: &mut impl Write) -> io::Result<()> {
        summary::print(found, output)
    }
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let model = arguments.filter.model()?;
    let work = |path: &Path| {
        let axes = record::read(path, &arguments.about_log)?.into_iter();
        axes.map(|axis| Fitted::new(path, axis, &model, arguments.method))
            .collect::<Result<Vec<_>, _>>()
    };
    many::run(&arguments.files, work, output)
}
