//! What a file holds, and what its parts are called.

use allanite::{octave::OctaveSum, storage::Certificate};
use std::path::PathBuf;

/// What a file holds.
pub(super) struct Decoded {
    pub(super) file: PathBuf,
    pub(super) stored: Stored,
}

/// A record or a snapshot.
pub(super) enum Stored {
    Certificate(Box<Certificate>),
    Snapshot(StoredSnapshot),
}

/// A snapshot's octaves.
pub(super) struct StoredSnapshot {
    pub(super) samples: u64,
    pub(super) gaps: u64,
    pub(super) octaves: Vec<OctaveSum>,
}

/// A device's identity: text where it is, else its bytes.
pub(super) fn device(record: &Certificate) -> String {
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

/// `1.2.0`.
pub(super) fn firmware(record: &Certificate) -> String {
    record.firmware.map(|part| part.to_string()).join(".")
}

/// Axes have the order of the record, and no other name.
pub(super) fn axis_name(i: usize) -> String {
    ["x", "y", "z"].get(i).copied().unwrap_or("?").into()
}
