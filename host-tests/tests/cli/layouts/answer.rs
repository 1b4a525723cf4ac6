//! What a user who knows the log answers to a question, and whether the answer leads to the truth.

use super::layout::{Kind, Layout, Source};
use allanite_log::{
    self as log, Log, Options,
    unit::{Sensor, Unit},
};
use clap::ValueEnum as _;
use indicatif::ProgressBar;
use std::{collections::BTreeSet, fs, path::Path};

/// What became of a log.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Outcome {
    /// The values of the truth, at once, or a refusal where nothing can be read.
    Right,
    /// The values times a factor, and a note that unit or scale are assumed; right when they are given.
    Assumed,
    /// Refused with a question, and right with the answer. The flag says whether the question spelled the answer out.
    Asked(bool),
    /// Refused with a question, and wrong with the answer.
    WrongAfterAnswer,
    /// Refused without a question that can be answered.
    Refused,
    /// Other values than those of the truth, without a word.
    SilentlyWrong,
}

/// Reads a layout, answers questions, and says what became of it, with the last line that the program said.
pub(super) fn outcome(layout: &Layout, folder: &Path) -> (Outcome, String) {
    let path = folder.join("log.txt");
    fs::write(&path, &layout.text).unwrap();
    let mut options = Options::default();
    let mut given = BTreeSet::new();
    let mut is_spelled_out = true;
    let mut said = Vec::new();
    // A device that is not the first one, so that a choice is seen to be followed.
    let source = layout.sources.last();
    for _ in 0..6 {
        let bar = ProgressBar::hidden();
        let log = match log::read(&path, &options, &bar) {
            Err(failure) => {
                let line = failure.to_string();
                said.push(line.clone());
                if layout.is_unreadable {
                    return (Outcome::Right, said.join("\n  "));
                }
                let source = source.unwrap();
                match answer(&line, layout, source, &mut options, &mut given) {
                    Some(is_spelled) => is_spelled_out &= is_spelled,
                    None if given.is_empty() => return (Outcome::Refused, said.join("\n  ")),
                    None => return (Outcome::Refused, said.join("\n  ")),
                }
                continue;
            }
            Ok(log) => log,
        };
        said.extend(log.notes.iter().map(|note| format!("note: {note}")));
        said.push(described(&log));
        let judged = judged(&log, layout, &given);
        let outcome = match judged {
            Judged::Right if given.contains("assumed") => Outcome::Assumed,
            Judged::Right if given.is_empty() => Outcome::Right,
            Judged::Right => Outcome::Asked(is_spelled_out),
            Judged::Scaled
                if log
                    .notes
                    .iter()
                    .any(|note| note.contains("--unit)") || note.contains("--scale)"))
                    && given.insert("assumed") =>
            {
                give_unit(source.unwrap(), &mut options);
                continue;
            }
            _ if given.is_empty() => Outcome::SilentlyWrong,
            _ => Outcome::WrongAfterAnswer,
        };
        return (outcome, said.join("\n  "));
    }
    (Outcome::Refused, said.join("\n  "))
}

fn described(log: &Log) -> String {
    let axes: Vec<String> = log
        .axes
        .iter()
        .zip(noises(log))
        .map(|(axis, noise)| format!("{} {noise:.5}", axis.name))
        .collect();
    format!(
        "read {} at {:.4} Hz in {}",
        axes.join(", "),
        log.rate_hz,
        log.unit
    )
}

/// White noise by axis, in deg/s/√Hz or m/s²/√Hz.
fn noises(log: &Log) -> Vec<f64> {
    let size = match log.unit {
        Unit::DegreesPerSecond | Unit::MetresPerSecondSquared => 1.0,
        Unit::RadiansPerSecond => 180.0 / std::f64::consts::PI,
        Unit::StandardGravity => 9.80665,
    };
    let noise = |axis: &log::Axis| {
        let octave = axis.accumulator.octaves().next().unwrap();
        let square = octave.sum.to_real() / 2.0 / octave.differences as f64;
        square.sqrt() * axis.rate_per_count * size / log.rate_hz.sqrt()
    };
    log.axes.iter().map(noise).collect()
}

