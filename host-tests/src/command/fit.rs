//! `fit`: from curves to coefficients.

use super::{
    fit_json, fit_table,
    input::{self, LogArguments},
};
use crate::{curve_file::AxisCurve, failure::Failure, log::OCTAVES};
use allanite::{Curve, Fit, Method, Model, Settings};
use clap::{Args, ValueEnum};
use std::{io::Write, path::PathBuf};

/// Fit the five IEEE-952 coefficients to a log or a curve
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A log (.csv, .csv.gz, .npy, .mcap, .ulg), or a curve file (.json) that `measure` wrote
    input: PathBuf,
    /// How octaves are weighted
    #[arg(long, default_value = "covariance")]
    method: MethodName,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
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

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let model = Model::ieee_952();
    let fit_axis = |axis: AxisCurve| {
        let settings = Settings {
            method: arguments.method.method(),
            ..Settings::default()
        };
        let fitted = axis.curve().and_then(|curve| {
            let fit = allanite::fit(&curve, &model, settings)?;
            Ok((curve, fit))
        });
        match fitted {
            Ok((curve, fit)) => Ok(Fitted {
                axis,
                curve,
                method: arguments.method,
                fit,
            }),
            Err(error) => Err(input::library_failure(&arguments.input, &axis.axis, error)),
        }
    };
    let axes = input::read(&arguments.input, &arguments.about_log)?;
    let fitted = axes
        .into_iter()
        .map(fit_axis)
        .collect::<Result<Vec<_>, _>>()?;
    let printed = if arguments.json {
        fit_json::print(&fitted, output)
    } else {
        fit_table::print(&fitted, output)
    };
    printed.map_err(|error| Failure::standard_output(&error))
}
