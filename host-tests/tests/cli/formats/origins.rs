//! The table of files by their origin in the manual: each one is read as the table says, or refused with its message.

use super::{GYRO, assert_sums, counts, try_read};
use allanite_log::{Log, Options, unit::Unit};
use program::rows;
use std::{collections::BTreeSet, path::Path};

const MANIFEST: &str = env!("CARGO_MANIFEST_DIR");

/// A row of the table: who wrote the file, the file, the option that it needs, and what comes of it.
struct Origin {
    file: String,
    option: String,
    result: String,
}

/// The rows of the table in the manual.
fn table() -> Vec<Origin> {
    let manual = std::fs::read_to_string(Path::new(MANIFEST).join("../doc/logs.md")).unwrap();
    let rows = manual
        .lines()
        .skip_while(|line| !line.starts_with("| written by | file |"));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    rows.map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, _, file, option, result, _] = cells[..] else {
            panic!("four cells: {line}");
        };
        Origin {
            file: file.trim_matches('`').to_owned(),
            option: option.trim_matches('`').to_owned(),
            result: result.to_owned(),
        }
    })
    .collect()
}

/// The options for an option on the command line.
fn options(option: &str) -> Options {
    let words: Vec<&str> = option.split_whitespace().collect();
    match words[..] {
        [] => Options::default(),
        ["--rate", rate] => Options {
            rate_hz: Some(rate.parse().unwrap()),
            ..Options::default()
        },
        ["--columns", columns] => Options {
            columns: Some(
                columns
                    .split(',')
                    .map(|column| column.parse().unwrap())
                    .collect(),
            ),
            ..Options::default()
        },
        _ => panic!("no option of the table: {option}"),
    }
}

/// What the table says of a log that was read.
fn described(log: &Log) -> String {
    let names: Vec<&str> = log.axes.iter().map(|axis| axis.name.as_str()).collect();
    format!(
        "{} Hz, {}: {}",
        log.rate_hz,
        log.unit.name(),
        names.join(", ")
    )
}

#[test]
fn every_kind_of_file_is_read_or_refused_as_the_manual_says() {
    let table = table();
    let rows = counts();
    let mut wrong = Vec::new();
    let mut read = 0;
    for Origin {
        file,
        option,
        result,
    } in &table
    {
        let name = file.trim_end_matches('/');
        let inside = ["origins", ""].map(|folder| {
            Path::new(MANIFEST)
                .join("../tests/fixtures")
                .join(folder)
                .join(name)
        });
        let path = inside
            .iter()
            .find(|path| path.exists())
            .unwrap_or_else(|| panic!("no file {name}"));
        let found = match try_read(path, &options(option)) {
            Ok(log) => {
                read += 1;
                let samples = log.axes[0].accumulator.samples() as usize;
                assert!(
                    samples == rows.len() || samples == 24 || samples == 32,
                    "{name}: {samples}"
                );
                // Files of integers hold the counts themselves.
                let values = ["blackbox", "LOG00001", "putty", "blanks", "counts.npy"];
                let scale = match name {
                    "st-datalog.csv" => 1e-3,
                    name if values.iter().any(|start| name.starts_with(start)) => 1.0,
                    _ => GYRO,
                };
                if name == "blanks.log" {
                    assert_eq!(log.axes[0].accumulator.gaps(), 1);
                } else {
                    assert_sums(&log, rows[..samples].iter(), 0, scale, name);
                }
                described(&log)
            }
            Err(line) => line
                .replace(&format!("{}: ", name.trim_start_matches("rosbag2/")), "")
                .replace(&format!("{}/", path.parent().unwrap().display()), ""),
        };
        if found != *result {
            wrong.push(format!("{name}: {found}\n  but the table says {result}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} rows:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
    assert!(
        read >= 40 && table.len() >= read + 2,
        "{read} of {} are read",
        table.len()
    );
    let listed: BTreeSet<&str> = table
        .iter()
        .map(|row| row.file.trim_end_matches('/'))
        .collect();
    let folder = Path::new(MANIFEST)
        .join("../tests/fixtures/origins")
        .read_dir()
        .unwrap();
    for entry in folder {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(listed.contains(name.as_str()), "{name} is not in the table");
    }
}

/// What is assumed is said in a note.
#[test]
fn units_by_convention_and_rates_of_preambles_are_said() {
    let said = |name: &str, option: &str| {
        let path = Path::new(MANIFEST)
            .join("../tests/fixtures/origins")
            .join(name);
        try_read(&path, &options(option)).unwrap().notes.join("\n")
    };
    for (name, option, expected) in rows! {
        "mavlogdump.csv", "", "unit rad/s by the convention of ArduPilot";
        "rostopic.csv", "", "unit rad/s by the convention of ROS";
        "Gyroscope.csv", "", "unit rad/s by the convention of phones";
        "vectornav.csv", "", "unit rad/s by the convention of VectorNav";
        "xsens-dot.csv", "", "60 Hz from row 5 above the header";
        "blackbox_decode.01.csv", "", "unit deg/s by the convention of Betaflight";
        "putty", "--rate 200", "no unit given: deg/s assumed";
        "blanks.log", "", "about 500 samples lost";
    } {
        let notes = said(name, option);
        assert!(notes.contains(expected), "{name}: {notes}");
    }
    assert_eq!(Unit::from_name("rad/s"), Some(Unit::RadiansPerSecond));
}
