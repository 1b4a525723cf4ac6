//! The decoded content of a file, and the names of its parts.

use allanite::{octave::OctaveSum, storage::Certificate};
use std::path::PathBuf;

/// A file with its decoded content.
pub(super) struct Decoded {
    pub(super) file: PathBuf,
    pub(super) stored: Stored,
}

/// A factory certificate or a snapshot.
pub(super) enum Stored {
    Certificate(Box<Certificate>),
    Snapshot(StoredSnapshot),
}

/// A snapshot with its octaves.
pub(super) struct StoredSnapshot {
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) octaves: Vec<OctaveSum>,
}

/// A device's identity as text, or in hexadecimal digits if it is not printable text.
pub(crate) fn device(record: &Certificate) -> String {
    match std::str::from_utf8(&record.device) {
        Ok(text) if !text.is_empty() && !text.contains(char::is_control) => text.to_owned(),
        _ => hex(record),
    }
}

/// A device's identity in hexadecimal digits.
pub(super) fn hex(record: &Certificate) -> String {
    let digits = record.device.iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}

/// The version of a device's firmware, such as `1.2.0`.
pub(crate) fn firmware(record: &Certificate) -> String {
    record.firmware.map(|part| part.to_string()).join(".")
}

/// The name of an axis by its position: a record stores the order of the axes but no names.
pub(crate) fn axis_name(i: usize) -> String {
    ["x", "y", "z"].get(i).copied().unwrap_or("?").into()
}
