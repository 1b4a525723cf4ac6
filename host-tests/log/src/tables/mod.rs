//! Tables of other programs in binary. Each is rewritten as the text that logs are read from, in a temporary file, so that
//! names, units, stamps and values are judged in one place. Of a long table in columns, only the rows that tell these are text, and
//! its numbers stand beside it in binary.

pub(crate) mod apart;
mod ardupilot;
mod arrays;
mod arrow;
mod arrow_rows;
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
use crate::values::NumberFile;
use indicatif::ProgressBar;
use rewrite::rewrite;
use std::{io, path::Path};
use tempfile::NamedTempFile;

/// Rewrites a table as text; where it may be in `parts`, it may be the text of some rows with all numbers beside it.
///
/// # Errors
/// When the file is damaged, holds no table of numbers, or holds several without a choice.
pub(crate) fn convert(
    path: &Path,
    kind: Kind,
    options: &Options,
    parts: bool,
    progress: &ProgressBar,
) -> Result<Converted, Failure> {
    let io = |error: io::Error| Place::file(path).io(&error);
    let temporary = || Ok(NamedTempFile::new().map_err(io)?.into_temp_path());
    progress.set_length(path.metadata().map_or(0, |file| file.len()));
    let text = temporary()?;
    let is_in_columns = matches!(
        kind,
        Kind::Arrow | Kind::Parquet | Kind::Hdf5 | Kind::Matlab
    );
    let file = (parts && is_in_columns).then(temporary).transpose()?;
    let topic = options.topic.as_deref();
    let to = (&*text, file.as_deref());
    let written = apart::ask(path, kind, topic, to);
    let (note, layout) = written.unwrap_or_else(|| rewrite(path, kind, topic, to))?;
    let numbers = file.zip(layout);
    let numbers = numbers.map(|(file, layout)| NumberFile { file, layout });
    Ok(Converted {
        text,
        numbers,
        note,
    })
}
