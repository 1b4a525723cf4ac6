//! The noise of the gyro in the configuration of KF-GINS.
//!
//! KF-GINS takes the angle random walk in deg/√h, and for the bias a Gauss–Markov process with a standard deviation in
//! deg/h for each axis and one correlation time in hours (`GIEngine::GIEngine`, where the driving noise is `2 σ²/T`). The
//! accelerometer has the same with m/s/√h and mGal, and the same correlation time. KF-GINS stops if a key is missing.

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use allanite_host::overbound::GaussMarkovProcess;
use std::fmt::Write;

/// Seconds in an hour.
const HOUR_S: f64 = 3600.0;

/// A milligal in m/s².
const MILLIGAL: f64 = 1e-5;

/// What KF-GINS does if a key is left out.
const WITHOUT: &str = "KF-GINS then stops";

/// The part `imunoise` of the configuration.
pub(super) fn yaml(known: &Characterisation, arguments: &Arguments) -> String {
    let mut text = "imunoise:\n".to_owned();
    for is_overbound in [arguments.overbound, !arguments.overbound] {
        let mark = if is_overbound == arguments.overbound {
            ""
        } else {
            "# "
        };
        let name = if is_overbound {
            "overbound"
        } else {
            "best fit"
        };
        let _ = writeln!(text, "  # {name}:");
        let time_s = body(&mut text, &format!("  {mark}"), known, is_overbound);
        if mark.is_empty() {
            accelerometer(&mut text, known, time_s);
        }
    }
    text += "  # gsstd:  # ppm; not part of a record at rest: fill it in; KF-GINS then stops\n";
    text += "  # asstd:  # ppm; not part of a record at rest: fill it in; KF-GINS then stops\n";
    text + &summary::below(known, "#")
}

/// Writes the numbers of the gyro, and returns their correlation time.
fn body(
    text: &mut String,
    start: &str,
    known: &Characterisation,
    is_overbound: bool,
) -> Option<f64> {
    let density = |axis: &AxisNoise| match is_overbound {
        false => axis.white(),
        true => Given::plain(axis.overbound_with_process.noise_density),
    };
    // N in rad/√s is N · 60 in rad/√h.
    let to_degrees = 180.0 / std::f64::consts::PI;
    let white: Vec<Given> = known
        .axes
        .iter()
        .map(|axis| density(axis).times(60.0 * to_degrees))
        .collect();
    row(text, start, "arw", known, &white, "deg/sqrt(hr)");
    let processes: Vec<(Option<GaussMarkovProcess>, &str)> = known
        .axes
        .iter()
        .map(|axis| process(axis, is_overbound))
        .collect();
    // There is one correlation time, the longest one. A process of another axis keeps the noise that drives it: then it is
    // as fast, and its density is nowhere less than its own.
    let times_s = processes.iter().filter_map(|(process, _)| *process);
    let times_s = times_s.map(|process| process.correlation_time_s);
    let time_s = times_s.reduce(f64::max);
    let sigma: Vec<Given> = processes
        .iter()
        .map(|(process, words)| match process.zip(time_s) {
            Some((process, time_s)) => Given::Number {
                value: GaussMarkovProcess::of_walk(process.driving(), time_s).sigma
                    * to_degrees
                    * HOUR_S,
                remark: (*words).to_owned(),
            },
            None => Given::Missing {
                why: (*words).to_owned(),
            },
        })
        .collect();
    row(text, start, "gbstd", known, &sigma, "deg/hr");
    let _ = match time_s {
        Some(time_s) => writeln!(text, "{start}corrtime: {}  # hr", decimal(time_s / HOUR_S)),
        None => writeln!(text, "  # corrtime:  # hr; there is no process; {WITHOUT}"),
    };
    time_s
}

/// The process that stands for the changes of the bias, and where it comes from or why there is none.
fn process(axis: &AxisNoise, is_overbound: bool) -> (Option<GaussMarkovProcess>, &'static str) {
    if is_overbound {
        return match axis.overbound_with_process.gauss_markov {
            None => (None, "the overbound needs no such process"),
            process => (process, ""),
        };
    }
    match axis.bias_process() {
        Some((process, words)) => (Some(process), words),
        None => (None, "the record shows no change of the bias"),
    }
}

/// Writes the numbers of the accelerometer, whose bias has the correlation time of the gyro's.
fn accelerometer(text: &mut String, known: &Characterisation, time_s: Option<f64>) {
    let pair = &known.accelerometer.pair;
    let density = pair.noise_density.clone().times(60.0);
    let sigma = match time_s {
        Some(time_s) => {
            let per_walk = (0.5 * time_s).sqrt() / MILLIGAL;
            pair.random_walk.clone().times(per_walk)
        }
        None => Given::Missing {
            why: "there is no corrtime".into(),
        },
    };
    for (key, given, unit) in [("vrw", density, "m/s/sqrt(hr)"), ("abstd", sigma, "mGal")] {
        let given = given.without(WITHOUT);
        let remark = match given.words() {
            "" => String::new(),
            words => format!("; {words}"),
        };
        let _ = match given.value() {
            Some(value) => {
                let row = [decimal(value), decimal(value), decimal(value)].join(", ");
                writeln!(text, "  {key}: [{row}]  # {unit}{remark}")
            }
            None => writeln!(text, "  # {key}:  # {unit}{remark}"),
        };
    }
}

/// Writes a row of three numbers, or a comment with the reason why there are none.
fn row(
    text: &mut String,
    start: &str,
    key: &str,
    known: &Characterisation,
    given: &[Given],
    unit: &str,
) {
    let named = known.axes.iter().zip(given);
    let said = named.filter(|(_, given)| !given.words().is_empty());
    let said = said.map(|(axis, given)| format!("; {:?}: {}", axis.name, given.words()));
    let said: String = said.collect();
    // One number stands for all axes if there are not three of them.
    let largest = given.iter().filter_map(Given::value).reduce(f64::max);
    let row = Given::three(given).or_else(|| largest.map(|one| ([one; 3], "")));
    let _ = match row {
        Some((row, remark)) => {
            let remark = match remark {
                "" => String::new(),
                remark => format!("; {remark}"),
            };
            writeln!(
                text,
                "{start}{key}: [{}]  # {unit}{said}{remark}",
                row.map(decimal).join(", ")
            )
        }
        None => writeln!(text, "  # {key}:  # {unit}{said}; {WITHOUT}"),
    };
}
