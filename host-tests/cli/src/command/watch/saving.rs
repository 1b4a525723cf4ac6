//! Where a recording is saved: in the file that is asked for, or in a second place as long as that fails.

use crate::command::output::file::OutputFile;
use allanite_host::curve_file::{AxisCurve, CurveFile};
use allanite_log::failure::{Failure, Place, one_line};
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    time::Instant,
};
use tempfile::{Builder, NamedTempFile};

/// The saving of a recording.
pub(super) struct Saving {
    path: Option<PathBuf>,
    /// The file in the temporary folder, if there is one.
    second: Option<PathBuf>,
    saved: Option<Instant>,
    /// The message of the last saving, if it failed.
    trouble: Option<String>,
}

impl Saving {
    /// Saves to this file, or nothing without one.
    pub(super) const fn new(path: Option<PathBuf>) -> Self {
        Self {
            path,
            second: None,
            saved: None,
            trouble: None,
        }
    }

    /// Saves curves as a complete file, if there is an output.
    ///
    /// # Errors
    /// When the output cannot be written. The message names the second place, where the curves are then.
    pub(super) fn save(&mut self, curves: Vec<AxisCurve>) -> Result<(), Failure> {
        let Some(path) = self.path.clone() else {
            return Ok(());
        };
        let json = CurveFile::new(curves).to_json();
        let json = json.map_err(|error| Place::file(&path).io(&error.into()))?;
        let saved = write(&path, &json).map_err(|failure| match self.write_second(&path, &json) {
            Ok(second) => failure.and(&format!("the record is in {}", shown(&second))),
            Err(error) => failure.and(&format!("the temporary folder fails too: {error}")),
        });
        match &saved {
            Ok(()) => {
                self.saved = Some(Instant::now());
                if let Some(second) = self.second.take() {
                    // A file that is not there any more is no trouble.
                    let _ = std::fs::remove_file(second);
                }
            }
            Err(failure) => self.trouble = Some(failure.to_string()),
        }
        if saved.is_ok() {
            self.trouble = None;
        }
        saved
    }

    /// The message of the last saving, if it failed.
    pub(super) fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// A sentence that tells where and when the recording was saved.
    pub(super) fn sentence(&self) -> String {
        one_line(&match (&self.trouble, &self.path, self.saved) {
            (Some(trouble), ..) => format!("not saved: {trouble}"),
            (None, None, _) => "not saved: --output was not given".into(),
            (None, Some(path), None) => format!("{} is not saved yet", path.display()),
            (None, Some(path), Some(at)) => {
                let seconds = at.elapsed().as_secs();
                format!("{} was saved {seconds} s ago", path.display())
            }
        })
    }

    /// Writes to a file of its own in the temporary folder, and returns its path.
    fn write_second(&mut self, path: &Path, json: &str) -> io::Result<PathBuf> {
        let folder = std::env::temp_dir();
        let mut file = NamedTempFile::new_in(&folder)?;
        file.write_all(json.as_bytes())?;
        let second = match &self.second {
            Some(second) => second.clone(),
            None => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let mut name = Builder::new();
                let reserved = name
                    .prefix(&format!("{stem}-"))
                    .suffix(".json")
                    .tempfile_in(&folder)?;
                reserved.into_temp_path().keep()?
            }
        };
        file.persist(&second)?;
        self.second = Some(second.clone());
        Ok(second)
    }
}

fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy())
}

fn write(path: &Path, json: &str) -> Result<(), Failure> {
    let mut file = OutputFile::create(path, [])?;
    let written = file.write_all(json.as_bytes());
    written.map_err(|error| Place::file(path).io(&error))?;
    file.commit()
}
