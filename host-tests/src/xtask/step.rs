//! One command of a task.

use anyhow::{Context as _, Result, bail};
use std::process::Command;

/// Runs a command under a heading.
pub(super) fn step(heading: &str, command: &mut Command) -> Result<()> {
    println!("\n== {heading}");
    run(command)
}

/// Runs a command; one that fails is named in full.
pub(super) fn run(command: &mut Command) -> Result<()> {
    let shown = shown(command);
    let status = command
        .status()
        .with_context(|| format!("`{shown}` did not start"))?;
    if !status.success() {
        bail!("`{shown}` failed ({status})");
    }
    Ok(())
}

/// The command as one could type it, with the variables that were set for it.
pub(super) fn shown(command: &Command) -> String {
    let mut words = Vec::new();
    for (name, value) in command.get_envs() {
        if let Some(value) = value {
            words.push(format!(
                "{}={}",
                name.display(),
                quoted(&value.to_string_lossy())
            ));
        }
    }
    words.push(command.get_program().display().to_string());
    let arguments = command.get_args();
    words.extend(arguments.map(|argument| quoted(&argument.to_string_lossy())));
    words.join(" ")
}

fn quoted(word: &str) -> String {
    if word.contains(' ') {
        format!("'{word}'")
    } else {
        word.to_owned()
    }
}
