//! The noise of the gyro in the configuration of KF-GINS.
//!
//! KF-GINS takes the angle random walk in deg/√h, and for the bias a Gauss–Markov process with a standard deviation in
//! deg/h for each axis and one correlation time in hours (`GIEngine::GIEngine`, where the driving noise is `2 σ²/T`).

use super::{
    arguments::Arguments, axis_noise::AxisNoise, characterisation::Characterisation,
    decimal::decimal, given::Given, summary,
};
use allanite_host::overbound::GaussMarkovProcess;
use std::fmt::Write;

/// Seconds in an hour.
const HOUR_S: f64 = 3600.0;

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
        body(&mut text, &format!("  {mark}"), known, is_overbound);
    }
    text += "  # vrw, abstd, gsstd and asstd are not part of a gyro record: fill them in\n";
    text + &summary::below(known, "#")
}

fn body(text: &mut String, start: &str, known: &Characterisation, is_overbound: bool) {
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
    let processes: Vec<(Option<GaussMarkovProcess>, String)> = known
        .axes
        .iter()
        .map(|axis| process(axis, is_overbound))
        .collect();
    // There is one correlation time: that of the strongest process.
    let known_processes = processes.iter().filter_map(|(process, _)| *process);
    let strongest = known_processes.max_by(|one, other| one.sigma.total_cmp(&other.sigma));
    let sigma: Vec<Given> = processes
        .iter()
        .map(|(process, words)| match process {
            Some(process) => Given::Number {
                value: process.sigma * to_degrees * HOUR_S,
                remark: words.clone(),
            },
            None => Given::Missing { why: words.clone() },
        })
        .collect();
    row(text, start, "gbstd", known, &sigma, "deg/hr");
    if let Some(strongest) = strongest {
        let hours = decimal(strongest.correlation_time_s / HOUR_S);
        let _ = writeln!(text, "{start}corrtime: {hours}  # hr");
    }
}

/// The process that stands for the changes of the bias, and where it comes from.
fn process(axis: &AxisNoise, is_overbound: bool) -> (Option<GaussMarkovProcess>, String) {
    if is_overbound {
        let process = axis.overbound_with_process.gauss_markov;
        return (process, "the overbound needs no such process".into());
    }
    let mut found = axis.states.processes.iter().map(|one| one.process);
    if let Some(strongest) = found.by_ref().max_by(|a, b| a.sigma.total_cmp(&b.sigma)) {
        return (Some(strongest), String::new());
    }
    if let (Some(_), Some(equivalent)) = (axis.measured("B"), axis.equivalent) {
        return (
            Some(equivalent.process),
            "in the place of the bias instability".into(),
        );
    }
    let Some(walk) = axis.measured("K") else {
        return (None, "the record shows no change of the bias".into());
    };
    // Over times far below T, a process with σ = K √(T/2) is a random walk of K.
    let time_s = axis.samples as f64 / axis.rate_hz;
    let process = GaussMarkovProcess {
        sigma: walk * (0.5 * time_s).sqrt(),
        correlation_time_s: time_s,
    };
    let words = "K as a process as long as the record";
    (Some(process), words.into())
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
    let values: Vec<f64> = given.iter().filter_map(Given::value).collect();
    let row = match values.as_slice() {
        [x, y, z] if given.len() == 3 => Some([*x, *y, *z]),
        // One number stands for all axes if there are not three of them.
        values if given.len() != 3 => values.iter().copied().reduce(f64::max).map(|one| [one; 3]),
        _ => None,
    };
    let _ = match row {
        Some(row) => writeln!(
            text,
            "{start}{key}: [{}]  # {unit}{said}",
            row.map(decimal).join(", ")
        ),
        None => writeln!(text, "  # {key}:  # {unit}{said}"),
    };
}
