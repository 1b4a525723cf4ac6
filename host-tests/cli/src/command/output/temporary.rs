//! Temporary files that vanish when they are dropped, and also when the program is interrupted.

use std::{
    collections::BTreeSet,
    fs::Metadata,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};
use tempfile::{Builder, NamedTempFile};

/// The paths of the temporary files that exist.
static EXISTING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The exit status of a program that was interrupted, by the convention of shells.
#[cfg(not(target_family = "wasm"))]
const INTERRUPTED: i32 = 130;

fn existing() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    EXISTING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Nothing interrupts a program in a page but the end of its worker, with which its files go.
#[cfg(target_family = "wasm")]
pub(crate) fn remove_when_interrupted() {}

/// From now on, an interruption (SIGINT, SIGTERM or SIGHUP) removes all temporary files and ends the
/// program. Where interruptions cannot be caught, they end the program as usual.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn remove_when_interrupted() {
    // A file beyond the limit of its size is an error of writing it, and no end of the program.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
    let _ = ctrlc::set_handler(|| {
        // The lock is held until the program has ended, so that no further file is created.
        let existing = existing();
        for path in existing.iter() {
            let _ = std::fs::remove_file(path);
        }
        std::process::exit(INTERRUPTED);
    });
}

/// A temporary file.
pub(crate) struct Temporary {
    /// The file, until it is moved away.
    file: Option<NamedTempFile>,
    path: PathBuf,
}

impl Temporary {
    /// Creates a file in a folder, with the permissions of any new file.
    pub(crate) fn create_in(folder: &Path) -> io::Result<Self> {
        Self::create(folder, None)
    }

    /// Creates a file in a folder that gets the permissions of the file that it is to replace, if there is one. It never
    /// has more, so that nobody reads a private file while it is written.
    pub(crate) fn create(folder: &Path, replaced: Option<&Metadata>) -> io::Result<Self> {
        #[cfg_attr(
            not(unix),
            expect(unused_mut, reason = "only Unix has permissions to set")
        )]
        let mut builder = Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The permissions of any new file, to which the process' mask applies. Without this line a
            // temporary file would be private.
            let mode = replaced.map_or(0o666, |file| file.permissions().mode() & 0o777);
            builder.permissions(std::fs::Permissions::from_mode(mode));
        }
        let mut existing = existing();
        let file = builder.tempfile_in(folder)?;
        if let Some(replaced) = replaced {
            // The process' mask may have taken some away. A file system without permissions has none to set.
            let _ = file.as_file().set_permissions(replaced.permissions());
        }
        let path = file.path().to_owned();
        existing.insert(path.clone());
        Ok(Self {
            file: Some(file),
            path,
        })
    }

    /// Where the file is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Moves the file to its final path and replaces a file that was there.
    pub(crate) fn move_to(mut self, path: &Path) -> io::Result<()> {
        match self.file.take() {
            Some(file) => file.persist(path).map(drop).map_err(|error| error.error),
            None => Ok(()),
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut existing = existing();
        drop(self.file.take());
        existing.remove(&self.path);
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), NamedTempFile::flush)
    }
}
