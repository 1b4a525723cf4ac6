//! Output files that appear only when they are complete.

use crate::failure::{Failure, Place};
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};
use tempfile::{Builder, NamedTempFile};

/// A file that is being written. It is a temporary file in the folder of its final path until
/// [`commit`](Self::commit) moves it there; without that it is removed.
pub(crate) struct OutputFile {
    path: PathBuf,
    temporary: NamedTempFile,
}

impl OutputFile {
    /// Starts a file.
    ///
    /// # Errors
    /// When the path is a directory, or its folder does not exist or cannot be written to.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        if path.is_dir() {
            return Err(Place::file(path).failure("is a directory", "name a file in it"));
        }
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let mut builder = Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The permissions of any new file, to which the process' mask applies. Without this line a
            // temporary file would be private.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let temporary = builder.tempfile_in(folder).map_err(|error| {
            if error.kind() == io::ErrorKind::NotFound {
                Place::file(path).failure("its folder does not exist", "create the folder first")
            } else {
                Place::file(path).io(&error)
            }
        })?;
        Ok(Self {
            path: path.to_owned(),
            temporary,
        })
    }

    /// Moves the file to its final path and replaces a file that was there.
    ///
    /// # Errors
    /// When the file cannot be written or moved.
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        let fail = |error: &io::Error| Place::file(&self.path).io(error);
        self.temporary.flush().map_err(|error| fail(&error))?;
        self.temporary
            .persist(&self.path)
            .map_err(|error| fail(&error.error))?;
        Ok(())
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.temporary.flush()
    }
}
