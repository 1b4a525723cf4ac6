//! Reads a table into the curves of its axes.

use super::{
    Axis, CovariateChoice, Covariates, Evidence, Log, MOST_AXES, Motion, OCTAVES, Options,
    accumulate::{self, Passes},
    clock::Clock,
    columns::Taken,
    scaling::{self, Origin, Scaling},
    table::Table,
    time_column::TimeColumn,
    tried::TriedColumns,
    watched::{self, SharedSums, WatchedAxis},
    worker,
};
use crate::failure::{Failure, Place};
use allanite::{Scale, covariate::Pair, integrity::Reason};
use indicatif::ProgressBar;
use std::path::Path;

/// Reads the first rows of a table, and the axes of the remaining rows if a number of first rows is
/// given. With covariates, the axes are watched together with them.
pub(super) fn read_table(
    table: &impl Table,
    path: &Path,
    options: &Options,
    (first, watch): (Option<u64>, Option<&Covariates>),
    progress: &ProgressBar,
) -> Result<(Log, Vec<Axis>), Failure> {
    let metadata = table.metadata();
    let rate_hz = metadata.rate_hz(path, options)?;
    if let Some(rate_hz) = rate_hz
        && table.by_rows()
    {
        table.columns().check_rate(path, options, rate_hz)?;
    }
    // If the rate is given, time stamps are read only if the options ask for them.
    let time = match table.by_rows() && (rate_hz.is_none() || options.time.is_some()) {
        true => table.columns().time(path, options)?,
        false => None,
    };
    if rate_hz.is_none() && time.is_none() {
        return Err(Place::file(path).failure(
            "the sampling rate is not known",
            "give it with --rate HZ, or name a column of time stamps with --time",
        ));
    }
    let taken = taken(table, path, options, time.as_ref())?;
    let axis_columns = taken.axes;
    if axis_columns.len() > MOST_AXES {
        return Err(Place::file(path).failure(
            format!("{} axes, more than {MOST_AXES}", axis_columns.len()),
            "choose columns with --columns",
        ));
    }
    let scaling = Scaling::settle(table, path, options, &axis_columns, taken.sensor)?;
    let mut columns = axis_columns.clone();
    let (covariates, found): (Vec<_>, Vec<_>) = match watch {
        Some(Covariates::Found) => table.columns().temperatures(&axis_columns),
        _ => Vec::new(),
    }
    .into_iter()
    .unzip();
    let covariates = match watch {
        Some(Covariates::Chosen(choices)) => choices,
        _ => &covariates,
    };
    if covariates.len() > watched::MOST {
        return Err(Failure::option(
            format!("--covariates names {} columns", covariates.len()),
            format!("name at most {}", watched::MOST),
        ));
    }
    if found.is_empty() {
        let chosen = table
            .columns()
            .covariates(path, covariates, &axis_columns)?;
        columns.extend(chosen);
    }
    let heads = found.iter().map(|column| {
        let head = table.columns().heads.get(column.column);
        head.map_or(&[][..], Vec::as_slice)
    });
    let tried = TriedColumns::new(columns.len(), heads);
    columns.extend(found.iter().cloned());
    let plan = worker::Plan {
        axes: axis_columns.len(),
        first: first.unwrap_or(u64::MAX),
        watch: watch.map(|_| covariates.clone()),
    };
    let passes = Passes {
        table,
        path,
        columns: &columns,
        tried,
        time: time.as_ref(),
        progress,
    };
    let measured = accumulate::measure(&passes, &plan)?;
    let is_told = rate_hz.is_some();
    let rate_hz = match (rate_hz, &measured.clock) {
        (None, Some(clock)) => clock.rate_hz().map_err(|flaw| {
            Place::file(path).failure(flaw.what, "give --rate to ignore the stamps")
        })?,
        (rate_hz, _) => rate_hz.unwrap_or(f64::NAN),
    };
    let mut notes = vec![said(taken.note, &scaling, time.as_ref(), rate_hz, is_told)];
    notes.retain(|note| !note.is_empty());
    notes.extend(measured.clock.as_ref().map(Clock::report));
    notes.extend(table.notes());
    let (named, left_out) = named(covariates, &measured, rate_hz);
    notes.extend(left_out);
    let pairs = shared(path, &measured.pairs, &named, rate_hz)?;
    let mut axes = Vec::new();
    let mut rest = Vec::new();
    for (column, (sums, quantum)) in axis_columns.into_iter().zip(measured.axes) {
        let mut axis = Axis {
            name: column.axis,
            rate_per_count: scaling.scale * quantum.step(),
            accumulator: sums.accumulator().clone(),
            spectrum: sums.spectrum().clone(),
            evidence: None,
        };
        if let (Some(_), worker::Sums::InTwo { rest: behind, .. }) = (first, &sums) {
            let behind = Axis {
                accumulator: behind.accumulator.clone(),
                spectrum: behind.spectrum.clone(),
                ..axis.clone()
            };
            check_axis(path, &behind)?;
            rest.push(behind);
        }
        check_axis(path, &axis)?;
        if let worker::Sums::Watched(watched, beside) = &sums {
            let evidence = evidence(path, &axis, &**watched, &named, rate_hz)?;
            axis.evidence = Some(Evidence {
                course: Some(beside.course.clone()),
                pairs: pairs.clone(),
                ..evidence
            });
        }
        if quantum.is_whole() && !scaling.scale_is_told {
            notes.push(format!(
                "axis {}: whole numbers and no scale given: 1 per count assumed (change it with --scale)",
                axis.name
            ));
        }
        notes.extend(scaling.check(path, &axis)?);
        axes.push(axis);
    }
    spread_motion(&mut axes);
    if scaling.origin == Origin::Assumed {
        notes.push(format!(
            "no unit given: {} assumed (change it with --unit)",
            scaling.unit
        ));
    }
    let log = Log {
        rate_hz,
        unit: scaling.unit,
        axes,
        notes,
    };
    Ok((log, rest))
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
    match &options.columns {
        Some(choices) => {
            let axes = columns.chosen(path, choices)?;
            Ok(Taken {
                sensor: columns.sensor_of(&axes),
                axes,
                note: None,
            })
        }
        None => {
            let time = time.map_or(&[][..], |time| &time.columns);
            columns.guessed(path, sensor, time)
        }
    }
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
    if scaling.origin == Origin::Names {
        parts.push(format!("unit {} from the column names", scaling.unit));
    }
    if let Some(time) = time {
        let rate = match is_told {
            false => format!("{rate_hz} Hz"),
            true => "gaps".into(),
        };
        let (name, unit) = (time.name(), time.unit.name());
        parts.push(format!("{rate} from the time stamps of {name}, in {unit}"));
    }
    parts.join("; ")
}

