//! Logs and curve files as inputs of commands.

use crate::command::{input::standard_input, output::progress};
pub(crate) use allanite_host::record::{is_curve, library_failure};
use allanite_host::{
    curve_file::AxisCurve,
    record::{curves, curves_of_file, curves_without_evidence, with_evidence},
};
use allanite_log::{
    self as log, ColumnChoice, CovariateChoice, Covariates, Cuts, Evidence, Log, Moment, Repeats,
    RowChoice, TimeRange, TimeUnit,
    failure::{Failure, Place, one_line, report},
    unit::{Sensor, Unit},
};
use clap::Args;
use std::path::Path;

/// Options that tell how to read a log.
#[derive(Clone, Debug, Args)]
pub(crate) struct LogArguments {
    /// Samples per second [default: from the log's comment `# rate_hz=…`, else from its time stamps]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    rate: Option<f64>,
    /// Units per count [default: from the log's comment `# scale=…`, else 1]
    #[arg(long, value_name = "RATE_PER_COUNT", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// Unit of the scaled values [default: from the log's comment `# unit=…`, else from the
    /// names of the columns, else deg/s or m/s^2]
    #[arg(long)]
    unit: Option<Unit>,
    /// Columns to take as axes, by name or by number from 1, such as `gyro_x,gyro_y` or `gx=2,gy=3`
    /// [default: those with the names of a gyro's axes, else of an accelerometer's axes, else all
    /// columns of numbers except time and temperature]
    #[arg(long, value_delimiter = ',', value_name = "[AXIS=]COLUMN,…")]
    columns: Option<Vec<ColumnChoice>>,
    /// The sensor whose axes to take [default: the sensor of --unit, else the gyro if there is one]
    #[arg(long)]
    sensor: Option<Sensor>,
    /// Column of time stamps, by name or by number from 1 [default: the column with the name of a
    /// time, or none if --rate is given]
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// Unit of the time stamps [default: from the column's name, else the only unit that gives a
    /// plausible rate]
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<TimeUnit>,
    /// Topic of a bag [default: the topic of the only IMU] or of a ULog, such as `sensor_gyro:0`
    /// [default: the topic with the most samples]
    #[arg(long)]
    topic: Option<String>,
    /// Read only the rows that have this value in this column, such as `SensorId=1`, in a log with the rows of several sensors
    #[arg(long, value_name = "COLUMN=VALUE")]
    rows: Option<RowChoice>,
    /// What to do with samples that the logger repeated or interpolated, where that is certain
    #[arg(long, value_name = "CHOICE", default_value = "drop")]
    repeats: Repeats,
    /// Leave out what lies before this time from the log's first row, or with a minus sign from its last row: `10s`,
    /// `2.5min`, `1h`
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    from: Option<Moment>,
    /// Leave out what lies behind this time from the log's first row, or with a minus sign from its last row: `-12s`
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    to: Option<Moment>,
    /// Leave out a stretch of the log, such as `311s..313s`, which becomes a gap; may be given several times
    #[arg(long, value_name = "FROM..TO", allow_hyphen_values = true)]
    drop: Vec<TimeRange>,
}

impl LogArguments {
    /// The same options for another sensor of the same log.
    ///
    /// # Errors
    /// When an option describes the columns of one sensor.
    pub(crate) fn of_sensor(&self, sensor: Sensor) -> Result<Self, Failure> {
        let of_one_sensor = [
            ("--scale", self.scale.is_some()),
            ("--unit", self.unit.is_some()),
            ("--columns", self.columns.is_some()),
            ("--sensor", self.sensor.is_some()),
        ];
        if let Some((option, _)) = of_one_sensor.into_iter().find(|(_, given)| *given) {
            return Err(Failure::option(
                format!("{option} describes one sensor, and the log is read for two"),
                "name columns and units in the log's header instead",
            ));
        }
        Ok(Self {
            sensor: Some(sensor),
            ..self.clone()
        })
    }

    /// The options of the reader of logs.
    pub(crate) fn options(&self) -> log::Options {
        log::Options {
            rate_hz: self.rate,
            scale: self.scale,
            unit: self.unit,
            columns: self.columns.clone(),
            sensor: self.sensor,
            time: self.time.clone(),
            time_unit: self.time_unit,
            topic: self.topic.clone(),
            rows: self.rows.clone(),
            repeats: self.repeats,
            cuts: Cuts {
                from: self.from.clone(),
                to: self.to.clone(),
                drop: self.drop.clone(),
            },
        }
    }
}

