//! A folder whose files of text are the parts of one record, as loggers write them that begin a new file every hour.

use super::{
    part_names::{files, name},
    preamble::Preamble,
    source,
};
use crate::failure::{Failure, Place, one_line};
use indicatif::ProgressBar;
use std::{
    io::{self, BufWriter, Write as _},
    path::Path,
};
use tempfile::{NamedTempFile, TempPath};

/// Writes the rows of the parts one after the other below the head of the first, and tells which parts they are.
///
/// # Errors
/// When the parts have different columns.
pub(super) fn join(folder: &Path, progress: &ProgressBar) -> Result<(TempPath, String), Failure> {
    let parts = files(folder);
    let io = |error: &io::Error| Place::file(folder).io(error);
    let joined = NamedTempFile::new().map_err(|error| io(&error))?;
    let mut joined = BufWriter::new(joined);
    let mut head: Option<Preamble> = None;
    for part in &parts {
        let gzip = name(part).to_lowercase().ends_with(".gz");
        let preamble = Preamble::read(part, part, gzip)?;
        let mut text = source::open_text(part, gzip, progress)?;
        let start = match &head {
            None => 0,
            Some(first) if (&first.names, first.width) == (&preamble.names, preamble.width) => {
                preamble.start
            }
            Some(_) => {
                return Err(Place::file(part).failure(
                    format!(
                        "its columns are not those of {}",
                        one_line(&name(&parts[0]))
                    ),
                    "put only the parts of one record into the folder, or name the file",
                ));
            }
        };
        let mut copy = || {
            io::copy(&mut io::Read::take(&mut text, start), &mut io::sink())?;
            io::copy(&mut text, &mut joined)?;
            match source::ends_with_line(part) {
                Ok(false) if !gzip => joined.write_all(b"\n"),
                _ => Ok(()),
            }
        };
        copy().map_err(|error| source::text_failure(Place::file(part), gzip, &error))?;
        head.get_or_insert(preamble);
    }
    let joined = joined.into_inner().map_err(|error| io(error.error()))?;
    let note = match &parts[..] {
        [first, .., last] => format!(
            "{} files, {} to {}, are the parts of one record",
            parts.len(),
            one_line(&name(first)),
            one_line(&name(last))
        ),
        parts => parts.iter().map(|part| one_line(&name(part))).collect(),
    };
    Ok((joined.into_temp_path(), note))
}
