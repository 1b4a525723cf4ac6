//! What others build from and what they get: licences and sources of every crate, oldest versions, and images
//! that are the same bytes wherever they are built.

use crate::{
    firmware::{CORTEX_M4F, Core, Toolchain, cargo, workspace},
    step::step,
};
use anyhow::{Context as _, Result, bail, ensure};
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};
use tempfile::TempDir;

/// The rules of cargo-deny, in the workspace.
const RULES: &str = "host-tests/deny.toml";

/// The image that uses every part of the library.
const IMAGE: &str = "product";

/// Where an image and a program that others install say that the sources lie.
pub(crate) const SOURCES: &str = "/allanite";

/// Where cargo-deny takes the known vulnerabilities from.
const VULNERABILITIES: &str = "https://github.com/RustSec/advisory-db";

/// Checks licences, duplicates, sources and known vulnerabilities. These come from a clone of their database in a folder, or, if
/// none is named and it can be reached, from the database itself.
pub(crate) fn deny(database: Option<&Path>) -> Result<()> {
    if let Some(folder) = database {
        ensure!(
            folder.join("crates").is_dir() && folder.join(".git").exists(),
            "{} is no clone of the database of vulnerabilities: clone {VULNERABILITIES}",
            folder.display()
        );
    }
    if !succeeds(cargo().args(["deny", "--version"])) {
        step(
            "installing cargo-deny",
            cargo().args(["install", "--locked", "cargo-deny"]),
        )?;
    }
    let check = |what: &[&str]| {
        let mut command = cargo();
        command.args(["deny", "--offline", "--workspace", "--config", RULES]);
        command.arg("check").args(what);
        command
    };
    // The check reads every crate, also those of other systems.
    step("every crate", cargo().args(["fetch", "--locked"]))?;
    let heading = "licences, duplicates and sources";
    step(heading, &mut check(&["licenses", "bans", "sources"]))?;
    let mut fetch = cargo();
    fetch.args(["deny", "--config", RULES, "fetch", "db"]);
    if let Some(folder) = database {
        // It is cloned from the folder instead.
        let folder = fs::canonicalize(folder)?;
        fetch.env("GIT_CONFIG_COUNT", "1");
        fetch.env(
            "GIT_CONFIG_KEY_0",
            format!("url.file://{}.insteadOf", folder.display()),
        );
        fetch.env("GIT_CONFIG_VALUE_0", VULNERABILITIES);
    }
    if !succeeds(&mut fetch) {
        match database {
            Some(folder) => bail!(
                "the vulnerabilities in {} cannot be read: it must be a clone with the branch main",
                folder.display()
            ),
            None => println!(
                "\nThe known vulnerabilities are not checked, because their database cannot be reached: connect, or name a clone with --database."
            ),
        }
        return Ok(());
    }
    step("known vulnerabilities", &mut check(&["advisories"]))
}

/// Builds the library with the oldest versions that its `Cargo.toml` allows.
pub(crate) fn minimal_versions() -> Result<()> {
    let copy = Copy::new("tree")?;
    copy.library_alone()?;
    let nightly = |arguments: &[&str]| {
        let mut command = Command::new("rustup");
        command.args(["run", "nightly", "cargo"]).args(arguments);
        // Variables of the cargo that runs this program would select its compiler.
        command.env_remove("CARGO").env_remove("RUSTUP_TOOLCHAIN");
        command.current_dir(&copy.path);
        command
    };
    step(
        "the oldest versions",
        &mut nightly(&["update", "-Z", "direct-minimal-versions"]),
    )?;
    for features in [&["--all-features"][..], &["--features", "flash"], &[]] {
        let mut check = cargo();
        check.current_dir(&copy.path);
        check.env("CARGO_TARGET_DIR", copy.path.join("target"));
        check.args(["check", "--locked", "--package", "allanite"]);
        step("the library with them", check.args(features))?;
    }
    Ok(())
}

