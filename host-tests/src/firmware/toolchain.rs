//! Which compiler can build for the target.

use super::{Core, cargo};
use anyhow::{Context as _, Result};
use std::{
    fs::File,
    path::{Path, PathBuf},
    process::Command,
};

/// Debian's compiler: `rustc-web`, newer than the release's own.
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_RUSTDOC: &str = "/usr/bin/rustdoc";
const DEBIAN_CLIPPY: &str = "/usr/bin/cargo-clippy";

/// The oldest that compiles this package: `rust-version` in its `Cargo.toml`.
const OLDEST_MINOR: u32 = 95;

/// A way to build for a core.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toolchain {
    core: Core,
    origin: Origin,
}

/// Where a compiler comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The compiler in use has the target's libraries: those of `rustup target add`.
    Installed,
    /// Debian's compiler builds the target's libraries from Debian's sources.
    Debian {
        /// The linker.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// The first that this machine has.
    pub fn find(core: &Core) -> Option<Self> {
        let of = |origin| Self {
            core: *core,
            origin,
        };
        if has_target(core.target) {
            return Some(of(Origin::Installed));
        }
        let linker = linker()?;
        debian_has_sources().then(|| of(Origin::Debian { linker }))
    }

    /// Where it comes from.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// A cargo command such as `build` or `clippy` for the target, with artefacts apart from those
    /// of the host: the cargo that runs this program may hold the lock of the others.
    pub fn cargo(&self, subcommand: &str) -> Command {
        let mut command = match &self.origin {
            Origin::Installed => {
                let mut command = cargo();
                command.arg(subcommand);
                command
            }
            Origin::Debian { linker } => self.debian(subcommand, linker),
        };
        // Any of these would replace what `.cargo/config.toml` says.
        for variable in [
            "RUSTFLAGS",
            "CARGO_ENCODED_RUSTFLAGS",
            "CARGO_BUILD_RUSTFLAGS",
            "CARGO_BUILD_TARGET",
        ] {
            command.env_remove(variable);
        }
        if let Some(board) = self.core.board {
            let flags = format!("-C link-arg=--defsym={board}=1");
            command.env(variable(self.core.target, "RUSTFLAGS"), flags);
        }
        command
            .args(["--target", self.core.target])
            .arg("--target-dir")
            .arg(target_directory())
            .env("DEFMT_LOG", "info");
        command
    }

    fn debian(&self, subcommand: &str, linker: &Path) -> Command {
        let mut command = if subcommand == "clippy" {
            // The lints must come with the compiler.
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
            .env("CARGO_UNSTABLE_BUILD_STD", "core")
            .env(variable(self.core.target, "LINKER"), linker);
        command
    }

    /// Whether its lints are there.
    pub fn has_clippy(&self) -> bool {
        match &self.origin {
            Origin::Installed => true,
            Origin::Debian { .. } => Path::new(DEBIAN_CLIPPY).exists(),
        }
    }
}

/// A folder of its own, below the target folder in use.
pub fn target_directory() -> PathBuf {
    let base = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    super::workspace().join(base).join("image")
}

/// Keeps other programs from building there, as long as it is held.
///
/// # Errors
/// If the folder cannot be written.
pub fn exclusive() -> Result<File> {
    let folder = target_directory();
    let lock = || -> std::io::Result<File> {
        std::fs::create_dir_all(&folder)?;
        let file = File::create(folder.join("images.lock"))?;
        file.lock()?;
        Ok(file)
    };
    lock().with_context(|| format!("locking {}", folder.display()))
}

/// The variable that sets one of cargo's keys of a target.
fn variable(target: &str, key: &str) -> String {
    let target = target.replace(['-', '.'], "_").to_uppercase();
    format!("CARGO_TARGET_{target}_{key}")
}

/// The first line that a program prints, if it runs and succeeds.
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

/// Whether Debian's compiler is new enough and has the sources of `core`.
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

/// 96 of `rustc 1.96.0 (…)`.
fn minor_version(version: &str) -> Option<u32> {
    let number = version.split(' ').nth(1)?.strip_prefix("1.")?;
    number.split('.').next()?.parse().ok()
}

/// The linker that rustup's host toolchain brings, or one on the path.
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
    fn the_linker_is_named_as_cargo_wants() {
        assert_eq!(
            variable("thumbv8m.main-none-eabihf", "LINKER"),
            "CARGO_TARGET_THUMBV8M_MAIN_NONE_EABIHF_LINKER"
        );
    }
}
