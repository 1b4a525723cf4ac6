//! Reads a table into the curves of its axes.

use super::{
    Axis, CovariateChoice, Covariates, Log, MOST_AXES, Options,
    accumulate::{self, Measured, Passes},
    assembly::Assembly,
    axes::Taken,
    clock::Clock,
    columns::AxisColumn,
    cuts::Dropped,
    evidence::{self, Recorded},
    faults, names,
    scaling::{self, Origin, Scaling},
    table::Table,
    time_column::TimeColumn,
    tried::TriedColumns,
    watched, worker,
};
use crate::failure::{Failure, Place, brief, plural};
use indicatif::ProgressBar;
use std::path::Path;

/// What to watch beside the curves of a log.
#[derive(Clone, Copy)]
pub(super) struct Watched<'a> {
    pub(super) covariates: &'a Covariates,
    /// Whether the kurtosis is needed.
    pub(super) moments: bool,
    /// Whether the spectrogram is needed.
    pub(super) spectrogram: bool,
    /// The number of the first sample in the record, if the log is a part of a longer one.
    pub(super) first_sample: Option<u64>,
}

/// Reads the first rows of a table, and the axes of the remaining rows if a number of first rows is
/// given. With covariates, the axes are watched together with them.
pub(super) fn read_table(
    table: &impl Table,
    path: &Path,
    options: &Options,
    (first, watch): (Option<u64>, Option<Watched>),
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    let (rate_hz, time) = sampling(table, path, options)?;
    let taken = taken(table, path, options, time.as_ref())?;
    let scaling = Scaling::settle(table, path, options, &taken.axes, taken.sensor)?;
    let wanted = watch.map(|watch| watch.covariates);
    let (covariates, columns, tried) = with_covariates(table, path, &taken.axes, wanted)?;
    let plan = worker::Plan {
        axes: taken.axes.len(),
        first: first.unwrap_or(u64::MAX),
        watch: watch.map(|watch| worker::Watch {
            covariates: covariates.clone(),
            moments: watch.moments,
            spectrogram: watch.spectrogram,
            first_sample: watch.first_sample,
        }),
        faults: faults::Plan {
            by_rows: table.by_rows() || columns.len() == 1,
            repeats: options.repeats,
            ..faults::Plan::default()
        },
    };
    let mut passes = Passes {
        table,
        path,
        columns: &columns,
        tried,
        time: time.as_ref(),
        rate_hz,
        dropped: Dropped::NONE,
        late: Vec::new(),
        progress,
    };
    passes.cut(&options.cuts)?;
    let mut measured = accumulate::measure(&passes, &plan)?;
    let is_told = rate_hz.is_some();
    let logged_hz = match (rate_hz, &measured.clock) {
        (None, Some(clock)) => clock.rate_hz().map_err(|flaw| {
            Place::file(path).failure(flaw.what, "give --rate to ignore the stamps")
        })?,
        (rate_hz, _) => rate_hz.unwrap_or(f64::NAN),
    };
    let (rate_hz, repeats) = measured.faults.sensor_rate(logged_hz);
    let mut notes = vec![said(taken.note, &scaling, time.as_ref(), rate_hz, is_told)];
    notes.retain(|note| !note.is_empty());
    if let Some((row, rate)) = table.metadata().rate_of_preamble(options) {
        notes.push(format!("{rate} Hz from row {row} above the header"));
    }
    notes.extend(notes_of(&passes, &measured, logged_hz, repeats.clone())?);
    notes.extend(evidence::left_out(&covariates, &measured));
    let recorded = Recorded::new(path, &covariates, &measured, rate_hz)?;
    let axes = taken.axes.into_iter().map(|column| column.axis);
    let axes = axes.zip(std::mem::take(&mut measured.axes)).collect();
    let assembly = Assembly {
        path,
        is_in_two: first.is_some(),
        scaling,
        rate_hz,
        repeats: repeats.is_some(),
        recorded,
        measured,
    };
    assembly.log(axes, notes)
}

/// The sampling rate, if it is known before the values are read, and the column of time stamps, if it is to be read.
fn sampling(
    table: &impl Table,
    path: &Path,
    options: &Options,
) -> Result<(Option<f64>, Option<TimeColumn>), Failure> {
    table.columns().check_curve(path)?;
    let rate_hz = table.metadata().rate_hz(path, options)?;
    if let Some(rate_hz) = rate_hz
        && table.by_rows()
    {
        table.columns().check_rate(path, options, rate_hz)?;
    }
    table.columns().check_sources(path)?;
    if options.columns.is_none() {
        table.columns().check_glued(path)?;
    }
    // If the rate is given, time stamps are read only if the options ask for them.
    let time = match table.by_rows() && (rate_hz.is_none() || options.time.is_some()) {
        true => table.columns().time(path, options)?,
        false => None,
    };
    if rate_hz.is_none() && time.is_none() {
        let why = match table.by_rows() {
            true => table.columns().why_no_time(),
            false => {
                "the columns lie one behind the other, so that no stamps are read beside the axes"
                    .into()
            }
        };
        return Err(Place::file(path).failure(
            format!("the sampling rate is not known: {why}"),
            "give it with --rate HZ, or name a column of time stamps with --time",
        ));
    }
    Ok((rate_hz, time))
}

