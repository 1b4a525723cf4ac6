//! Where the devices of a lot come from: certificates, curve files and logs, or folders of them.

use super::device::{Device, Source};
use crate::command::{
    certified::{self, Content, Identity, device_of},
    decode::{self, certificate},
    input::{
        many,
        record::{CovariateArguments, LogArguments, is_curve},
    },
    output::progress,
};
use allanite_log::failure::{Failure, Place, report};
use std::{
    fs::{self, File},
    io::Read,
    path::{Path, PathBuf},
};

/// The first bytes of everything that a device stores.
const STORED: &[u8] = b"ALNT";

/// The first bytes of a log of ArduPilot, whose extension is that of certificates, too.
const ARDUPILOT: &[u8] = b"\xa3\x95\x80";

/// The extensions of the files that are read in a folder: certificates, curve files, and logs.
const EXTENSIONS: [&str; 20] = [
    "bin", "json", "csv", "tsv", "txt", "dat", "gz", "npy", "ulg", "mcap", "bag", "db3", "parquet",
    "arrow", "feather", "xlsx", "mat", "h5", "hdf5", "bbl",
];

/// The devices of these files. Files that have none are added to `failures`.
///
/// # Errors
/// When a folder cannot be read, or has no device.
pub(super) fn devices(
    files: &[PathBuf],
    about: (&LogArguments, &CovariateArguments),
    failures: &mut Vec<Failure>,
) -> Result<Vec<Device>, Failure> {
    let files = in_folders(files)?;
    let mut devices = Vec::new();
    many::each(
        &files,
        |file| device(file, about),
        |_, device| {
            match device {
                Ok(device) => devices.push(device),
                Err(failure) => failures.push(failure),
            }
            Ok(())
        },
    )?;
    Ok(devices)
}

fn device(file: &Path, about: (&LogArguments, &CovariateArguments)) -> Result<Device, Failure> {
    let source = source(file);
    let (id, certificate) = match source {
        Source::Certificate => {
            let certificate = certificate(file)?;
            (decode::device(&certificate), certificate)
        }
        // The name of a file may be longer than that of a device in a certificate.
        Source::Curve | Source::Log => {
            let nameless = Identity::default();
            let certificate = certified::certificate(file, about, &nameless, Content::Judged)?;
            (device_of(file), certificate)
        }
    };
    Ok(Device {
        id,
        unit: certificate.unit.into(),
        file: file.to_owned(),
        source,
        certificate,
    })
}

/// What a file is, by its first bytes where its extension does not tell.
fn source(file: &Path) -> Source {
    if is_curve(file) {
        return Source::Curve;
    }
    // A pipe is a log, and loses what is read here.
    let mut start = Vec::new();
    if file.is_file()
        && let Ok(opened) = File::open(file)
    {
        // What cannot be read is refused when it is opened again.
        let _ = opened.take(4).read_to_end(&mut start);
    }
    let is_named = has_extension(file, &["bin"]) && !start.starts_with(ARDUPILOT);
    if start.starts_with(STORED) || is_named {
        Source::Certificate
    } else {
        Source::Log
    }
}

fn has_extension(file: &Path, wanted: &[&str]) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy();
    wanted.iter().any(|one| extension.eq_ignore_ascii_case(one))
}

/// These files, with the files of a folder in its place, by their names.
fn in_folders(files: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for file in files {
        if !file.is_dir() {
            all.push(file.clone());
            continue;
        }
        let failed = |error: std::io::Error| Place::file(file).io(&error);
        let (mut inside, mut others) = (Vec::new(), 0);
        for entry in fs::read_dir(file).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if has_extension(&path, &EXTENSIONS) && !path.is_dir() {
                inside.push(path);
            } else {
                others += 1;
            }
        }
        if inside.is_empty() {
            return Err(Place::file(file).failure(
                "there is no certificate, curve file or log in this folder",
                "give files, or a folder whose files end with .bin, .json, or as logs do",
            ));
        }
        if others > 0 && !progress::is_quiet() {
            let s = if others == 1 { "" } else { "s" };
            report(format_args!(
                "{}{others} other file{s} or folder{s} in it are left out",
                Place::file(file)
            ));
        }
        inside.sort();
        all.extend(inside);
    }
    Ok(all)
}