/// A covariate that has been read: its name and the size of its counts, or `None` if it is left out.
type Named = Option<(String, f64)>;

/// The covariates, and a note on every column that is left out because of its values. A rate of change is counted in
/// quanta per sample.
fn named(
    choices: &[CovariateChoice],
    measured: &accumulate::Measured,
    rate_hz: f64,
) -> (Vec<Named>, Vec<String>) {
    let columns = choices.iter().zip(&measured.covariates);
    let named = columns.clone().map(|(choice, &(step, flawed))| {
        let unit = step * if choice.rate { rate_hz } else { 1.0 };
        (!flawed).then(|| (choice.to_string(), unit))
    });
    let left_out = columns.filter(|(choice, (_, flawed))| *flawed && !choice.rate);
    let left_out = left_out.map(|(choice, _)| {
        format!(
            "{} is not tried as a covariate: not all of its values are numbers of its usual size",
            choice.column
        )
    });
    (named.collect(), left_out.collect())
}

/// What covariates share that may act together, in their units.
fn shared(
    path: &Path,
    pairs: &[([usize; 2], SharedSums)],
    named: &[Named],
    rate_hz: f64,
) -> Result<Vec<Pair<OCTAVES>>, Failure> {
    let one = |(covariates, sums): &([usize; 2], SharedSums)| {
        let [Some((name, unit)), Some((_, other_unit))] = covariates.map(|at| &named[at]) else {
            return Ok(None);
        };
        let scale = Scale::new(*unit, rate_hz);
        let told = scale.and_then(|scale| sums.evidence(0, scale, [*other_unit]));
        let told = told.map_err(|error| {
            let what = format!("covariate {name}: {error}");
            Place::file(path).failure(what, "check the values of its column")
        })?;
        let shared = told.covariates.into_iter().next().unwrap_or_default();
        // Places among the covariates that are not left out.
        let place = |at: usize| named[..at].iter().flatten().count();
        Ok(Some(Pair {
            covariates: covariates.map(place),
            shared,
        }))
    };
    pairs
        .iter()
        .filter_map(|pair| one(pair).transpose())
        .collect()
}

