//! Flight logs of Betaflight, whose main frames form the table.

use super::{
    choice::{Candidate, choose},
    wrong::Wrong,
};
use crate::converted::Text;
use blackbox_log::{
    File, Filter, FilterSet,
    frame::Value,
    prelude::*,
    units::si::{acceleration::meter_per_second_squared, angular_velocity::degree_per_second},
};
use std::{
    fs,
    io::{Read as _, Write as _},
    path::Path,
};

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    text: &mut Text,
) -> Result<Option<String>, Wrong> {
    let opened = fs::File::open(path)?;
    // A file that grows is read to the length that it has now.
    let length = opened.metadata()?.len();
    let mut bytes = Vec::new();
    opened.take(length).read_to_end(&mut bytes)?;
    let file = File::new(&bytes);
    // One file may have the logs of several flights.
    let filters = FilterSet {
        main: Filter::Unfiltered,
        slow: Filter::only_required(),
        gps: Filter::only_required(),
    };
    let mut candidates = Vec::new();
    let mut unread = None;
    for log in 0..file.log_count() {
        let headers = match file.parse(log) {
            Some(Ok(headers)) => headers,
            Some(Err(error)) => {
                unread = Some(error);
                continue;
            }
            None => continue,
        };
        let mut parser = headers.data_parser_with_filters(&filters);
        while parser.next().is_some() {}
        candidates.push((
            log,
            Candidate {
                name: format!("{}", log + 1),
                rows: parser.stats().counts.main as u64,
            },
        ));
    }
    if let (Some(error), []) = (unread, &candidates[..]) {
        return Err(Wrong::unfit(
            error.to_string(),
            "convert it with `blackbox_decode`, and give the .csv file",
        ));
    }
    let (logs, candidates): (Vec<usize>, Vec<Candidate>) = candidates.into_iter().unzip();
    let (chosen, note) = choose(&candidates, topic, "log")?;
    let Some(Ok(headers)) = file.parse(logs[chosen]) else {
        return Ok(note);
    };
    let mut parser = headers.data_parser_with_filters(&filters);
    let definition = parser.main_frame_def();
    let names = definition.iter().map(|field| named(field.name));
    let names: Vec<Option<String>> = names.collect();
    write!(text, "time [us]")?;
    for name in names.iter().flatten() {
        write!(text, ",{name}")?;
    }
    writeln!(text)?;
    let mut scales = vec![None; names.len()];
    while let Some(event) = parser.next() {
        let ParserEvent::Main(frame) = event else {
            continue;
        };
        write!(text, "{}", frame.time_raw())?;
        for (field, scale) in scales.iter_mut().enumerate() {
            if names[field].is_none() {
                continue;
            }
            let raw = frame.get_raw(field).unwrap_or_default().cast_signed();
            let value = match frame.get(field).map(Value::from) {
                Some(Value::Rotation(rate)) => rate.get::<degree_per_second>(),
                Some(Value::Acceleration(one)) => one.get::<meter_per_second_squared>(),
                _ => f64::from(raw),
            };
            if raw != 0 && scale.is_none() {
                // The scale passed radians in a short float; six digits are those that it was set with.
                let seen = value / f64::from(raw);
                *scale = Some(format!("{seen:.5e}").parse().unwrap_or(seen));
            }
            write!(text, ",{}", f64::from(raw) * scale.unwrap_or(0.0))?;
        }
        writeln!(text)?;
    }
    Ok(note)
}

/// The name of a field of a sensor, with its unit.
fn named(field: &str) -> Option<String> {
    let units = [("gyro", "deg/s"), ("acc", "m/s^2")];
    let (_, unit) = units.iter().find(|(start, _)| field.starts_with(start))?;
    Some(format!("{field} [{unit}]"))
}
