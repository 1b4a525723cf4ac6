//! `measure`: from a log to its curves.

use super::{
    input::{self, LogArguments},
    number::number,
    output_file::OutputFile,
};
use crate::{
    curve_file::{AxisCurve, CurveFile},
    failure::{Failure, Place},
};
use clap::Args;
use std::{
    io::{self, Write},
    path::PathBuf,
};

/// Measure the Allan curves of a log
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// A recorded log: .csv, .csv.gz, .npy, .mcap or .ulg
    log: PathBuf,
    /// The curve file to write: .json
    #[arg(long, short, value_name = "CURVE.json")]
    output: PathBuf,
    #[command(flatten)]
    about_log: LogArguments,
    /// Where the record comes from, kept in the curve file
    #[arg(long, value_name = "TEXT")]
    source: Option<String>,
    /// The record's licence, kept in the curve file
    #[arg(long, value_name = "TEXT")]
    licence: Option<String>,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    if !input::is_curve(&arguments.output) {
        return Err(Place::file(&arguments.output)
            .failure("a curve file's extension is .json", "name the output so"));
    }
    // First, so that a place that cannot be written to costs no measurement.
    let mut file = OutputFile::create(&arguments.output)?;
    let mut curves = input::measure(&arguments.log, &arguments.about_log)?;
    for curve in &mut curves {
        curve.source.clone_from(&arguments.source);
        curve.licence.clone_from(&arguments.licence);
    }
    let curves = CurveFile::new(curves);
    let fail = |error: io::Error| Place::file(&arguments.output).io(&error);
    let json = curves.to_json().map_err(|error| fail(error.into()))?;
    file.write_all(json.as_bytes()).map_err(fail)?;
    file.commit()?;
    summarize(&curves.axes, output).map_err(|error| Failure::standard_output(&error))
}

fn summarize(curves: &[AxisCurve], output: &mut impl Write) -> io::Result<()> {
    for curve in curves {
        let shortest = curve.octaves.first();
        let lowest = curve
            .octaves
            .iter()
            .min_by(|a, b| a.variance.total_cmp(&b.variance));
        write!(
            output,
            "{}: {} samples at {} Hz, {} octaves",
            curve.axis,
            curve.samples,
            curve.rate_hz,
            curve.octaves.len()
        )?;
        if let (Some(shortest), Some(lowest)) = (shortest, lowest) {
            write!(
                output,
                "; deviation {} {unit} at {} s, lowest {} {unit} at {} s",
                number(shortest.variance.sqrt()),
                number(shortest.tau_s),
                number(lowest.variance.sqrt()),
                number(lowest.tau_s),
                unit = curve.unit,
            )?;
        }
        writeln!(output)?;
    }
    Ok(())
}
