//! Opens the files that commands read. Only regular files are read: a pipe would be waited for without
//! end, and a device may never end.

use crate::failure::{Failure, Place};
use std::{fs::File, path::Path};

/// Opens a regular file at its beginning, and returns it with its length in bytes.
///
/// # Errors
/// When the path is no regular file, or the file cannot be opened.
pub fn open(path: &Path) -> Result<(File, u64), Failure> {
    let fail = |error| Place::file(path).io(&error);
    // A pipe is recognised before it is opened, because opening it waits for a writer.
    let metadata = path.metadata().map_err(fail)?;
    if metadata.is_dir() {
        return Err(Place::file(path).failure("is a directory", "name a file in it"));
    }
    if !metadata.is_file() {
        return Err(
            Place::file(path).failure("is not a regular file", "save its content as a file first")
        );
    }
    Ok((File::open(path).map_err(fail)?, metadata.len()))
}
