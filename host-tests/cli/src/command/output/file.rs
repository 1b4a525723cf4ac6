//! Output files that appear only when they are complete.

use super::temporary::Temporary;
use allanite_log::failure::{Failure, Place};
use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// The most symbolic links that are followed from one to the next.
const MOST_LINKS: usize = 40;

/// A file that is being written. A regular file is a temporary file in the folder of its final path
/// until [`commit`](Self::commit) moves it there; without that it is removed. A device or a pipe is
/// written to as it is. A symbolic link is followed, so that it remains. A file that is replaced keeps its permissions.
pub(crate) struct OutputFile {
    path: PathBuf,
    target: Target,
}

enum Target {
    /// A regular file that is complete only at the end, and its final path.
    Temporary(Temporary, PathBuf),
    /// Anything else.
    Through(File),
}

impl OutputFile {
    /// Starts a file. The inputs of the command are given, because none of them may be replaced.
    ///
    /// # Errors
    /// When the path is a directory or an input, or its folder does not exist or cannot be written to.
    pub(crate) fn create<'a>(
        path: &Path,
        inputs: impl IntoIterator<Item = &'a Path>,
    ) -> Result<Self, Failure> {
        let fail = |error: &io::Error| Place::file(path).io(error);
        let end = followed(path).map_err(|error| fail(&error))?;
        let there = end.metadata().ok();
        if there.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(Place::file(path).failure("is a directory", "name a file in it"));
        }
        if there.as_ref().is_some_and(|there| !there.is_file()) {
            let file = OpenOptions::new().write(true).open(&end);
            return Ok(Self {
                path: path.to_owned(),
                target: Target::Through(file.map_err(|error| fail(&error))?),
            });
        }
        if there.is_some() && inputs.into_iter().any(|input| are_same(input, &end)) {
            return Err(Place::file(path).failure(
                "the output is also the input, which would be lost",
                "name another output",
            ));
        }
        let is_locked = |there: &fs::Metadata| there.permissions().readonly();
        if there.as_ref().is_some_and(is_locked) {
            return Err(Place::file(path).failure(
                "is protected from writing",
                "name another output, or allow writing to it",
            ));
        }
        let folder = match end.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let temporary = Temporary::create(folder, there.as_ref()).map_err(|error| {
            if error.kind() == io::ErrorKind::NotFound {
                Place::file(path).failure("its folder does not exist", "create the folder first")
            } else {
                fail(&error)
            }
        })?;
        Ok(Self {
            path: path.to_owned(),
            target: Target::Temporary(temporary, end),
        })
    }

    /// Moves the file to its final path and replaces a file that was there.
    ///
    /// # Errors
    /// When the file cannot be written or moved.
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        let flushed = self.flush();
        let moved = match self.target {
            Target::Temporary(temporary, end) => flushed.and_then(|()| temporary.move_to(&end)),
            Target::Through(_) => flushed,
        };
        moved.map_err(|error| Place::file(&self.path).io(&error))
    }
}

/// The path that symbolic links lead to. There need not be a file.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            // A relative link begins in the folder of the link.
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Whether two paths lead to the same file, through links of any kind.
fn are_same(one: &Path, other: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let identity = |path: &Path| path.metadata().map(|file| (file.dev(), file.ino())).ok();
        identity(one).is_some_and(|one| identity(other) == Some(one))
    }
    #[cfg(not(unix))]
    {
        let identity = |path: &Path| path.canonicalize().ok();
        identity(one).is_some_and(|one| identity(other) == Some(one))
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.target {
            Target::Temporary(temporary, _) => temporary.write(bytes),
            Target::Through(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.target {
            Target::Temporary(temporary, _) => temporary.flush(),
            Target::Through(file) => file.flush(),
        }
    }
}
