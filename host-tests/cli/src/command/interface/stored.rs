//! A record as bytes.
//!
//! The curves are the text of a curve file, which is exact, and the evidence is encoded by postcard. The bytes are meant for
//! another process with the same version of this package, and not for an archive, which is what curve files are for.

use allanite_host::curve_file::{AxisCurve, CurveFile};
use allanite_log::{Evidence, failure::Failure};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What the bytes begin with.
const VERSION: &str = concat!("allanite ", env!("CARGO_PKG_VERSION"), ", record 1");

#[derive(Serialize, Deserialize)]
struct Stored {
    version: String,
    path: PathBuf,
    curves: String,
    notes: Vec<String>,
    evidence: Vec<Evidence>,
}

/// What a record has.
type Parts = (PathBuf, Vec<(AxisCurve, Evidence)>, Vec<String>);

/// Writes a record.
pub(super) fn write(
    path: &Path,
    axes: &[(AxisCurve, Evidence)],
    notes: &[String],
) -> Result<Vec<u8>, Failure> {
    let (curves, evidence) = axes.iter().cloned().unzip();
    let curves = CurveFile::new(curves).to_json();
    let fail = |error: &dyn std::fmt::Display| {
        Failure::option(format!("the record: {error}"), "report it with the record")
    };
    let stored = Stored {
        version: VERSION.into(),
        path: path.to_owned(),
        curves: curves.map_err(|error| fail(&error))?,
        notes: notes.to_vec(),
        evidence,
    };
    postcard::to_allocvec(&stored).map_err(|error| fail(&error))
}

/// Reads a record.
///
/// # Errors
/// When the bytes are damaged or of another version.
pub(super) fn read(bytes: &[u8]) -> Result<Parts, Failure> {
    let damaged = || {
        Failure::option(
            "these are not the bytes of a record of this version",
            "read the log again",
        )
    };
    let (version, _): (&str, _) = postcard::take_from_bytes(bytes).map_err(|_| damaged())?;
    if version != VERSION {
        return Err(damaged());
    }
    let stored: Stored = postcard::from_bytes(bytes).map_err(|_| damaged())?;
    let file = CurveFile::parse(&stored.path, stored.curves.as_bytes())?;
    if file.axes.len() != stored.evidence.len() {
        return Err(damaged());
    }
    let axes = file.axes.into_iter().zip(stored.evidence).collect();
    Ok((stored.path, axes, stored.notes))
}
