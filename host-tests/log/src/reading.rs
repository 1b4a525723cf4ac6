//! Reads a table into the curves of its axes.

use super::{
    Axis, Covariates, Evidence, Log, MOST_AXES, OCTAVES, Options,
    accumulate::{self, Passes},
    axes::Taken,
    clock::Clock,
    cuts::Dropped,
    evidence::{self, Recorded, spread_motion},
    faults, part,
    quantum::Quantum,
    scaling::{self, Origin, Scaling},
    sums::Sums,
    table::Table,
    time_column::TimeColumn,
    tried::TriedColumns,
    watched, worker,
};
use crate::{
    failure::{Failure, Place, plural},
    unit::Sensor,
};
use allanite::Accumulator;
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
    let metadata = table.metadata();
    let rate_hz = metadata.rate_hz(path, options)?;
    if let Some(rate_hz) = rate_hz
        && table.by_rows()
    {
        table.columns().check_rate(path, options, rate_hz)?;
    }
    table.columns().check_instances(path)?;
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
    let tried = watch.map(|watch| watch.covariates);
    let (covariates, found): (Vec<_>, Vec<_>) = match tried {
        Some(Covariates::Found) => table.columns().temperatures(&axis_columns),
        _ => Vec::new(),
    }
    .into_iter()
    .unzip();
    let covariates = match tried {
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
    let measured = accumulate::measure(&passes, &plan)?;
    let is_told = rate_hz.is_some();
    let rate_hz = match (rate_hz, &measured.clock) {
        (None, Some(clock)) => clock.rate_hz().map_err(|flaw| {
            Place::file(path).failure(flaw.what, "give --rate to ignore the stamps")
        })?,
        (rate_hz, _) => rate_hz.unwrap_or(f64::NAN),
    };
    let logged_hz = rate_hz;
    let (rate_hz, repeats) = measured.faults.sensor_rate(logged_hz);
    let mut notes = vec![said(taken.note, &scaling, time.as_ref(), rate_hz, is_told)];
    notes.retain(|note| !note.is_empty());
    if let Some((row, rate)) = metadata.rate_of_preamble(options) {
        notes.push(format!("{rate} Hz from row {row} above the header"));
    }
    notes.extend(measured.clock.as_ref().map(Clock::report));
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
    notes.extend(table.notes());
    notes.extend(repeats.clone());
    let mut least = 0.0_f64;
    notes.extend(measured.tally.note());
    notes.extend(passes.left_out(&measured.tally, logged_hz)?);
    notes.extend(evidence::left_out(covariates, &measured));
    let recorded = Recorded::new(path, covariates, &measured, rate_hz)?;
    let mut axes = Vec::new();
    let mut rest = Vec::new();
    let is_constant = |sums: &Sums| {
        is_constant(sums.accumulator())
            || matches!(sums, Sums::InTwo { rest, .. } if first.is_some() && is_constant(&rest.accumulator))
    };
    let units: Vec<f64> = measured
        .axes
        .iter()
        .map(|(_, quantum)| scaling.scale * quantum.step())
        .collect();
    let are_whole = measured.axes.iter().any(|(_, quantum)| quantum.is_whole());
    let is_gyro = scaling.unit.sensor() == Sensor::Gyro;
    let per_degree = scaling
        .has_scale(are_whole)
        .then(|| 1.0 / scaling.unit.in_usual());
    let some_change = measured.axes.iter().any(|(sums, _)| !is_constant(sums));
    let measured_axes = axis_columns.into_iter().zip(measured.axes);
    for (place, (column, (mut sums, quantum))) in measured_axes.enumerate() {
        if some_change && is_constant(&sums) {
            let name = column.axis;
            notes.push(format!("axis {name} never changes its value: left out"));
            continue;
        }
        let mut axis = Axis {
            name: column.axis,
            rate_per_count: scaling.scale * quantum.step(),
            accumulator: sums.accumulator().clone(),
            spectrum: sums.spectrum().clone(),
            evidence: None,
        };
        if let (Some(_), Sums::InTwo { rest: behind, .. }) = (first, &sums) {
            let behind = Axis {
                accumulator: behind.accumulator.clone(),
                spectrum: behind.spectrum.clone(),
                ..axis.clone()
            };
            check_axis(path, &behind)?;
            rest.push(behind);
        }
        check_axis(path, &axis)?;
        if let Sums::Watched(watched, beside) = &mut sums {
            let part = beside.take_part();
            let part = part.map(|part| match (&repeats, quantum == Quantum::WHOLE) {
                (_, false) => Err(part::refused(
                    path,
                    "its values are no whole numbers of 32 bits",
                )),
                (Some(_), _) => Err(part::refused(path, "the logger repeated samples")),
                _ => part.finish(path, rate_hz, axis.rate_per_count),
            });
            let coarse = measured.coarse.get(place).copied().flatten();
            let fault = measured.faults.verdict(place);
            let motion = is_gyro
                .then(|| evidence::unrest(&measured.unrest, place, rate_hz, &units, per_degree))
                .flatten();
            let evidence = recorded.evidence(path, &axis, &**watched, [fault, coarse, motion])?;
            if evidence.invalid.is_none() {
                least = least.max(measured.faults.least(place));
            }
            let moved_at = watched.moved_at();
            axis.evidence = Some(Evidence {
                disturbance: recorded.disturbance(
                    &axis.name,
                    evidence.invalid,
                    moved_at,
                    &beside.extremes,
                ),
                course: Some(*beside.course.clone()),
                means: recorded.means(&measured.blocks, place, axis.rate_per_count),
                spectrogram: beside.spectrogram(rate_hz, axis.rate_per_count),
                pieces: part.transpose()?,
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
    notes.extend(faults::bound(least));
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
    match scaling.origin {
        Origin::Names => parts.push(format!("unit {} from the column names", scaling.unit)),
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

/// Whether no value of an axis differs from the one before.
fn is_constant(accumulator: &Accumulator<OCTAVES>) -> bool {
    let octave = accumulator.octave(0);
    octave.is_none_or(|octave| octave.sum.to_real() == 0.0)
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
            match accumulator.samples() {
                1 => format!("1 sample is too few: two octaves need {LEAST}"),
                samples => format!("{samples} samples are too few: two octaves need {LEAST}"),
            },
            "record longer",
        );
    }
    if is_constant(accumulator) {
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