/// The covariates, the columns of the axes with those of the covariates behind them, and which of these nobody asked for.
fn with_covariates(
    table: &impl Table,
    path: &Path,
    axes: &[AxisColumn],
    wanted: Option<&Covariates>,
) -> Result<(Vec<CovariateChoice>, Vec<AxisColumn>, TriedColumns), Failure> {
    let (covariates, found): (Vec<_>, Vec<_>) = match wanted {
        Some(Covariates::Found) => table.columns().temperatures(axes),
        _ => Vec::new(),
    }
    .into_iter()
    .unzip();
    let covariates = match wanted {
        Some(Covariates::Chosen(choices)) => choices.clone(),
        _ => covariates,
    };
    if covariates.len() > watched::MOST {
        return Err(Failure::option(
            format!("--covariates names {} columns", covariates.len()),
            format!("name at most {}", watched::MOST),
        ));
    }
    let mut columns = axes.to_vec();
    if found.is_empty() {
        columns.extend(table.columns().covariates(path, &covariates, axes)?);
    }
    let heads = found.iter().map(|column| {
        let head = table.columns().heads.get(column.column);
        head.map_or(&[][..], Vec::as_slice)
    });
    let tried = TriedColumns::new(columns.len(), heads);
    columns.extend(found);
    Ok((covariates, columns, tried))
}

/// Notes on the stamps, on what was filled, on the table, on repeats and on what was left out.
fn notes_of(
    passes: &Passes<'_, impl Table>,
    measured: &Measured,
    logged_hz: f64,
    repeats: Option<String>,
) -> Result<Vec<String>, Failure> {
    let mut notes: Vec<String> = measured.clock.iter().map(Clock::report).collect();
    let filled = measured
        .axes
        .first()
        .map(|(sums, _)| *sums.accumulator().bridged());
    notes.extend(filled.filter(|filled| !filled.is_empty()).map(|filled| {
        let gaps = filled.gaps.iter().map(|&gaps| u64::from(gaps)).sum();
        format!(
            "{} bridged: filled, and what that changes is taken off the Allan curve and the spectrum",
            plural(gaps, "short gap")
        )
    }));
    notes.extend(passes.table.notes());
    notes.extend(repeats);
    notes.extend(measured.tally.note());
    notes.extend(passes.left_out(&measured.tally, logged_hz)?);
    Ok(notes)
}

/// The axes that the options ask for, or else those that are found.
fn taken(
    table: &impl Table,
    path: &Path,
    options: &Options,
    time: Option<&TimeColumn>,
) -> Result<Taken, Failure> {
    let sensor = scaling::wanted_sensor(options)?;
    let columns = table.columns();
    let taken = match &options.columns {
        Some(choices) => {
            let axes = columns.chosen(path, choices)?;
            Taken {
                sensor: columns.sensor_of(&axes),
                axes,
                note: None,
            }
        }
        None => {
            let time = time.map_or(&[][..], |time| &time.columns);
            columns.guessed(path, sensor, time)?
        }
    };
    if taken.axes.len() > MOST_AXES {
        return Err(Place::file(path).failure(
            format!("{} axes, more than {MOST_AXES}", taken.axes.len()),
            "choose columns with --columns",
        ));
    }
    let name = |axis: &AxisColumn| columns.name(axis.column).map(str::to_owned);
    let mut names = taken.axes.iter().filter_map(name);
    if options.scale.is_none()
        && let Some(name) = names.find(|name| names::is_increment(name))
    {
        return Err(Place::file(path).failure(
            format!("column {name} has increments of an angle, and no rates"),
            "give as --scale the number of samples per second, by which they become rates, with --unit and the three --columns",
        ));
    }
    Ok(taken)
}

/// A note on what was found rather than given, on one line.
fn said(
    columns: Option<String>,
    scaling: &Scaling,
    time: Option<&TimeColumn>,
    rate_hz: f64,
    is_told: bool,
) -> String {
    let mut parts: Vec<String> = columns.into_iter().collect();
    match scaling.origin {
        Origin::Names => parts.push(format!("unit {} from the column names", scaling.unit)),
        Origin::Header => parts.push(format!(
            "{} {} per count from the header of Gyroflow",
            brief(scaling.scale),
            scaling.unit
        )),
        Origin::Convention(program) => {
            parts.push(format!(
                "unit {} by the convention of {program} (change it with --unit)",
                scaling.unit
            ));
        }
        Origin::Beside => parts.push(
            "rad/s assumed, because the accelerometer beside it is in m/s² (change it with --unit)"
                .into(),
        ),
        Origin::Gravity => {
            parts.push("g assumed, because gravity is 1 in it (change it with --unit)".into());
        }
        Origin::Told | Origin::Assumed => {}
    }
    if let Some(time) = time {
        let rate = match is_told {
            false => format!("{rate_hz} Hz"),
            true => "gaps".into(),
        };
        let (name, unit) = (time.name(), time.unit_name());
        parts.push(format!("{rate} from the time stamps of {name}, in {unit}"));
    }
    parts.join("; ")
}
