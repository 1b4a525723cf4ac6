//! Files that appear when they are complete, or not at all.

use crate::failure::{Failure, Place};
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};
use tempfile::{Builder, NamedTempFile};

/// A file under construction: beside its final place until [`commit`](Self::commit), gone if that
/// never comes.
pub(crate) struct OutputFile {
    path: PathBuf,
    temporary: NamedTempFile,
}

impl OutputFile {
    /// Starts a file.
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
            // What any new file gets, less the process' mask; a temporary file is private else.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let temporary = builder.tempfile_in(folder).map_err(|error| {
            if error.kind() == io::ErrorKind::NotFound {
                Place::file(path).failure("its folder does not exist", "make the folder first")
            } else {
                Place::file(path).io(&error)
            }
        })?;
        Ok(Self {
            path: path.to_owned(),
            temporary,
        })
    }

    /// Puts the file in its place, over one that was there.
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
