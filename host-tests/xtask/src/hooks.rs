//! Activates the git hooks of the project.

use anyhow::{Context as _, Result};
use std::process::{Command, Stdio};

/// The folder of the hooks, from the root of the repository.
const FOLDER: &str = "host-tests/hooks";

/// Lets git run the hooks of the project, unless the clone has hooks of its own or is no clone.
pub(crate) fn activate() -> Result<()> {
    let is_clone = git(&["rev-parse", "--is-inside-work-tree"]);
    if !is_clone.is_ok_and(|output| output == "true") {
        return Ok(());
    }
    let present = git(&["config", "core.hooksPath"]).unwrap_or_default();
    if present.is_empty() {
        git(&["config", "core.hooksPath", FOLDER])?;
        println!("git hooks: {FOLDER}");
    }
    Ok(())
}

/// The output of git without the end of its line.
fn git(arguments: &[&str]) -> Result<String> {
    let output = Command::new("git")
        .args(arguments)
        .stderr(Stdio::null())
        .output()
        .context("git")?;
    anyhow::ensure!(output.status.success(), "git {}", arguments.join(" "));
    Ok(String::from_utf8_lossy(&output.stdout)
        .trim_end()
        .to_owned())
}
