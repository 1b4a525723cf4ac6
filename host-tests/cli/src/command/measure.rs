//! `measure`: computes the Allan curves of logs.

use crate::command::{
    examples,
    input::{
        many,
        record::{self, CovariateArguments, LogArguments},
    },
    output::{file::OutputFile, places::places, progress},
};
use allanite_host::{
    curve_file::{AxisCurve, CurveFile},
    disturbance::invalid,
    number::number,
    verdict::INVALID_CURVE,
};
use allanite_log::{
    Evidence,
    failure::{Failure, Place, one_line, report},
};
use clap::Args;
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Measure the Allan curves of logs
///
/// A curve is the overlapping Allan variance (NIST SP 1065), with a quarter of the overlap, at averaging times of 2^k
/// samples. The file also has the one-sided power spectral density (PSD, Welch), the block history, and the number of
/// samples that gap filling replaced.
#[derive(Debug, Args)]
#[command(after_help = examples::MEASURE)]
pub(super) struct Arguments {
    /// Recorded logs: text, .npy, .ulg, or bags of ROS
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// The curve file to write, .json, or an existing folder that gets one file for each log
    #[arg(long, short, value_name = "CURVE.json")]
    output: PathBuf,
    #[command(flatten)]
    about_log: LogArguments,
    /// The log is a part of a longer record, and begins with this sample of it, counted from 0: merge rejoins parts that
    /// touch, and loses nothing between them
    #[arg(long, value_name = "FIRST_SAMPLE")]
    part: Option<u64>,
    /// Where the record comes from; the curve file keeps this text
    #[arg(long, value_name = "TEXT")]
    source: Option<String>,
    /// The record's licence; the curve file keeps this text
    #[arg(long, value_name = "TEXT")]
    licence: Option<String>,
}

/// Runs the command.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    if !arguments.output.is_dir() && arguments.logs.len() < 2 {
        check_name(&arguments.output)?;
    }
    if arguments.part.is_some() && arguments.logs.len() > 1 {
        return Err(Failure::option(
            "--part tells where one log begins, and there are several",
            "measure the parts one by one",
        ));
    }
    let places = places(&arguments.logs, &arguments.output, "json", "measure")?;
    let several = places.len() > 1;
    let work = |log: &Path| {
        let place = places.get(log).unwrap_or(&arguments.output);
        // The file comes first, so that an output that cannot be written is refused before the
        // measurement.
        let mut file = OutputFile::create(place, arguments.logs.iter().map(PathBuf::as_path))?;
        let mut curves = match arguments.part {
            Some(first) => record::measure_part(log, &arguments.about_log, first)?,
            None => measured(log, &arguments.about_log)?,
        };
        for curve in &mut curves {
            curve.source.clone_from(&arguments.source);
            curve.licence.clone_from(&arguments.licence);
        }
        write(&mut file, place, &CurveFile::new(curves.clone()))?;
        file.commit()?;
        Ok(curves)
    };
    let mut failures = Vec::new();
    many::each(&arguments.logs, work, |log, measured| {
        match measured {
            Ok(curves) => {
                let name = several.then(|| many::shown(log));
                let printed = summarize(name.as_deref(), &curves, output);
                printed.map_err(|error| Failure::standard_output(&error))?;
            }
            Err(failure) => failures.push(failure),
        }
        Ok(())
    })?;
    let flushed = output.flush();
    flushed.map_err(|error| Failure::standard_output(&error))?;
    many::failed(failures)
}

/// Measures the curves of a log. A note tells of curves that are not valid.
fn measured(log: &Path, about_log: &LogArguments) -> Result<Vec<AxisCurve>, Failure> {
    let axes = record::read_with_evidence(log, about_log, &CovariateArguments::NONE)?;
    let curve = |(curve, evidence): (AxisCurve, Evidence)| {
        if let Some(reason) = evidence.invalid.filter(|_| !progress::is_quiet()) {
            let disturbance = evidence.disturbance.as_ref();
            let about = (curve.axis.as_str(), curve.rate_hz, curve.unit);
            let reason = invalid(&reason, disturbance, about);
            let note = format!("axis {}: {INVALID_CURVE}: {reason}", curve.axis);
            report(format_args!("{}{}", Place::file(log), one_line(&note)));
        }
        curve
    };
    Ok(axes.into_iter().map(curve).collect())
}

/// Refuses the path of a curve file that the other commands would take for a log.
pub(super) fn check_name(output: &Path) -> Result<(), Failure> {
    if record::is_curve(output) {
        return Ok(());
    }
    Err(Place::file(output).failure("a curve file must end in .json", "rename the output"))
}

/// Writes a curve file.
pub(super) fn write(
    file: &mut OutputFile,
    place: &Path,
    curves: &CurveFile,
) -> Result<(), Failure> {
    let fail = |error: io::Error| Place::file(place).io(&error);
    let json = curves.to_json().map_err(|error| fail(error.into()))?;
    file.write_all(json.as_bytes()).map_err(fail)
}

/// Prints one line for each axis; the name of the log comes first if there are several logs.
pub(super) fn summarize(
    log: Option<&str>,
    curves: &[AxisCurve],
    output: &mut impl Write,
) -> io::Result<()> {
    for curve in curves {
        if let Some(log) = log {
            write!(output, "{log}: ")?;
        }
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
