//! The documents and texts of records, and the failure for an axis that there is none of.

use crate::command::input::many::Findings;
use allanite_log::failure::{Failure, Place, did_you_mean, quoted};
use serde::Serialize;
use std::path::Path;

/// The failure for an axis that a record does not have.
pub(super) fn no_axis<'a>(
    path: &Path,
    name: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Failure {
    let hint = did_you_mean(name, names.clone());
    let names = names.collect::<Vec<_>>().join(", ");
    Place::file(path).failure(
        format!("there is no axis {}", quoted(name.as_bytes())),
        format!("{hint}choose from {names}"),
    )
}

/// A document as JSON.
pub(super) fn json(document: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(document).map_err(|error| unwritten(&error))
}

/// What a command prints.
pub(super) fn text(findings: &impl Findings) -> Result<String, Failure> {
    let mut text = Vec::new();
    let printed = findings.print(&mut text);
    printed.map_err(|error| Failure::standard_output(&error))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// The failure of a document that cannot be written.
pub(super) fn unwritten(error: &dyn std::fmt::Display) -> Failure {
    Failure::option(error, "report it with the record")
}
