//! What this machine lacks to build and run the images, and to look at pages. Says what it does,
//! asks nothing.

use super::step::run as run_command;
use crate::firmware::{CORES, Core, Toolchain, toolchain::Origin};
use anyhow::{Context as _, Result, bail};
use std::process::{Command, Stdio};

/// Debian's newer compiler, its library sources and its lints.
const DEBIAN_COMPILER: [&str; 3] = ["rustc-web", "rust-web-src", "rust-web-clippy"];
/// Its linker, where rustup brings none.
const DEBIAN_LINKER: &str = "lld";
/// Programs that the tests run, and Debian's packages that have them.
const PROGRAMS: [(&str, &str); 3] = [
    ("qemu-system-arm", "qemu-system-arm"),
    ("qemu-system-riscv32", "qemu-system-misc"),
    (CHROMIUM, "chromium"),
];
/// The browser that the tests look at pages with.
pub const CHROMIUM: &str = "chromium";

pub(super) fn run() -> Result<()> {
    for core in &CORES {
        compiler(core)?;
    }
    for (name, package) in PROGRAMS {
        program(name, package)?;
    }
    Ok(())
}

fn compiler(core: &Core) -> Result<()> {
    let target = core.target;
    match Toolchain::find(core) {
        Some(toolchain) if toolchain.has_clippy() => {
            println!("compiler for {target}: {}", name(&toolchain));
            return Ok(());
        }
        Some(_) => {}
        None => {
            println!("compiler for {target}: missing, asking rustup for it");
            let mut rustup = Command::new("rustup");
            match run_command(rustup.args(["target", "add", target])) {
                Ok(()) if Toolchain::find(core).is_some() => return Ok(()),
                Ok(()) => println!("rustup added it to another toolchain than the one in use"),
                Err(error) => println!("{error:#}"),
            }
        }
    }
    let packages = DEBIAN_COMPILER.join(" ");
    println!("compiler for {target}: installing Debian's packages {packages}");
    let installed = apt_get(&DEBIAN_COMPILER).and_then(|()| {
        if Toolchain::find(core).is_some() {
            return Ok(());
        }
        println!("linker: installing Debian's package {DEBIAN_LINKER}");
        apt_get(&[DEBIAN_LINKER])
    });
    let by_hand = format!(
        "install it by hand: `rustup target add {target}`, or Debian's packages {packages} {DEBIAN_LINKER}"
    );
    installed.with_context(|| format!("no compiler for {target}; {by_hand}"))?;
    match Toolchain::find(core) {
        Some(_) => Ok(()),
        None => bail!("no compiler for {target} that is new enough; {by_hand}"),
    }
}

fn name(toolchain: &Toolchain) -> &'static str {
    match toolchain.origin() {
        Origin::Installed => "there, with the toolchain in use",
        Origin::Debian { .. } => "there, Debian's with its library sources",
    }
}

/// A program that a package of Debian's has.
fn program(program: &str, package: &str) -> Result<()> {
    if starts(program) {
        println!("{program}: there");
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