/// Motion of one axis makes the curves of all axes invalid, because a gyro that turns about one axis is not at rest
/// about the others.
fn spread_motion(axes: &mut [Axis]) {
    let evidence = axes.iter().filter_map(|axis| axis.evidence.as_ref());
    let moved = evidence.filter(|evidence| matches!(evidence.invalid, Some(Reason::Moved { .. })));
    let first = moved.min_by(|one, other| {
        let at = |evidence: &Evidence| evidence.motion.as_ref().map_or(0.0, |motion| motion.at_s);
        at(one).total_cmp(&at(other))
    });
    let Some((reason, motion)) = first.map(|first| (first.invalid, first.motion.clone())) else {
        return;
    };
    for evidence in axes.iter_mut().filter_map(|axis| axis.evidence.as_mut()) {
        if evidence.invalid.is_none() {
            evidence.invalid = reason;
        }
        if evidence.motion.is_none() {
            evidence.motion.clone_from(&motion);
        }
    }
}

/// The evidence of an axis, in units.
fn evidence(
    path: &Path,
    axis: &Axis,
    watched: &dyn WatchedAxis,
    covariates: &[Named],
    rate_hz: f64,
) -> Result<Evidence, Failure> {
    let fail = |error: allanite::Error| {
        Place::file(path).failure(format!("axis {}: {error}", axis.name), "check the scale")
    };
    let scale = Scale::new(axis.rate_per_count, rate_hz).map_err(fail)?;
    let unit = |named: &Named| named.as_ref().map_or(1.0, |(_, unit)| *unit);
    let units: Vec<f64> = covariates.iter().map(unit).collect();
    let told = watched.evidence(scale, &units).map_err(fail)?;
    let moved = matches!(told.invalid, Some(Reason::Moved { .. }));
    let named = covariates.iter().zip(told.covariates);
    let named = named.filter_map(|(named, cross)| Some((named.as_ref()?.0.clone(), cross)));
    Ok(Evidence {
        kurtosis: told.kurtosis,
        covariates: named.collect(),
        pairs: Vec::new(),
        invalid: told.invalid,
        course: None,
        motion: told.moved_at.filter(|_| moved).map(|sample| Motion {
            axis: axis.name.clone(),
            at_s: sample as f64 / rate_hz,
        }),
    })
}

/// Checks that an axis is long enough and that its values change.
fn check_axis(path: &Path, axis: &Axis) -> Result<(), Failure> {
    let fail = |what: String, remedy: &str| Err(Place::file(path).failure(what, remedy));
    let Axis {
        name,
        rate_per_count,
        accumulator,
        ..
    } = axis;
    // Nine samples give two octaves of at least six differences each.
    const LEAST: u64 = 9;
    if accumulator.samples() < LEAST {
        return fail(
            format!(
                "{} samples are too few: two octaves need {LEAST}",
                accumulator.samples()
            ),
            "record longer",
        );
    }
    if accumulator
        .octave(0)
        .is_none_or(|octave| octave.sum.to_real() == 0.0)
    {
        return fail(
            format!("axis {name} never changes its value"),
            "check the sensor, or choose other columns with --columns",
        );
    }
    if !(rate_per_count.is_finite() && *rate_per_count > 0.0) {
        return fail(
            format!(
                "axis {name}: a scale of {rate_per_count} per count is outside the range of floats"
            ),
            "give another --scale",
        );
    }
    Ok(())
}
