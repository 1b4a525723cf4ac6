//! `decode`: prints the factory certificates and snapshots that a gyro stored.

mod decoded;
mod json;
mod text;

use crate::command::{examples, input::many};
use allanite::storage::{self, Certificate, Snapshot};
use allanite_log::{
    failure::{Failure, Place},
    regular_file,
};
use clap::Args;
use decoded::{Decoded, Stored, StoredSnapshot};
pub(super) use decoded::{axis_name, device, firmware};
pub(super) use json::schema;
use std::{
    io::{Read, Write},
    path::{Path, PathBuf},
};

/// Largest number of bytes read from a file. Every stored envelope is shorter.
const LARGEST: u64 = 1 << 17;

/// Decode factory certificates and snapshots that a gyro stored
#[derive(Debug, Args)]
#[command(after_help = examples::DECODE)]
pub(super) struct Arguments {
    /// Files with one certificate or snapshot each; several certificates are printed as one table
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command. Files that can be decoded are printed even if others cannot.
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
    print(&decoded, arguments.json, output)?;
    many::failed(failures)
}

/// Prints certificates with the files that have them.
///
/// # Errors
/// When standard output cannot be written.
pub(super) fn print_certificates(
    certificates: Vec<(PathBuf, Certificate)>,
    json: bool,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let certificates = certificates.into_iter();
    let decoded = certificates.map(|(file, certificate)| Decoded {
        file,
        stored: Stored::Certificate(Box::new(certificate)),
    });
    print(&decoded.collect::<Vec<_>>(), json, output)
}

fn print(decoded: &[Decoded], json: bool, output: &mut impl Write) -> Result<(), Failure> {
    if decoded.is_empty() {
        return Ok(());
    }
    let printed = if json {
        json::print(decoded, output)
    } else {
        text::print(decoded, output)
    };
    let printed = printed.and_then(|()| output.flush());
    printed.map_err(|error| Failure::standard_output(&error))
}

/// Decodes a file that must have a certificate.
///
/// # Errors
/// When the file cannot be read, or has no certificate.
pub(super) fn certificate(path: &Path) -> Result<Certificate, Failure> {
    match decode(path)? {
        Stored::Certificate(certificate) => Ok(*certificate),
        Stored::Snapshot(_) => Err(Place::file(path).failure(
            "this is a snapshot of a record in progress",
            "give the certificate of a finished record",
        )),
    }
}

fn decode(path: &Path) -> Result<Stored, Failure> {
    let (file, _) = regular_file::open(path)?;
    let mut bytes = Vec::new();
    file.take(LARGEST)
        .read_to_end(&mut bytes)
        .map_err(|error| Place::file(path).io(&error))?;
    let stored = match Certificate::decode(&bytes) {
        Ok(record) => Ok(Stored::Certificate(Box::new(record))),
        Err(storage::Error::WrongKind { .. }) => Snapshot::open(&bytes).map(|snapshot| {
            Stored::Snapshot(StoredSnapshot {
                samples: snapshot.samples(),
                gaps: snapshot.gaps(),
                octaves: snapshot.octaves().collect(),
            })
        }),
        Err(error) => Err(error),
    };
    stored.map_err(|error| Place::file(path).failure(format!("{error:#}"), error.remedy()))
}
