//! The log that a pipe sends to standard input, whose path is `-`.

use crate::command::output::temporary::Temporary;
use allanite_log::failure::{Failure, Place};
use std::{
    borrow::Cow,
    io::{self, Write},
    path::Path,
    sync::{Mutex, PoisonError},
};

/// What standard input had, in a file, because a log is read several times. The file vanishes with the command.
static KEPT: Mutex<Option<Temporary>> = Mutex::new(None);

/// Whether this path stands for standard input.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The file with what standard input sends, or any other path as it is.
///
/// # Errors
/// When standard input cannot be read, or its file not be written.
pub(crate) fn as_file(path: &Path) -> Result<Cow<'_, Path>, Failure> {
    if !is_standard_input(path) {
        return Ok(path.into());
    }
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let file = match kept.take() {
        Some(file) => file,
        None => copied().map_err(|error| Place::file(path).io(&error))?,
    };
    Ok(kept.insert(file).path().to_owned().into())
}

fn copied() -> io::Result<Temporary> {
    let mut file = Temporary::create_in(&std::env::temp_dir())?;
    io::copy(&mut io::stdin().lock(), &mut file)?;
    file.flush()?;
    Ok(file)
}

/// Removes the file.
pub(crate) fn forget() {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).take();
}