/// Builds an image twice from nothing, in folders of different names, and compares the bytes.
pub(crate) fn reproduce() -> Result<()> {
    let images = ["one", "another/folder"].map(|folder| Copy::new(folder)?.image(&CORTEX_M4F));
    let [first, second] = images;
    let (first, second) = (first?, second?);
    let differing = first.iter().zip(&second).filter(|(a, b)| a != b).count();
    ensure!(
        first == second,
        "{differing} of {} bytes of {IMAGE} differ, and {} bytes of the length: look for a path or a time in it",
        first.len(),
        first.len().abs_diff(second.len()),
    );
    println!("\n{IMAGE}: {} bytes, the same in both builds", first.len());
    Ok(())
}

/// The files that git knows, as they are now, in a folder of their own.
pub(crate) struct Copy {
    pub(crate) path: PathBuf,
    _folder: TempDir,
}

impl Copy {
    pub(crate) fn new(name: &str) -> Result<Self> {
        let folder = TempDir::new()?;
        let path = folder.path().join(name);
        let mut list = Command::new("git");
        list.args(["ls-files", "-z"]).current_dir(workspace());
        let output = list.output().context("git did not start: install it")?;
        let names = String::from_utf8(output.stdout)?;
        let names: Vec<_> = names.split_terminator('\0').collect();
        ensure!(!names.is_empty(), "git lists no files: run this in a clone");
        for name in names {
            let from = workspace().join(name);
            // A file that was deleted and not committed is listed.
            if from.is_file() {
                copy(&from, &path.join(name)).with_context(|| format!("copying {name}"))?;
            }
        }
        Ok(Self {
            path,
            _folder: folder,
        })
    }

    /// Leaves only the library in the workspace. The versions of the tools on the host are those of `Cargo.lock`.
    fn library_alone(&self) -> Result<()> {
        let path = self.path.join("Cargo.toml");
        let manifest = fs::read_to_string(&path)?;
        let is_members = |line: &&str| line.starts_with("members = ");
        ensure!(
            manifest.lines().filter(is_members).count() == 1,
            "Cargo.toml has not one line of members: write them on one line"
        );
        let lines = manifest.lines().map(|line| match is_members(&line) {
            true => "members = []\n".to_owned(),
            false => format!("{line}\n"),
        });
        fs::write(&path, lines.collect::<String>())?;
        fs::remove_file(self.path.join("Cargo.lock"))?;
        Ok(())
    }

    /// The bytes of the image, built here.
    fn image(&self, core: &Core) -> Result<Vec<u8>> {
        let target = self.path.join("target");
        let mut build = Toolchain::find(core)?.cargo_into("build", &target)?;
        let home = cargo_home()?;
        let flags = [(self.path.as_path(), SOURCES), (home.as_path(), "/cargo")]
            .map(|(path, name)| format!("--remap-path-prefix={}={name}", path.display()));
        build
            .current_dir(&self.path)
            .env(Toolchain::flags_variable(core), flags.join(" "));
        build.args(["--locked", "--package", "images", "--bin", IMAGE]);
        step(
            &format!("{IMAGE}, in {}", self.path.display()),
            build.args(["--profile", "firmware"]),
        )?;
        let path = target.join(core.target).join("firmware").join(IMAGE);
        fs::read(&path).with_context(|| format!("reading {}", path.display()))
    }
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    to.parent().map_or(Ok(()), fs::create_dir_all)?;
    fs::copy(from, to).map(drop)
}

/// The folder where cargo keeps the sources of crates.
pub(crate) fn cargo_home() -> Result<PathBuf> {
    let set = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let default = || std::env::home_dir().map(|home| home.join(".cargo"));
    match set.or_else(default) {
        Some(path) => Ok(path),
        None => bail!("cargo's folder is unknown: set CARGO_HOME"),
    }
}

fn succeeds(command: &mut Command) -> bool {
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}
