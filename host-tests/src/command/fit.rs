//! `fit`: from curves to coefficients.

use super::{
    examples, fit_json, fit_summary, fit_table,
    input::{self, LogArguments},
    many::{self, FilesArguments, Findings},
};
use crate::{curve_file::AxisCurve, failure::Failure, log::OCTAVES};
use allanite::{
    Curve, Model,
    fit::{Fit, Method, Options},
};
use clap::{Args, ValueEnum};
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
    /// How octaves are weighted
    #[arg(long, default_value = "covariance")]
    method: MethodName,
    #[command(flatten)]
    about_log: LogArguments,
}

/// The weights by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum MethodName {
    /// Unweighted least squares, unconstrained: the baseline
    Ordinary,
    /// Each octave by its relative accuracy times its value, unconstrained
    RelativeAccuracy,
    /// Each octave by its number of clusters, unconstrained: for comparison only
    ClusterCount,
    /// The covariance of the curve, coefficients not negative
    Covariance,
}

impl MethodName {
    const fn method(self) -> Method {
        match self {
            Self::Ordinary => Method::Ordinary,
            Self::RelativeAccuracy => Method::RelativeAccuracy,
            Self::ClusterCount => Method::ClusterCount,
            Self::Covariance => Method::Covariance,
        }
    }

    /// The method as the option spells it.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::RelativeAccuracy => "relative-accuracy",
            Self::ClusterCount => "cluster-count",
            Self::Covariance => "covariance",
        }
    }
}

/// One axis with its fit.
pub(super) struct Fitted {
    pub(super) axis: AxisCurve,
    pub(super) curve: Curve<OCTAVES>,
    pub(super) method: MethodName,
    pub(super) fit: Fit,
}

impl Fitted {
    /// Fits the five terms to an axis of a file.
    pub(super) fn new(path: &Path, axis: AxisCurve, method: MethodName) -> Result<Self, Failure> {
        let settings = Options {
            method: method.method(),
            ..Options::default()
        };
        let fitted = axis.curve().and_then(|curve| {
            let fit = allanite::fit::fit(&curve, &Model::ieee_952(), settings)?;
            Ok((curve, fit))
        });
        match fitted {
            Ok((curve, fit)) => Ok(Self {
                axis,
                curve,
                method,
                fit,
            }),
            Err(error) => Err(input::library_failure(path, &axis.axis, error)),
        }
    }
}

impl Findings for Vec<Fitted> {
    type Document<'a> = fit_json::Document<'a>;

    fn document(&self) -> Self::Document<'_> {
        fit_json::document(self)
    }

    fn print(&self, output: &mut impl Write) -> io::Result<()> {
        fit_table::print(self, output)
    }

    fn print_many(found: &[(&Path, Self)], output: &mut impl Write) -> io::Result<()> {
        fit_summary::print(found, output)
    }
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let work = |path: &Path| {
        let axes = input::read(path, &arguments.about_log)?.into_iter();
        axes.map(|axis| Fitted::new(path, axis, arguments.method))
            .collect::<Result<Vec<_>, _>>()
    };
    many::run(&arguments.files, work, output)
}
