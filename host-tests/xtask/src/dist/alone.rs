//! Runs the program where nothing else is.

use anyhow::{Context as _, Result, ensure};
use object::Object as _;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

/// What the program does there: writes a log, and reads it.
const COMMANDS: [&[&str]; 3] = [
    &["--version"],
    &[
        "simulate",
        "mems",
        "--duration",
        "60s",
        "--output",
        "log.csv",
    ],
    &["fit", "log.csv"],
];

/// Holds that the program asks for no other program to load it, and, where this user may change the root folder, that it runs in
/// a folder with nothing in it.
pub(super) fn check(program: &Path) -> Result<()> {
    let bytes = fs::read(program).with_context(|| program.display().to_string())?;
    let elf = object::File::parse(&*bytes)?;
    ensure!(
        elf.section_by_name(".interp").is_none(),
        "{} is not static: it asks for a loader",
        program.display()
    );
    let folder = tempfile::tempdir()?;
    fs::copy(program, folder.path().join("allanite"))?;
    let Some(prefix) = prefix(folder.path()) else {
        println!(
            "the program was not run in an empty folder: that takes root, or namespaces of users"
        );
        return Ok(());
    };
    for arguments in COMMANDS {
        let mut command = Command::new(prefix[0]);
        command
            .args(&prefix[1..])
            .arg(folder.path())
            .arg("/allanite");
        let output = command.args(arguments).stdin(Stdio::null()).output()?;
        ensure!(
            output.status.success(),
            "in an empty folder, `allanite {}` failed: {}",
            arguments.join(" "),
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    println!("the program runs in an empty folder");
    Ok(())
}

/// The command that runs another one in a folder as its root, if this user has one.
fn prefix(folder: &Path) -> Option<&'static [&'static str]> {
    let ways: [&[&str]; 2] = [
        &["chroot"],
        &["unshare", "--user", "--map-root-user", "chroot"],
    ];
    ways.into_iter().find(|way| {
        let mut command = Command::new(way[0]);
        command
            .args(&way[1..])
            .arg(folder)
            .args(["/allanite", "--version"]);
        let output = command.stdin(Stdio::null()).output();
        // A program that does not run there has another status than a user who may not.
        output.is_ok_and(|output| !matches!(output.status.code(), Some(125 | 1) | None))
    })
}
