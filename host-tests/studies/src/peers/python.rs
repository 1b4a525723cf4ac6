//! A virtual environment of Python with packages of pinned versions.

use anyhow::{Context as _, Result, ensure};
use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The folder with the programs that run the peers.
pub(super) const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/peers");

/// A virtual environment.
pub struct Python(PathBuf);

impl Python {
    /// Makes an environment in this folder, unless it has one.
    ///
    /// # Errors
    /// When Python is not installed, or the folder cannot be written.
    pub fn new(folder: &Path) -> Result<Self> {
        fs::create_dir_all(folder)?;
        let environment = folder.join("venv");
        let python = environment.join("bin/python");
        if !python.exists() {
            run("python3", &["-m", "venv", &text(&environment)])?;
        }
        Ok(Self(python))
    }

    /// Installs packages, given as arguments of pip.
    pub(super) fn install(&self, packages: &[&str]) -> Result<()> {
        run(
            &self.0,
            &[&["-m", "pip", "install", "--quiet"][..], packages].concat(),
        )
    }

    /// Installs what a list in the folder of the peers names.
    ///
    /// # Errors
    /// When a package cannot be installed.
    pub fn install_all(&self, list: &str) -> Result<()> {
        self.install(&["-r", &format!("{FOLDER}/{list}")])
    }

    /// A program in the folder of the peers.
    #[must_use]
    pub fn command(&self, script: &str) -> Command {
        let mut command = Command::new(&self.0);
        command.arg(format!("{FOLDER}/{script}"));
        command
    }
}

/// Runs a program that prints nothing of interest.
pub(super) fn run(program: impl AsRef<OsStr>, arguments: &[&str]) -> Result<()> {
    let output = Command::new(&program).args(arguments).output();
    let output = output.with_context(|| program.as_ref().to_string_lossy().into_owned())?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{errors}");
    Ok(())
}

pub(super) fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