enum Judged {
    Right,
    /// Right but for one factor.
    Scaled,
    Wrong,
}

fn judged(log: &Log, layout: &Layout, given: &BTreeSet<&'static str>) -> Judged {
    let one = layout.sources.last().into_iter().collect::<Vec<_>>();
    let all = layout.sources.iter().collect::<Vec<_>>();
    if layout.is_unreadable {
        return Judged::Wrong;
    }
    let is_chosen = given.contains("rows") || given.contains("columns");
    let sources = if is_chosen { one } else { all };
    let mut expected: Vec<f64> = sources
        .iter()
        .flat_map(|source| source.noise.clone())
        .collect();
    let mut found = noises(log);
    if expected.len() != found.len()
        || (log.rate_hz / sources[0].rate_hz - 1.0).abs() > layout.rate_error
    {
        return Judged::Wrong;
    }
    let is_angular = log.unit.sensor() == Sensor::Gyro;
    if is_angular == (layout.kind == Kind::Forces) {
        return Judged::Wrong;
    }
    expected.sort_by(f64::total_cmp);
    found.sort_by(f64::total_cmp);
    let ratios = expected
        .iter()
        .zip(&found)
        .map(|(expected, found)| found / expected);
    let ratios: Vec<f64> = ratios.collect();
    let near = |factor: f64| {
        ratios
            .iter()
            .all(|ratio| (ratio / factor - 1.0).abs() < layout.noise_error)
    };
    if near(1.0) {
        Judged::Right
    } else if near(ratios[0]) {
        Judged::Scaled
    } else {
        Judged::Wrong
    }
}

fn give_unit(source: &Source, options: &mut Options) {
    options.unit = Some(Unit::from_str(source.unit, true).unwrap());
    options.scale = Some(source.scale);
}

/// Answers the first question that the line asks and that has not been answered. Says whether the line spelled the answer out, or
/// `None` if it asks nothing that has a true answer.
fn answer(
    line: &str,
    layout: &Layout,
    source: &Source,
    options: &mut Options,
    given: &mut BTreeSet<&'static str>,
) -> Option<bool> {
    let asks = |option: &str| {
        line.contains(&format!("--{option} ")) || line.ends_with(&format!("--{option}"))
    };
    if let Some((column, name)) = &layout.key
        && asks("rows")
        && given.insert("rows")
    {
        let by_name = if name.is_empty() {
            column.to_string()
        } else {
            name.clone()
        };
        let rows = format!("{by_name}={}", source.id);
        options.rows = Some(rows.parse().unwrap());
        let is_listed = line.contains(&format!("\"{}\"", source.id));
        return Some(is_listed || line.contains(&rows));
    }
    if layout.kind == Kind::Forces && asks("sensor") && given.insert("sensor") {
        options.sensor = Some(Sensor::Accelerometer);
        return Some(line.contains("--sensor accel"));
    }
    if asks("columns") && given.insert("columns") {
        let names = if layout.kind == Kind::Forces {
            ["ax", "ay", "az"]
        } else {
            ["gx", "gy", "gz"]
        };
        let choices = names.iter().zip(&source.columns);
        let choices: Vec<String> = choices
            .map(|(name, column)| format!("{name}={column}"))
            .collect();
        options.columns = Some(
            choices
                .iter()
                .map(|choice| choice.parse().unwrap())
                .collect(),
        );
        return Some(line.contains(&choices.join(",")));
    }
    if (asks("unit") || asks("scale")) && given.insert("unit") {
        give_unit(source, options);
        return Some(line.contains(source.unit));
    }
    if let Some(unit) = layout.time_unit
        && asks("time-unit")
        && given.insert("time-unit")
    {
        options.time_unit = Some(log::TimeUnit::from_str(unit, true).unwrap());
        return Some(line.contains(unit));
    }
    if let Some(column) = layout.time
        && asks("time")
        && given.insert("time")
    {
        options.time = Some(column.to_string());
        return Some(line.contains(&format!("--time {column}")));
    }
    if asks("rate") && given.insert("rate") {
        options.rate_hz = Some(source.rate_hz);
        // Stamps of a unit that no option names do not help.
        options.time = None;
        return Some(true);
    }
    None
}
