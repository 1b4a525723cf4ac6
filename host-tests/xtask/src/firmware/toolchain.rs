//! Finds the compiler for the cores, and the `core` library that it uses.
//!
//! rustup installs a `core` that is compiled for speed, whereas cargo compiles Debian's sources of
//! it for size. An image therefore has different sizes in the two ways. All cores are built the
//! same way, and each way has its own budgets.

use super::{CORES, Core, Precision, REMEDY, cargo};
use anyhow::{Context as _, Result, bail};
use std::{
    fmt,
    path::{Path, PathBuf},
    process::Command,
};

/// Debian's compiler from the package `rustc-web`, which is newer than the release's own compiler.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_RUSTDOC: &str = "/usr/bin/rustdoc";
const DEBIAN_CLIPPY: &str = "/usr/bin/cargo-clippy";

/// The oldest minor version that compiles this package: `rust-version` in its `Cargo.toml`.
const OLDEST_MINOR: u32 = 95;

/// The environment variable that selects a way by its name.
const VARIABLE: &str = "ALLANITE_TOOLCHAIN";

/// A way to get a compiler and `core` for every core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The compiler in use, with the `core` that `rustup target add` installs.
    Rustup,
    /// Debian's compiler, which builds `core` from Debian's sources.
    Debian,
}

impl Way {
    /// Both ways, the preferred one first.
    pub const ALL: [Self; 2] = [Self::Rustup, Self::Debian];

    /// The name of the way in `ALLANITE_TOOLCHAIN` and in the file of budgets.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rustup => "rustup",
            Self::Debian => "debian",
        }
    }

    /// The ways that may be used: the one that `ALLANITE_TOOLCHAIN` names, or both if it is not
    /// set.
    ///
    /// # Errors
    /// Fails if the variable does not name a way.
    pub fn allowed() -> Result<Vec<Self>> {
        match std::env::var_os(VARIABLE) {
            Some(name) => Ok(vec![Self::named(&name.to_string_lossy())?]),
            None => Ok(Self::ALL.to_vec()),
        }
    }

    fn named(name: &str) -> Result<Self> {
        let mut ways = Self::ALL.into_iter();
        let way = ways.find(|way| way.name() == name);
        way.with_context(|| {
            format!(
                "{VARIABLE}={name:?} is not a known toolchain: set rustup or debian, or unset it"
            )
        })
    }

    /// The way that builds images on this machine: the first of those allowed that is ready for
    /// every core.
    ///
    /// # Errors
    /// Fails if no way is ready, or if `ALLANITE_TOOLCHAIN` does not name a way.
    pub fn in_use() -> Result<Self> {
        let mut ways = Self::allowed()?.into_iter();
        let way = ways.find(|way| way.is_ready());
        way.with_context(|| format!("no compiler for every core is installed: {REMEDY}"))
    }

    /// Whether a compiler, `core` and a linker are installed for every core.
    pub fn is_ready(self) -> bool {
        match self {
            Self::Rustup => self.missing_targets().is_empty(),
            Self::Debian => debian_has_sources() && linker().is_some(),
        }
    }

    /// The targets that `rustup target add` still has to install. Debian's way needs none.
    pub fn missing_targets(self) -> Vec<&'static str> {
        let mut targets: Vec<_> = CORES.iter().map(|core| core.target).collect();
        targets.dedup();
        targets.retain(|target| self == Self::Rustup && !has_target(target));
        targets
    }

    /// Whether clippy is installed.
    pub fn has_clippy(self) -> bool {
        match self {
            Self::Rustup => answer("cargo", &["clippy", "--version"]).is_some(),
            Self::Debian => Path::new(DEBIAN_CLIPPY).exists(),
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rustup => "rustup's (core compiled for speed)",
            Self::Debian => "Debian's (core compiled for size)",
        })
    }
}

/// A way to build for one core.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toolchain {
    core: Core,
    way: Way,
}

impl Toolchain {
    /// The toolchain in use.
    ///
    /// # Errors
    /// The errors are those of [`Way::in_use`].
    pub fn find(core: &Core) -> Result<Self> {
        let way = Way::in_use()?;
        Ok(Self { core: *core, way })
    }

    /// A cargo command such as `build` or `clippy` for the target, whose artefacts go to [`artefacts`].
    ///
    /// # Errors
    /// Fails if the linker is missing.
    pub fn cargo(&self, subcommand: &str) -> Result<Command> {
        self.cargo_into(subcommand, &artefacts(self.core.precision))
    }

    /// A cargo command whose artefacts go to a folder.
    ///
    /// # Errors
    /// Fails if the linker is missing.
    pub fn cargo_into(&self, subcommand: &str, artefacts: &Path) -> Result<Command> {
        let mut command = self.cargo_for(subcommand, &[self.core])?;
        command.arg("--target-dir").arg(artefacts);
        Ok(command)
    }

    /// A cargo command for the targets of several cores, which are built at once.
    fn cargo_for(&self, subcommand: &str, cores: &[Core]) -> Result<Command> {
        let mut command = match self.way {
            Way::Rustup => {
                let mut command = cargo();
                command.arg(subcommand);
                command
            }
            Way::Debian => match linker() {
                Some(linker) => debian(subcommand, &linker, cores),
                None => bail!("no linker: {REMEDY}"),
            },
        };
        // Each of these variables would override `.cargo/config.toml`.
        for variable in [
            "RUSTFLAGS",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_BUILD_RUSTFLAGS",
            "CARGO_BUILD_TARGET",
        ] {
            command.env_remove(variable);
        }
        let mut targets: Vec<&str> = Vec::new();
        for core in cores {
            if targets.contains(&core.target) {
                continue;
            }
            targets.push(core.target);
            command.args(["--target", core.target]);
            if let Some(board) = core.board {
                let flags = format!("-C link-arg=--defsym={board}=1");
                command.env(Self::flags_variable(core), flags);
            }
        }
        command.env("DEFMT_LOG", "info");
        Ok(command)
    }

