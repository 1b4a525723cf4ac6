//! Flight logs of ArduPilot. They describe their own messages; those of one sensor form the table.

use super::{
    choice::{Candidate, choose},
    wrong::Wrong,
};
use crate::converted::Text;
use ardupilot_binlog::{Entry, File, Reader};
use std::{collections::BTreeMap, fs, io::Write as _, path::Path};

/// The messages with the rates of a gyro, of which a log may have either, and those of an accelerometer alone.
const MESSAGES: [&str; 3] = ["IMU", "GYR", "ACC"];

/// Names as ArduPilot gives them, and with the unit that its documentation of messages tells.
const UNITS: [(&str, &str); 9] = [
    ("TimeUS", "TimeUS [us]"),
    ("SampleUS", "SampleUS [us]"),
    ("GyrX", "GyrX [rad/s]"),
    ("GyrY", "GyrY [rad/s]"),
    ("GyrZ", "GyrZ [rad/s]"),
    ("AccX", "AccX [m/s^2]"),
    ("AccY", "AccY [m/s^2]"),
    ("AccZ", "AccZ [m/s^2]"),
    ("T", "T [degC]"),
];

pub(super) fn convert(
    path: &Path,
    topic: Option<&str>,
    text: &mut Text,
) -> Result<Option<String>, Wrong> {
    let mut found: BTreeMap<String, u64> = BTreeMap::new();
    for entry in entries(path)? {
        let entry = entry.map_err(Wrong::damaged)?;
        *found.entry(name(&entry)).or_default() += 1;
    }
    // Without a request, a gyro comes before an accelerometer.
    let wanted = |name: &str| match topic {
        Some(_) => true,
        None => ["IMU", "GYR"].iter().any(|gyro| name.starts_with(gyro)),
    };
    let found = found.into_iter().filter(|(name, _)| wanted(name));
    let candidates: Vec<_> = found.map(|(name, rows)| Candidate { name, rows }).collect();
    let (chosen, note) = choose(&candidates, topic, "sensor")?;
    let chosen = &candidates[chosen].name;
    let mut has_names = false;
    for entry in entries(path)? {
        let entry = entry.map_err(Wrong::damaged)?;
        if name(&entry) != *chosen {
            continue;
        }
        let fields = || entry.fields().filter(|(_, value)| value.as_f64().is_some());
        if !has_names {
            let names = fields().map(|(name, _)| {
                let known = UNITS.iter().find(|(short, _)| *short == name);
                known.map_or(name, |(_, long)| *long)
            });
            text.names(names)?;
            has_names = true;
        }
        let mut separator = "";
        for (_, value) in fields() {
            write!(text, "{separator}{value}")?;
            separator = ",";
        }
        text.write_all(b"\n")?;
    }
    Ok(note)
}

/// The messages of a sensor in a log.
fn entries(
    path: &Path,
) -> Result<impl Iterator<Item = <Reader<fs::File> as Iterator>::Item>, Wrong> {
    let file = File::open(path).map_err(Wrong::damaged)?;
    let entries = file.entries().map_err(Wrong::damaged)?;
    Ok(entries.filter(|entry| match entry {
        Ok(entry) => MESSAGES.contains(&entry.name.as_str()),
        Err(_) => true,
    }))
}

/// The name of a sensor: its message, and its number if there is one.
fn name(entry: &Entry) -> String {
    match entry.get_f64("I") {
        Some(instance) => format!("{}:{instance}", entry.name),
        None => entry.name.clone(),
    }
}
