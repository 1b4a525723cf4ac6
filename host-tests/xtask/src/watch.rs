//! Watches a gyro that an image simulates in QEMU: runs the image, and sends its lines to `allanite watch`.

use crate::{
    firmware::{Image, cargo, host_target_directory, start},
    step::run,
};
use anyhow::{Context as _, Result, bail};
use std::{
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
};

/// The image that sends its counts as lines of text.
const IMAGE: &str = "stream";

/// Watches the image with these arguments of `watch`. Without a program, `allanite` is built first.
///
/// # Errors
/// When the image or the program does not build or start, or the program fails.
pub(crate) fn run_watch(program: Option<&Path>, arguments: &[String]) -> Result<()> {
    let program = match program {
        Some(program) => program.to_owned(),
        None => built()?,
    };
    // Ctrl-C reaches `watch` too, which saves the record and ends. This program waits for it.
    ctrlc::set_handler(|| ())?;
    let mut watch = Command::new(&program);
    let mut watched = Watched::start(watch.arg("watch").args(arguments))?;
    let status = watched.watch.wait()?;
    if !status.success() {
        bail!("`watch` ended with {status}");
    }
    Ok(())
}

/// An image in QEMU, and the program that watches it. The emulator ends with this, because the image sends for ever.
#[derive(Debug)]
pub struct Watched {
    emulator: Child,
    /// The program.
    pub watch: Child,
}

impl Watched {
    /// Builds and starts the image, and starts the program, whose standard input is what the image sends.
    ///
    /// # Errors
    /// When the image does not build, or one of both does not start.
    pub fn start(watch: &mut Command) -> Result<Self> {
        let mut emulator = start(&Image::build(IMAGE)?, &[])?;
        let lines = emulator.stdout.take();
        let started = lines
            .context("the emulator has no output")
            .and_then(|lines| {
                let watch = watch.stdin(Stdio::from(lines));
                watch
                    .spawn()
                    .with_context(|| format!("{watch:?} did not start"))
            });
        match started {
            Ok(watch) => Ok(Self { emulator, watch }),
            Err(error) => {
                end(&mut emulator);
                Err(error)
            }
        }
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        end(&mut self.emulator);
    }
}

/// Ends an emulator. An error is ignored, because an emulator that has ended cannot be killed.
fn end(emulator: &mut Child) {
    let _ = emulator.kill();
    let _ = emulator.wait();
}

/// Builds the program with what `watch` needs, and returns its path.
fn built() -> Result<PathBuf> {
    run(cargo()
        .args(["build", "--package", "allanite-cli"])
        .args(["--no-default-features", "--features", "watch"])
        .args(["--bin", "allanite"]))?;
    Ok(host_target_directory().join("debug/allanite"))
}
