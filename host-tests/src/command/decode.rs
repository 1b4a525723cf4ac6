//! `decode`: from stored bytes to what they say.

use super::{decode_json, decode_text, examples, many};
use crate::failure::{Failure, Place};
use allanite::{Error, OctaveSum, Record, Snapshot};
use clap::Args;
use std::{
    fs::File,
    io::{self, Read, Write},
    path::{Path, PathBuf},
};

/// An envelope is shorter; beyond this it is something else.
const LARGEST: u64 = 1 << 17;

/// Decode factory records and snapshots that a gyro stored
#[derive(Debug, Args)]
#[command(after_help = examples::DECODE)]
pub(super) struct Arguments {
    /// Files of one record or snapshot each; several records make one table
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// What a file holds.
pub(super) struct Decoded {
    pub(super) file: PathBuf,
    pub(super) stored: Stored,
}

/// A record or a snapshot.
pub(super) enum Stored {
    Record(Box<Record>),
    Snapshot(StoredSnapshot),
}

/// A snapshot's octaves.
pub(super) struct StoredSnapshot {
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) octaves: Vec<OctaveSum>,
}

/// Runs the command: what can be decoded is printed, whatever the others are.
pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<(), Failure> {
    let (mut decoded, mut failures) = (Vec::new(), Vec::new());
    for file in &arguments.files {
        match decode(file) {
            Ok(stored) => decoded.push(Decoded {
                file: file.clone(),
                stored,
            }),
            Err(failure) => failures.push(failure),
        }
    }
    if !decoded.is_empty() {
        let printed = if arguments.json {
            decode_json::print(&decoded, output)
        } else {
            decode_text::print(&decoded, output)
        };
        let printed = printed.and_then(|()| output.flush());
        printed.map_err(|error| Failure::standard_output(&error))?;
    }
    many::failed(failures)
}

fn decode(path: &Path) -> Result<Stored, Failure> {
    let bytes = read(path).map_err(|error| Place::file(path).io(&error))?;
    let stored = match Record::decode(&bytes) {
        Ok(record) => Ok(Stored::Record(Box::new(record))),
        Err(Error::OtherKind { .. }) => Snapshot::open(&bytes).map(|snapshot| {
            Stored::Snapshot(StoredSnapshot {
                samples: snapshot.samples(),
                gaps: snapshot.gaps(),
                octaves: snapshot.octaves().collect(),
            })
        }),
        Err(error) => Err(error),
    };
    stored.map_err(|error| {
        // The library's errors read `what: remedy`.
        let text = error.to_string();
        let (what, remedy) = text.rsplit_once(": ").unwrap_or((&text, "store it again"));
        Place::file(path).failure(what, remedy)
    })
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(LARGEST).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A device's identity: text where it is, else its bytes.
pub(super) fn device(record: &Record) -> String {
    match std::str::from_utf8(&record.device) {
        Ok(text) if !text.is_empty() && !text.contains(char::is_control) => text.to_owned(),
        _ => hex(record),
    }
}

/// A device's identity in hexadecimal digits.
pub(super) fn hex(record: &Record) -> String {
    let digits = record.device.iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}

/// `1.2.0`.
pub(super) fn firmware(record: &Record) -> String {
    record.firmware.map(|part| part.to_string()).join(".")
}

/// Axes have the order of the record, and no other name.
pub(super) fn axis_name(i: usize) -> String {
    ["x", "y", "z"].get(i).copied().unwrap_or("?").into()
}
