//! `fit`: computes the coefficients of curves.

mod summary;

use crate::command::{
    examples,
    input::{
        many::{self, FilesArguments, Findings},
        record::{self, CovariateArguments, LogArguments},
    },
    known_filter::KnownFilter,
};
use allanite_host::{
    fit::{
        fitted::{Fitted, MethodName, Settings, fitted},
        json,
        judged::Worst,
        table,
    },
    limit::LimitArgument,
};
use allanite_log::failure::Failure;
use clap::Args;
use std::{
    io::{self, Write},
    path::Path,
};

/// Fit the five IEEE-952 coefficients to a log or a curve
///
/// In terms of a data sheet, angle random walk N is ARW, or rate noise density. Of an accelerometer, it is velocity
/// random walk, VRW. In-run bias stability is the minimum of the Allan deviation, which is 0.664 B where bias instability
/// dominates it. The errors of the octaves include their overlap, for which others use equivalent degrees of freedom, EDF.
#[derive(Debug, Args)]
#[command(after_help = examples::FIT)]
pub(super) struct Arguments {
    #[command(flatten)]
    files: FilesArguments,
    /// Method that weights the octaves
    #[arg(long, default_value = "covariance")]
    method: MethodName,
    /// The largest value that a coefficient may have, by its symbol or its name, in the unit of the input or in the customary
    /// one: N=0.005, N=0.3°/√h, B=10deg/h; or the mean rate, of either sign: bias=0.5. May be given several times. Exit status:
    /// 1 if a limit is exceeded, 3 if one is not known to be kept
    #[arg(long = "limit", value_name = "EFFECT=VALUE")]
    limits: Vec<String>,
    #[command(flatten)]
    filter: KnownFilter,
    #[command(flatten)]
    covariates: CovariateArguments,
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
    let limits = LimitArgument::all(&arguments.limits)?;
    let worst = Worst::default();
    let work = |path: &Path| {
        let (about_log, covariates) = (&arguments.about_log, &arguments.covariates);
        let axes = record::read_with_evidence(path, about_log, covariates)?;
        let settings = Settings {
            model: &model,
            method: arguments.method,
            limits: &limits,
        };
        let fitted = fitted(path, axes, &settings)?;
        fitted.iter().for_each(|one| worst.note(&one.limits));
        Ok(fitted)
    };
    many::run(&arguments.files, work, output)?;
    worst.end()
}
