//! Tables of other programs in binary. Each is rewritten as the text that logs are read from, in a temporary file, so that
//! names, units, stamps and values are judged in one place.

pub(crate) mod apart;
mod ardupilot;
mod arrays;
mod arrow;
mod betaflight;
mod choice;
mod hdf5;
mod hdf5_left_out;
mod hdf5_links;
mod hdf5_lowest;
mod matlab;
mod rewrite;
mod workbook;
mod wrong;

use super::{Options, converted::Converted, source::TableKind as Kind};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use rewrite::rewrite;
use std::{io, path::Path};
use tempfile::NamedTempFile;

/// Rewrites a table as text.
///
/// # Errors
/// When the file is damaged, holds no table of numbers, or holds several without a choice.
pub(crate) fn convert(
    path: &Path,
    kind: Kind,
    options: &Options,
    progress: &ProgressBar,
) -> Result<Converted, Failure> {
    let io = |error: io::Error| Place::file(path).io(&error);
    progress.set_length(path.metadata().map_or(0, |file| file.len()));
    let text = NamedTempFile::new().map_err(io)?.into_temp_path();
    let topic = options.topic.as_deref();
    let note = apart::ask(path, kind, topic, &text);
    let note = note.unwrap_or_else(|| rewrite(path, kind, topic, &text))?;
    Ok(Converted { text, note })
}
