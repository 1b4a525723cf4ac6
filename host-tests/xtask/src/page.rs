//! Builds the page that reads logs without a server and without an installation: one file of HTML that carries the program
//! `allanite`, compiled for WebAssembly, and the system that it runs in.

use crate::{
    firmware::{cargo, target_directory, workspace},
    step::step,
};
use anyhow::{Context as _, Result};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use flate2::{Compression, write::GzEncoder};
use std::{fs, io::Write as _, path::Path, process::Command};

/// A program that reads and writes files, for a system that a page can be.
const TARGET: &str = "wasm32-wasip1";

/// Installs the compiler for pages, which rustup alone has.
///
/// # Errors
/// When rustup is missing, or cannot add the target.
pub fn compiler() -> Result<()> {
    step(
        "the compiler for pages",
        Command::new("rustup").args(["target", "add", TARGET]),
    )
}

/// Builds the page.
///
/// # Errors
/// When rustup cannot add the target, a file cannot be read or written, or the program does not build.
pub fn page(output: &Path) -> Result<()> {
    compiler()?;
    let built = target_directory().join("page");
    step(
        "the program for the page",
        cargo()
            .args(["build", "--profile", "page", "--target", TARGET])
            .args(["--package", "host-tests", "--no-default-features"])
            .args(["--bin", "allanite", "--target-dir"])
            .arg(&built)
            // What only commands of a workstation use is left out of the page.
            .env("RUSTFLAGS", "-A dead_code"),
    )?;
    let program = built.join(TARGET).join("page/allanite.wasm");
    let program = fs::read(&program).with_context(|| program.display().to_string())?;
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&program)?;
    let packed = packed.finish()?;
    let folder = workspace().join("host-tests/page");
    let text = |name: &str| read(&folder.join(name));
    let worker = text("wasi.js")? + &text("worker.js")?;
    let page = text("page.html")?
        .replace("{{style}}", text("page.css")?.trim())
        .replace("{{worker}}", worker.trim())
        .replace("{{script}}", text("page.js")?.trim())
        .replace("{{program}}", &BASE64_STANDARD.encode(&packed));
    if let Some(folder) = output.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(output, &page).with_context(|| output.display().to_string())?;
    println!(
        "{}: {:.2} MB, of which the program is {:.2} MB, packed",
        output.display(),
        page.len() as f64 / 1e6,
        packed.len() as f64 / 1e6
    );
    Ok(())
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| path.display().to_string())
}
