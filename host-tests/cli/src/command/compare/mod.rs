//! `compare`: shows octave by octave where a model fails.

pub(super) mod model;

use crate::command::{
    examples,
    input::{
        many::{self, FilesArguments, Findings},
        record::{self, LogArguments},
    },
};
use allanite_host::{
    compare::{compared::Compared, json, text, visible::check_visible},
    curve_file::AxisCurve,
};
use allanite_log::failure::{Failure, Place};
use clap::Args;
use model::ModelArguments;
use std::{
    io::{self, Write},
    path::Path,
};

/// Compare a record octave by octave with the five IEEE-952 terms and with effects of your choice
///
/// Differences of the Allan deviation and of the power spectral density (PSD) are in standard errors.
#[derive(Debug, Args)]
#[command(after_help = examples::COMPARE)]
pub(super) struct Arguments {
    #[command(flatten)]
    files: FilesArguments,
    #[command(flatten)]
    model: ModelArguments,
    /// Hold out this last share of the log: fit the model to the rest and compare it with this part
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    hold_out: Option<f64>,
    #[command(flatten)]
    about_log: LogArguments,
}

impl Findings for Vec<Compared> {
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
    let model = arguments.model.model()?;
    if let Some(share) = arguments.hold_out
        && !(share > 0.0 && share < 1.0)
    {
        return Err(Failure::option(
            format!("--hold-out {share} is impossible"),
            "give a share between 0 and 1, such as 0.5",
        ));
    }
    let work = |path: &Path| {
        let (fitted, held_out) = read(path, arguments)?;
        let mut held_out = held_out.into_iter();
        let mut compared = Vec::new();
        for axis in fitted {
            let name = axis.axis.clone();
            let fail = |error| record::library_failure(path, &name, error);
            let curve = axis.curve().map_err(fail)?;
            check_visible(&model, &curve)?;
            compared.push(Compared::new(axis, &model, held_out.next()).map_err(fail)?);
        }
        Ok(compared)
    };
    many::run(&arguments.files, work, output)
}

/// The curves to fit, and the curves of the held-out part, if there is one.
fn read(path: &Path, arguments: &Arguments) -> Result<(Vec<AxisCurve>, Vec<AxisCurve>), Failure> {
    let Some(share) = arguments.hold_out else {
        let axes = record::read(path, &arguments.about_log)?;
        return Ok((axes, Vec::new()));
    };
    if record::is_curve(path) {
        return Err(Place::file(path).failure(
            "a curve file cannot be divided into a part to fit and a part to hold out",
            "give the log, or drop --hold-out",
        ));
    }
    record::measure_in_two(path, &arguments.about_log, share)
}