    /// A cargo command that builds for several cores of one precision at once, into [`artefacts`].
    ///
    /// # Errors
    /// Fails if no core is given, or if no compiler or linker is installed.
    pub fn cargo_for_all(subcommand: &str, cores: &[Core]) -> Result<Command> {
        let first = cores.first().context("no core is given")?;
        let mut command = Self::find(first)?.cargo_for(subcommand, cores)?;
        command.arg("--target-dir").arg(artefacts(first.precision));
        Ok(command)
    }

    /// The environment variable with flags of the compiler for a core, beside those of `.cargo/config.toml`.
    pub fn flags_variable(core: &Core) -> String {
        variable(core.target, "RUSTFLAGS")
    }
}

/// A command of Debian's cargo, or of its clippy, which must belong to the same compiler.
fn debian(subcommand: &str, linker: &Path, cores: &[Core]) -> Command {
    let mut command = if subcommand == "clippy" {
        let mut command = Command::new(DEBIAN_CLIPPY);
        command.current_dir(super::workspace());
        command
    } else {
        cargo()
    };
    command
        .arg(subcommand)
        .env("RUSTC", DEBIAN_RUSTC)
        .env("RUSTDOC", DEBIAN_RUSTDOC)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("CARGO_UNSTABLE_BUILD_STD", "core");
    for core in cores {
        command.env(variable(core.target, "LINKER"), linker);
    }
    command
}

/// A folder for what is built beside the programs of the host, below the target folder in use. The cargo that runs this program may
/// hold the lock of the host's folder.
pub fn target_directory() -> PathBuf {
    host_target_directory().join("image")
}

/// The folder for the artefacts of a precision, for the cores and for this host. An image has the same name in both precisions, and
/// cargo locks a folder while it builds.
pub fn artefacts(precision: Precision) -> PathBuf {
    target_directory().join(precision.name())
}

/// The folder into which programs of the host are built.
pub fn host_target_directory() -> PathBuf {
    let base = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    super::workspace().join(base)
}

/// The environment variable that sets a key of cargo's configuration for a target.
fn variable(target: &str, key: &str) -> String {
    let target = target.replace(['-', '.'], "_").to_uppercase();
    format!("CARGO_TARGET_{target}_{key}")
}

/// The first line that a program prints, if it runs successfully.
fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let line = text.lines().next().map(str::to_owned);
    line.filter(|_| output.status.success())
}

fn rustc() -> String {
    std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into())
}

fn has_target(target: &str) -> bool {
    let arguments = ["--print", "target-libdir", "--target", target];
    let Some(folder) = answer(&rustc(), &arguments) else {
        return false;
    };
    let is_core = |name: &str| name.starts_with("libcore-") && name.ends_with(".rlib");
    std::fs::read_dir(folder).is_ok_and(|mut files| {
        files.any(|file| file.is_ok_and(|file| file.file_name().to_str().is_some_and(is_core)))
    })
}

/// Whether Debian's compiler is new enough and the sources of `core` are installed.
fn debian_has_sources() -> bool {
    let new_enough = answer(DEBIAN_RUSTC, &["--version"])
        .as_deref()
        .and_then(minor_version)
        .is_some_and(|minor| minor >= OLDEST_MINOR);
    let sources = answer(DEBIAN_RUSTC, &["--print", "sysroot"]).is_some_and(|root| {
        let library = Path::new(&root).join("lib/rustlib/src/rust/library");
        library.join("core/Cargo.toml").exists()
    });
    new_enough && sources
}

/// The minor version, such as 96 for `rustc 1.96.0 (…)`.
fn minor_version(version: &str) -> Option<u32> {
    let number = version.split(' ').nth(1)?.strip_prefix("1.")?;
    number.split('.').next()?.parse().ok()
}

/// The linker in rustup's host toolchain, or else one on the path.
fn linker() -> Option<PathBuf> {
    let bundled = answer(&rustc(), &["--print", "target-libdir"])
        .map(|libraries| Path::new(&libraries).with_file_name("bin").join("rust-lld"))
        .filter(|linker| linker.exists());
    let on_path = |name: &str| answer(name, &["--version"]).map(|_| PathBuf::from(name));
    bundled.or_else(|| on_path("ld.lld"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        assert_eq!(
            minor_version("rustc 1.96.0 (ac68faa20 2026-05-25)"),
            Some(96)
        );
        assert_eq!(minor_version("rustc 1.63.0"), Some(63));
        assert_eq!(minor_version("error"), None);
    }

    #[test]
    fn names_of_ways_are_accepted_and_others_refused_in_one_line() {
        for way in Way::ALL {
            assert_eq!(Way::named(way.name()).unwrap(), way);
        }
        for name in ["", "Debian", "nightly\n"] {
            let said = Way::named(name).unwrap_err().to_string();
            assert!(said.contains("rustup or debian"), "{said}");
            assert!(!said.contains('\n'), "{said}");
        }
    }

    #[test]
    fn the_linker_variable_has_the_name_that_cargo_expects() {
        assert_eq!(
            variable("thumbv8m.main-none-eabihf", "LINKER"),
            "CARGO_TARGET_THUMBV8M_MAIN_NONE_EABIHF_LINKER"
        );
    }
}
