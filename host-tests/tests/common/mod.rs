//! The program as people run it.

// Every test takes what it needs of this.
#![allow(dead_code)]

use std::{
    path::Path,
    process::{Command, Output},
};

/// Curves of two real gyros.
pub(crate) const ADIS16405: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/adis16405.json");

fn allanite(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_allanite"));
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

/// The standard output of a command that works.
pub(crate) fn output(folder: &Path, arguments: &[&str]) -> String {
    let output = allanite(folder, arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The same as JSON.
pub(crate) fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&output(folder, &[arguments, &["--json"]].concat())).unwrap()
}

/// The one line of a command that refuses.
pub(crate) fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = allanite(folder, arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let line = errors.strip_suffix('\n').unwrap();
    assert!(
        !line.contains('\n') && line.contains("; "),
        "{arguments:?}: {line}"
    );
    line.strip_prefix("allanite: ").unwrap().to_owned()
}
