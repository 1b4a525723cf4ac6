//! Logs and curves as inputs of commands.

use crate::{
    command::output::progress,
    curve_file::{AxisCurve, CurveFile},
    failure::{Failure, Place, one_line},
    log::{self, ColumnChoice, CovariateChoice, Evidence, Log, TimeUnit},
    unit::{Sensor, Unit},
};
use clap::Args;
use std::path::Path;

/// What to know about a log.
#[derive(Debug, Args)]
pub(crate) struct LogArguments {
    /// Samples per second [default: the log's own comment `# rate_hz=…`, else by its time stamps]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    rate: Option<f64>,
    /// Units per count [default: the log's own comment `# scale=…`, else 1]
    #[arg(long, value_name = "RATE_PER_COUNT", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// Unit of the scaled values [default: the log's own comment `# unit=…`, else by the names of
    /// the columns, else deg/s or m/s^2]
    #[arg(long)]
    unit: Option<Unit>,
    /// Columns to take as axes, by name or by number from 1, such as `gyro_x,gyro_y` or `gx=2,gy=3`
    /// [default: those named like a gyro's axes, else an accelerometer's, else all numbers that are
    /// no time or temperature]
    #[arg(long, value_delimiter = ',', value_name = "[AXIS=]COLUMN,…")]
    columns: Option<Vec<ColumnChoice>>,
    /// The sensor whose axes to take [default: that of --unit, else a gyro if there is one]
    #[arg(long)]
    sensor: Option<Sensor>,
    /// Column of time stamps, by name or by number from 1 [default: the one named like a time; none
    /// if the rate is given]
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// Unit of the time stamps [default: by the column's name, else the one that gives a plausible
    /// rate]
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<TimeUnit>,
    /// Topic of a bag [default: that of the only IMU], or of a ULog, such as `sensor_gyro:0`
    /// [default: the one with the most samples]
    #[arg(long)]
    topic: Option<String>,
}

impl LogArguments {
    fn options(&self) -> log::Options {
        log::Options {
            rate_hz: self.rate,
            scale: self.scale,
            unit: self.unit,
            columns: self.columns.clone(),
            sensor: self.sensor,
            time: self.time.clone(),
            time_unit: self.time_unit,
            topic: self.topic.clone(),
        }
    }
}

/// Measures the curves of a log.
pub(crate) fn measure(path: &Path, arguments: &LogArguments) -> Result<Vec<AxisCurve>, Failure> {
    let bar = progress::reading(path);
    let log = log::read(path, &arguments.options(), &bar);
    bar.finish_and_clear();
    let log = log?;
    note(path, &log);
    curves(&log)
}

/// The curves of a log with all that it tells beside them, or those of a curve file, which tells no
/// more.
pub(crate) fn read_with_evidence(
    path: &Path,
    arguments: &LogArguments,
    covariates: &[CovariateChoice],
) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    if is_curve(path) {
        if !covariates.is_empty() {
            return Err(Place::file(path).failure(
                "a curve knows no covariates",
                "give the log, or leave --covariates",
            ));
        }
        let axes = read(path, arguments)?.into_iter();
        return Ok(axes.map(|axis| (axis, Evidence::default())).collect());
    }
    let bar = progress::reading(path);
    let log = log::read_with_evidence(path, &arguments.options(), covariates, &bar);
    bar.finish_and_clear();
    let log = log?;
    note(path, &log);
    let evidence = log.axes.iter().map(|axis| axis.evidence.clone());
    let evidence = evidence.map(Option::unwrap_or_default).collect::<Vec<_>>();
    Ok(curves(&log)?.into_iter().zip(evidence).collect())
}

/// Measures the curves of a log's first part and those of the rest, which is this share of it.
pub(crate) fn measure_in_two(
    path: &Path,
    arguments: &LogArguments,
    share: f64,
) -> Result<(Vec<AxisCurve>, Vec<AxisCurve>), Failure> {
    let bar = progress::reading(path);
    let logs = log::read_in_two(path, &arguments.options(), share, &bar);
    bar.finish_and_clear();
    let (first, rest) = logs?;
    note(path, &first);
    Ok((curves(&first)?, curves(&rest)?))
}

fn note(path: &Path, log: &Log) {
    if progress::is_quiet() {
        return;
    }
    for note in &log.notes {
        eprintln!("allanite: {}{}", Place::file(path), one_line(note));
    }
}

fn curves(log: &Log) -> Result<Vec<AxisCurve>, Failure> {
    log.axes
        .iter()
        .map(|axis| AxisCurve::of(axis, log.rate_hz, log.unit))
        .collect()
}

/// The curves of a log, or of a curve file by its extension `.json`.
pub(crate) fn read(path: &Path, arguments: &LogArguments) -> Result<Vec<AxisCurve>, Failure> {
    if !is_curve(path) {
        return measure(path, arguments);
    }
    if arguments.options() != log::Options::default() {
        return Err(Place::file(path).failure(
            "a curve knows its rate, scale, unit and axes",
            "leave options about logs to measure",
        ));
    }
    Ok(CurveFile::read(path)?.axes)
}

/// Whether the extension is that of a curve file.
pub(crate) fn is_curve(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// What the library has against an axis; its errors read `what: remedy`.
pub(crate) fn library_failure(path: &Path, axis: &str, error: allanite::Error) -> Failure {
    let text = error.to_string();
    let (what, remedy) = text.rsplit_once(": ").unwrap_or((&text, "record longer"));
    Place::file(path).failure(format!("axis {axis}: {what}"), remedy)
}