/// Options that tell which covariates to try.
#[derive(Debug, Args)]
pub(crate) struct CovariateArguments {
    /// Columns of the log, or their rates of change, that the gyro's rate may depend on, such as
    /// `supply_V,temp_C,rate(temp_C)` [default: the temperatures by their names, and their rates of change]
    #[arg(long, value_delimiter = ',', value_name = "COLUMN,…")]
    covariates: Vec<CovariateChoice>,
    /// Do not try the temperatures that the log has
    #[arg(long, conflicts_with = "covariates")]
    no_covariates: bool,
}

impl CovariateArguments {
    /// No covariates.
    pub(crate) const NONE: Self = Self {
        covariates: Vec::new(),
        no_covariates: true,
    };

    /// The covariates that are tried.
    pub(crate) fn tried(&self) -> Covariates {
        if self.covariates.is_empty() && !self.no_covariates {
            Covariates::Found
        } else {
            Covariates::Chosen(self.covariates.clone())
        }
    }
}

/// Measures the curves of a log.
pub(crate) fn measure(path: &Path, arguments: &LogArguments) -> Result<Vec<AxisCurve>, Failure> {
    let log = reading(path, |file, bar| log::read(file, &arguments.options(), bar))?;
    note(path, &log);
    curves(&log)
}

/// Measures the curves of a log that is a part of a longer record and begins with its sample `first`.
pub(crate) fn measure_part(
    path: &Path,
    arguments: &LogArguments,
    first: u64,
) -> Result<Vec<AxisCurve>, Failure> {
    let options = arguments.options();
    let read =
        |file: &Path, bar: &indicatif::ProgressBar| log::read_part(file, &options, first, bar);
    let log = reading(path, read)?;
    note(path, &log);
    let pieces = log.axes.into_iter().filter_map(|axis| {
        let pieces = axis.evidence?.pieces?;
        Some(AxisCurve::part(pieces, &axis.name, log.unit))
    });
    pieces.collect()
}

/// The curves of a log with the evidence that it holds beside them. The evidence of a curve file is what it and its pieces say.
pub(crate) fn read_with_evidence(
    path: &Path,
    arguments: &LogArguments,
    covariates: &CovariateArguments,
) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    read_beside(path, arguments, covariates, log::read_with_evidence)
}

/// As [`read_with_evidence`], together with the spectrogram of a log, which only a page shows.
pub(crate) fn read_for_page(
    path: &Path,
    arguments: &LogArguments,
    covariates: &CovariateArguments,
) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    read_beside(path, arguments, covariates, log::read_for_page)
}

fn read_beside(
    path: &Path,
    arguments: &LogArguments,
    covariates: &CovariateArguments,
    read_log: fn(
        &Path,
        &log::Options,
        &Covariates,
        &indicatif::ProgressBar,
    ) -> Result<Log, Failure>,
) -> Result<Vec<(AxisCurve, Evidence)>, Failure> {
    if is_curve(path) {
        return curves_without_evidence(path, &arguments.options(), &covariates.tried());
    }
    let covariates = covariates.tried();
    let options = arguments.options();
    let log = reading(path, |file, bar| read_log(file, &options, &covariates, bar))?;
    note(path, &log);
    with_evidence(&log)
}

/// Measures the curves of a log's first part and those of its last part, which is this share of the log.
pub(crate) fn measure_in_two(
    path: &Path,
    arguments: &LogArguments,
    share: f64,
) -> Result<(Vec<AxisCurve>, Vec<AxisCurve>), Failure> {
    let options = arguments.options();
    let logs = reading(path, |file, bar| {
        log::read_in_two(file, &options, share, bar)
    });
    let (first, rest) = logs?;
    note(path, &first);
    Ok((curves(&first)?, curves(&rest)?))
}

/// Reads a log with a progress bar, whether it is in a file or comes from standard input.
fn reading<T>(
    path: &Path,
    read: impl FnOnce(&Path, &indicatif::ProgressBar) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let file = standard_input::as_file(path)?;
    let bar = progress::reading(path);
    let log = read(&file, &bar);
    bar.finish_and_clear();
    log.map_err(|failure| failure.moved(&file, path))
}

fn note(path: &Path, log: &Log) {
    if progress::is_quiet() {
        return;
    }
    for note in &log.notes {
        report(format_args!("{}{}", Place::file(path), one_line(note)));
    }
}

/// The curves of a log, or of a curve file, which has the extension `.json`.
pub(crate) fn read(path: &Path, arguments: &LogArguments) -> Result<Vec<AxisCurve>, Failure> {
    if !is_curve(path) {
        return measure(path, arguments);
    }
    curves_of_file(path, &arguments.options())
}
