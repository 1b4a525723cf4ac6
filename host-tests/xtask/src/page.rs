//! Builds the page that reads logs without a server and without an installation: one file of HTML that carries the program
//! `allanite`, compiled for WebAssembly, and the system that it runs in.

use crate::{
    firmware::{cargo, target_directory, workspace},
    step::step,
    supply_chain::{SOURCES, cargo_home},
};
use anyhow::{Context as _, Result, ensure};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use std::{fs, io::Write as _, num::NonZeroU64, path::Path, process::Command};
use tempfile::NamedTempFile;

/// A program that reads and writes files, for a system that a page can be.
const TARGET: &str = "wasm32-wasip1";

/// The optimiser of Binaryen.
pub(crate) const OPTIMISER: &str = "wasm-opt";

/// The styles: those of a report, and what the page adds to them.
const STYLES: [&str; 3] = [
    "cli/src/report/page.css",
    "page/explore.css",
    "page/drop.css",
];

/// The scripts: the first ones are those of a report and draw figures; then the program, the records and their effects, and
/// what is dropped.
const SCRIPTS: [&str; 18] = [
    "cli/src/report/common.js",
    "cli/src/report/ticks.js",
    "cli/src/report/sheet.js",
    "cli/src/report/gloss.js",
    "cli/src/report/figure.js",
    "cli/src/report/legend.js",
    "cli/src/report/bars.js",
    "cli/src/report/plot.js",
    "cli/src/report/table.js",
    "cli/src/report/address.js",
    "page/program.js",
    "page/explore/state.js",
    "page/explore/records.js",
    "page/explore/controls.js",
    "page/explore/answer.js",
    "page/explore/time.js",
    "page/explore/explore.js",
    "page/drop.js",
];

/// How often the packer tries. Chosen by hand: more takes longer and hardly makes the program smaller.
const ITERATIONS: NonZeroU64 = NonZeroU64::new(3).unwrap();

/// What runs in a worker.
const WORKER: [&str; 2] = ["page/wasi.js", "page/worker.js"];

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
    build(workspace(), &target_directory().join("page"), output)
}

/// Builds the page from the sources in a folder.
///
/// # Errors
/// Those of [`page`].
pub(crate) fn build(root: &Path, built: &Path, output: &Path) -> Result<()> {
    let home = cargo_home()?;
    let names = [(root, SOURCES), (&*home, "/cargo")];
    let mut flags = names
        .map(|(path, name)| format!("--remap-path-prefix={}={name}", path.display()))
        .to_vec();
    // What only commands of a workstation use is left out of the page.
    flags.push("-Adead_code".to_owned());
    step(
        "the program for the page",
        cargo()
            .current_dir(root)
            .args(["build", "--profile", "page", "--target", TARGET])
            .args(["--package", "allanite-cli", "--no-default-features"])
            .args(["--bin", "allanite", "--target-dir"])
            .arg(built)
            .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f")),
    )?;
    let program = built.join(TARGET).join("page/allanite.wasm");
    let packed = packed(&program)?;
    let folder = root.join("host-tests");
    let joined = |names: &[&str]| {
        let texts = names.iter().map(|name| read(&folder.join(name)));
        anyhow::Ok(texts.collect::<Result<Vec<_>>>()?.join("\n"))
    };
    let page = joined(&["page/page.html"])?
        .replace("{{version}}", env!("CARGO_PKG_VERSION"))
        .replace("{{style}}", joined(&STYLES)?.trim())
        .replace("{{worker}}", joined(&WORKER)?.trim())
        .replace("{{script}}", joined(&SCRIPTS)?.trim())
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

/// A program in the form that every browser unpacks, by the packer that makes it smallest. What was packed before is kept beside
/// the program, because packing takes some seconds.
fn packed(program: &Path) -> Result<Vec<u8>> {
    let place = program.with_extension("wasm.gz");
    let changed = |path: &Path| path.metadata().and_then(|there| there.modified());
    if let (Ok(packed), Ok(built)) = (changed(&place), changed(program))
        && packed > built
    {
        return fs::read(&place).with_context(|| place.display().to_string());
    }
    let text = smaller(program)?;
    let mut packed = Vec::new();
    let packer = zopfli::Options {
        iteration_count: ITERATIONS,
        ..zopfli::Options::default()
    };
    zopfli::compress(packer, zopfli::Format::Gzip, &*text, &mut packed)?;
    // Another process may pack the same: each writes a file of its own, and the last one stays.
    let folder = place.parent().unwrap_or(Path::new("."));
    let mut file = NamedTempFile::new_in(folder)?;
    file.write_all(&packed)?;
    file.persist(&place)?;
    Ok(packed)
}

/// What the compiler may emit for the target, so that the optimiser reads it.
const WASM_FEATURES: [&str; 6] = [
    "--enable-bulk-memory",
    "--enable-multivalue",
    "--enable-mutable-globals",
    "--enable-nontrapping-float-to-int",
    "--enable-reference-types",
    "--enable-sign-ext",
];

/// The program after the optimiser, which takes 3 % off its packed size. It changes no result: floats follow the standard.
/// Without it, the page is larger and does the same.
fn smaller(program: &Path) -> Result<Vec<u8>> {
    let optimised = NamedTempFile::new()?;
    let mut optimise = Command::new(OPTIMISER);
    optimise.arg("-Oz").args(WASM_FEATURES).arg(program);
    optimise.arg("-o").arg(optimised.path());
    let smaller = match optimise.status() {
        Ok(status) => {
            ensure!(status.success(), "{OPTIMISER} failed ({status})");
            optimised.path()
        }
        Err(_) => {
            println!(
                "      the page is 3 % larger without {OPTIMISER}, which Debian's package binaryen has"
            );
            program
        }
    };
    fs::read(smaller).with_context(|| smaller.display().to_string())
}

/// Reads a file without the lines that are comments alone and without the blanks at the begin of lines.
fn read(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let lines = text.lines().map(str::trim);
    // The rule of CSS for all elements begins as a comment goes on.
    let is_comment = |line: &str| {
        let begins = |begin: &&str| line.starts_with(*begin);
        ["//", "/*", "*"].iter().any(begins) && !line.starts_with("* {")
    };
    let kept: Vec<&str> = lines
        .filter(|line| !line.is_empty() && !is_comment(line))
        .collect();
    Ok(kept.join("\n"))
}
