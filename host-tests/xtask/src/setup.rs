//! Installs what this machine lacks to build and run the images and to test pages in a browser. It
//! prints what it does and asks no questions.

use crate::{
    firmware::{Way, c_library::ARM_GCC},
    page::OPTIMISER,
    step::run as run_command,
};
use anyhow::{Context as _, Result, bail};
use std::process::{Command, Stdio};

/// The remedy if nothing can be installed.
const BY_HAND: &str =
    "install it by hand: `rustup target add`, or Debian's packages rustc-web rust-web-src lld";
/// Debian's newer compiler, its library sources and its clippy.
const DEBIAN_COMPILER: [&str; 3] = ["rustc-web", "rust-web-src", "rust-web-clippy"];
/// Debian's linker, for machines where rustup brings none.
const DEBIAN_LINKER: &str = "lld";
/// Programs that the tests run, and the Debian packages that contain them.
const PROGRAMS: [(&str, &str); 7] = [
    ("qemu-system-arm", "qemu-system-arm"),
    ("qemu-system-riscv32", "qemu-system-misc"),
    (ARM_GCC, "gcc-arm-none-eabi"),
    ("cmake", "cmake"),
    (CHROMIUM, "chromium"),
    ("strace", "strace"),
    (OPTIMISER, "binaryen"),
];
/// The browser that the tests open pages with.
pub const CHROMIUM: &str = "chromium";

pub(crate) fn run() -> Result<()> {
    compiler()?;
    for (name, package) in PROGRAMS {
        program(name, package)?;
    }
    crate::hooks::activate()
}

/// Installs a compiler for every core, in the first way that works.
pub(crate) fn compiler() -> Result<()> {
    let mut troubles = Vec::new();
    for way in Way::allowed()? {
        match prepare(way) {
            Ok(()) => {
                println!("compiler for every core: {way}");
                return Ok(());
            }
            Err(error) => {
                println!("cannot use {way}: {error:#}");
                troubles.push(way.name());
            }
        }
    }
    bail!(
        "no compiler for every core from {}; {BY_HAND}",
        troubles.join(" or ")
    )
}

/// Installs what a way lacks.
fn prepare(way: Way) -> Result<()> {
    match way {
        Way::Rustup => {
            let targets = way.missing_targets();
            if !targets.is_empty() {
                println!("compiler for {}: asking rustup for it", targets.join(", "));
                run_command(
                    Command::new("rustup")
                        .args(["target", "add"])
                        .args(&targets),
                )?;
            }
            if !way.has_clippy() {
                println!("lints: asking rustup for them");
                run_command(Command::new("rustup").args(["component", "add", "clippy"]))?;
            }
        }
        Way::Debian => {
            if !(way.is_ready() && way.has_clippy()) {
                let packages = DEBIAN_COMPILER.join(" ");
                println!("compiler: installing Debian's packages {packages}");
                apt_get(&DEBIAN_COMPILER)?;
            }
            if !way.is_ready() {
                println!("linker: installing Debian's package {DEBIAN_LINKER}");
                apt_get(&[DEBIAN_LINKER])?;
            }
        }
    }
    match way.is_ready() {
        true => Ok(()),
        false if way == Way::Rustup => bail!("rustup serves another toolchain than the one in use"),
        false => bail!("Debian's compiler is too old, or lacks its sources"),
    }
}

/// Installs a program from a package of Debian, unless it is there.
fn program(program: &str, package: &str) -> Result<()> {
    if starts(program) {
        println!("{program}: is installed");
        return Ok(());
    }
    println!("{program}: installing Debian's package {package}");
    let by_hand = || format!("no {program}; install it by hand");
    apt_get(&[package]).with_context(by_hand)?;
    if starts(program) {
        Ok(())
    } else {
        bail!(by_hand())
    }
}

/// Whether rustup has this toolchain, or can get it.
pub(crate) fn has_toolchain(version: &str) -> bool {
    let rustup = |arguments: &[&str]| {
        let mut command = Command::new("rustup");
        command.args(arguments).stdin(Stdio::null());
        command
    };
    let mut there = rustup(&["run", version, "rustc", "--version"]);
    there.stdout(Stdio::null()).stderr(Stdio::null());
    if there.status().is_ok_and(|status| status.success()) {
        return true;
    }
    let install = [
        "toolchain",
        "install",
        version,
        "--profile",
        "minimal",
        "--no-self-update",
    ];
    run_command(&mut rustup(&install)).is_ok()
}

fn starts(program: &str) -> bool {
    let mut command = Command::new(program);
    command
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Installs packages, as root or through sudo without a password.
fn apt_get(packages: &[&str]) -> Result<()> {
    if !starts("apt-get") {
        bail!("this machine has no apt-get");
    }
    let prefix: &[&str] = if is_root() {
        &[]
    } else if starts("sudo") {
        &["sudo", "--non-interactive"]
    } else {
        bail!("apt-get wants root, and there is no sudo");
    };
    let command = |arguments: &[&str]| {
        let words = [
            prefix,
            &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"],
            arguments,
        ];
        let words = words.concat();
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).stdin(Stdio::null());
        command
    };
    run_command(&mut command(&["--quiet", "--quiet", "update"]))?;
    let install = [
        "--quiet",
        "--quiet",
        "install",
        "--yes",
        "--no-install-recommends",
    ];
    run_command(&mut command(&[&install, packages].concat()))
}

fn is_root() -> bool {
    let user = Command::new("id").arg("-u").output();
    user.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
